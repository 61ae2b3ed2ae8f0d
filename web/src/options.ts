// The card on the left: colouring, overlays, the cut.
import type { CutControl } from "./cut";
import { h } from "./dom";
import type { Command, SceneInfo } from "./protocol";

export const PLAIN = "plain";
const DISTANCE = "distance";

export type Shown = "wireframe" | "ghost" | "pins" | "contacts" | "grid";
const SHOWN: [Shown, string, string][] = [
  ["wireframe", "Wireframe", "W"],
  ["ghost", "Ghost", "U"],
  ["pins", "Pins", "N"],
  ["contacts", "Contacts", "K"],
  ["grid", "Grid", "G"],
];

export interface Listener {
  send(command: Command): boolean;
  colored(name: string): void;
  shown(what: Shown, on: boolean): void;
}

export class ViewOptions {
  readonly element: HTMLElement;
  coloring = PLAIN;
  private readonly colors = h("select", { id: "coloring", "aria-label": "Colour by", title: "Colour by (C)" });
  private readonly toggles = new Map<Shown, HTMLInputElement>();
  private readonly springs = h("input", { type: "checkbox", id: "show-springs" });
  private compared = "";
  private before = PLAIN; // colouring before the comparison

  constructor(
    private readonly listener: Listener,
    private readonly cut: CutControl,
  ) {
    this.colors.addEventListener("change", () => this.color(this.colors.value));
    this.springs.addEventListener("change", () => this.setSprings(this.springs.checked));
    const rows = SHOWN.map(([name, label, key]) => {
      const input = h("input", { type: "checkbox", id: `show-${name}` });
      input.checked = name === "grid";
      input.addEventListener("change", () => this.set(name, input.checked));
      this.toggles.set(name, input);
      return toggle(input, label, key);
    });
    this.element = h("div", { id: "view-options", role: "toolbar", "aria-label": "View" },
      h("label", { class: "select" }, h("span", {}, "Colour"), this.colors),
      ...rows, toggle(this.springs, "Springs", "L"), cut.label, cut.settings);
  }

  setEnabled(on: boolean): void {
    this.springs.disabled = !on;
    this.cut.setEnabled(on);
  }

  showScene(scene: SceneInfo): void {
    this.springs.checked = scene.springs_shown;
    this.cut.hear(scene.cut);
    const quantities = scene.quantities.filter((q) => q.name !== DISTANCE || scene.compare);
    const names = [PLAIN, ...quantities.map((q) => q.name)];
    if ([...this.colors.options].map((o) => o.value).join() !== names.join()) {
      const titles = ["Tissue", ...quantities.map((q) => q.title)];
      this.colors.replaceChildren(...names.map((value, i) => h("option", { value }, titles[i])));
      this.colors.value = this.coloring;
    }
    this.followComparison(scene, names);
  }

  /** A comparison is coloured by the distance of both bodies, until another colouring is chosen. */
  private followComparison(scene: SceneInfo, names: string[]): void {
    const [was, is] = [this.compared, scene.compare];
    this.compared = is;
    if (!was && is && names.includes(DISTANCE)) {
      this.before = this.coloring;
      this.color(DISTANCE);
    } else if (was && !is && this.coloring === DISTANCE) {
      this.color(this.before === DISTANCE ? PLAIN : this.before);
    }
  }

  color(name: string): void {
    this.coloring = name;
    this.colors.value = name;
    if (name !== PLAIN) this.listener.send({ type: "quantity", value: name });
    this.listener.colored(name);
  }

  nextColor(by: number): void {
    const names = [...this.colors.options].map((o) => o.value);
    this.color(names[(names.indexOf(this.coloring) + by + names.length) % names.length]);
  }

  set(name: Shown, on: boolean): void {
    this.toggles.get(name)!.checked = on;
    this.listener.shown(name, on);
  }

  toggle(name: Shown): void {
    this.set(name, !this.toggles.get(name)!.checked);
  }

  setSprings(on: boolean): void {
    this.springs.checked = on;
    this.listener.send({ type: "springs", value: on });
  }

  toggleSprings(): void {
    this.setSprings(!this.springs.checked);
  }
}

function toggle(input: HTMLInputElement, label: string, key: string): HTMLElement {
  return h("label", { class: "toggle", title: `${label} (${key})` }, input, h("span", {}, label));
}
