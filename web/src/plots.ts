// The drawer with plots of the status, which arrives ten times a second.
import { Chart, type Line } from "./chart";
import { h, iconButton } from "./dom";
import { digits, si } from "./format";
import { type Column, History } from "./history";
import "./plots.css";
import type { SceneInfo, Status } from "./protocol";

interface Group {
  name: string;
  title: string;
  unit: string;
  empty: string; // text if there is nothing to plot
}

const GROUPS: Group[] = [
  { name: "energy", title: "Energy", unit: "J", empty: "" },
  { name: "displacement", title: "Displacement", unit: "m", empty: "This scene has no probes. A scene names the points to watch: docs/scene-format.md, [probes]." },
  { name: "volume", title: "Volume", unit: "%", empty: "" },
  { name: "force", title: "Force", unit: "N", empty: "" },
];
// Distinguishable with any colour vision, on a dark ground (after Okabe and Ito).
const COLORS = ["#56b4e9", "#e69f00", "#2fbf8f", "#f0e442", "#e8684a", "#d58abb", "#a4a9ff", "#c9b18f"];
const TOTAL = "#ffffff";
const BETWEEN = 95; // pictures [ms]
const NARROW = 760; // [px], as in the style sheets
const LEAST = 1e-9; // smaller values are shown as zero [J, N, m]

export class Plots {
  readonly element: HTMLElement;
  readonly button: HTMLButtonElement;
  readonly history = new History();
  private group = GROUPS[0];
  private chart: Chart | null = null;
  private pointed: number | null = null;
  private drawnAt = -1e9;
  private diagonal = 1;
  private readonly hidden = new Set<string>(); // series the user has turned off
  private readonly tabs: HTMLButtonElement[];
  private readonly area = h("div", { class: "area", tabindex: 0, role: "img" });
  private readonly legend = h("div", { class: "plot-legend", role: "group", "aria-label": "Lines" });
  private readonly when = h("span", { class: "when" });
  private readonly all = h("button", { type: "button", class: "text", title: "The whole time again (double click)" }, "All");

  /** `changed`: called when the drawer opens or closes. */
  constructor(private readonly changed: () => void) {
    this.button = iconButton("plot", "Plots", "D", () => this.toggle());
    this.button.setAttribute("aria-expanded", "false");
    this.button.setAttribute("aria-controls", "plots");
    this.tabs = GROUPS.map((g) => {
      const tab = h("button", { type: "button", role: "tab", id: `plot-${g.name}`, "aria-controls": "plot-body" }, g.title);
      tab.addEventListener("click", () => this.choose(g));
      return tab;
    });
    const list = h("div", { role: "tablist", "aria-label": "Plots" }, ...this.tabs);
    list.addEventListener("keydown", (e) => this.turn(e));
    this.all.hidden = true;
    this.all.addEventListener("click", () => this.chart?.whole());
    this.element = h("section", { id: "plots", "aria-label": "Plots", hidden: true },
      h("div", { class: "bar" }, list, this.when, this.all, iconButton("close", "Close the plots", "D", () => this.toggle(false))),
      h("div", { id: "plot-body", role: "tabpanel" }, this.area, this.legend));
    new ResizeObserver(() => this.chart?.fit()).observe(this.area);
    this.mark();
  }

  get open(): boolean {
    return !this.element.hidden;
  }

  toggle(open = !this.open): void {
    const inside = this.element.contains(document.activeElement);
    this.element.hidden = !open;
    this.button.setAttribute("aria-expanded", String(open));
    document.body.classList.toggle("plots", open);
    if (open && innerWidth < NARROW) document.body.classList.add("no-panel", "no-options"); // no room for more
    if (open) this.build();
    else this.close();
    if (!open && inside) this.button.focus();
    this.changed();
  }

  showScene(scene: SceneInfo): void {
    this.diagonal = scene.diagonal;
    if (this.history.begin(scene) && this.open) this.build();
  }

  showStatus(status: Status, now: number): void {
    this.history.add(status);
    if (!this.open || document.hidden || now - this.drawnAt < BETWEEN) return;
    this.drawnAt = now;
    this.draw();
  }

  // ---- the chosen plot ----

  private choose(group: Group): void {
    this.group = group;
    this.mark();
    this.build();
  }

  private mark(): void {
    GROUPS.forEach((g, i) => {
      const chosen = g === this.group;
      this.tabs[i].setAttribute("aria-selected", String(chosen));
      this.tabs[i].tabIndex = chosen ? 0 : -1;
    });
    this.element.querySelector("#plot-body")!.setAttribute("aria-labelledby", `plot-${this.group.name}`);
  }

  /** The arrow keys go from tab to tab. */
  private turn(event: KeyboardEvent): void {
    const by = event.key === "ArrowRight" ? 1 : event.key === "ArrowLeft" ? -1 : 0;
    if (by === 0) return;
    event.preventDefault();
    const next = (GROUPS.indexOf(this.group) + by + GROUPS.length) % GROUPS.length;
    this.choose(GROUPS[next]);
    this.tabs[next].focus();
  }

  private columns(): { column: Column; values: (number | null)[] }[] {
    return this.history.columns
      .map((column, i) => ({ column, values: this.history.values[i] }))
      .filter(({ column }) => column.group === this.group.name);
  }

  private close(): void {
    this.chart?.destroy();
    this.chart = null;
    this.pointed = null;
    this.all.hidden = true;
  }

  private build(): void {
    this.close();
    this.area.replaceChildren();
    this.legend.replaceChildren();
    const columns = this.columns();
    if (columns.length === 0) {
      this.area.append(h("p", { class: "empty" }, this.group.empty));
      this.when.textContent = "";
      return;
    }
    const lines = columns.map(({ column }, i): Line => {
      const total = column.title === "Total";
      return { title: column.title, color: total ? TOTAL : COLORS[i % COLORS.length], width: total ? 2 : 1.6, shown: !this.hidden.has(this.key(column)) };
    });
    const floors: Record<string, number> = { energy: 1e-6, displacement: 1e-4 * this.diagonal, volume: 0.01, force: 1e-3 };
    this.chart = new Chart(this.area, {
      unit: this.group.unit,
      floor: floors[this.group.name],
      lines,
      pointed: (index) => {
        this.pointed = index;
        this.read();
      },
      zoomed: (is) => (this.all.hidden = !is),
    });
    this.legend.append(...columns.map(({ column }, i) => this.entry(column, lines[i], i)));
    this.draw();
  }

  /** A line of the legend: shows and hides its series. */
  private entry(column: Column, line: Line, index: number): HTMLElement {
    const button = h("button", { type: "button", "aria-pressed": String(line.shown), title: "Show or hide" },
      h("i", { style: `background:${line.color}` }), h("span", {}, line.title), h("output"));
    button.addEventListener("click", () => {
      const key = this.key(column);
      const shown = this.hidden.delete(key);
      if (!shown) this.hidden.add(key);
      button.setAttribute("aria-pressed", String(shown));
      this.chart?.show(index, shown);
    });
    return button;
  }

  private key(column: Column): string {
    return `${column.group} ${column.title}`;
  }

  private draw(): void {
    this.chart?.set([this.history.time, ...this.columns().map((c) => c.values)]);
    this.read();
  }

  /** Values in the legend: those pointed at, else the newest. */
  private read(): void {
    const { time } = this.history;
    const index = Math.min(this.pointed ?? time.length - 1, time.length - 1);
    const columns = this.columns();
    this.when.textContent = index < 0 ? "" : `at ${time[index].toFixed(2)} s`;
    this.legend.querySelectorAll("output").forEach((output, i) => {
      const value = columns[i]?.values[index] ?? null;
      const { unit } = this.group;
      output.value = value === null ? "–" : unit === "%" ? `${digits(value)} %` : si(Math.abs(value) < LEAST ? 0 : value, unit);
    });
    const texts = [...this.legend.querySelectorAll("button")].map((b) => `${b.children[1].textContent} ${b.children[2].textContent}`);
    this.area.setAttribute("aria-label", `${this.group.title} over time, ${this.when.textContent}: ${texts.join(", ")}. Arrow keys read, + and − zoom, 0 shows all.`);
  }
}
