// The panel: values to change, and the status of the simulation.
import { h } from "./dom";
import { fill, section, select } from "./form";
import { digits, percent, si } from "./format";
import type { Command, Part, SceneInfo, Status, Vec } from "./protocol";
import { Slider } from "./slider";

const LAWS = ["neo-hookean", "calibrated", "lloyd", "vangelder"];
const STEPPERS: [string, string][] = [
  ["live", "Keeps pace"],
  ["auto", "Automatic"],
  ["verlet", "Explicit (Verlet)"],
  ["implicit", "Implicit"],
];
const DIRECTIONS: [string, Vec][] = [
  ["Down", [0, -1, 0]],
  ["Up", [0, 1, 0]],
  ["Left", [-1, 0, 0]],
  ["Right", [1, 0, 0]],
  ["To the back", [0, 0, -1]],
  ["To the front", [0, 0, 1]],
];
const EVERYTHING = "*";
/** Limits of the stretch and compression of springs, as shares of their length. */
const LIMITS = ["inf", "0.01", "0.02", "0.05", "0.1", "0.2", "0.5"];
const limitName = (value: string): string => (value === "inf" ? "Any" : `At most ${percent(Number(value), 2)}`);
const limits = (label: string) => select(label, LIMITS.map((l) => [l, limitName(l)]));
const showLimit = (input: HTMLSelectElement, limit: number | null): void => {
  const value = limit === null ? "inf" : String(limit);
  fill(input, [...new Set([...LIMITS, value])].map((l) => [l, limitName(l)]));
  input.value = value;
};

export class Panel {
  readonly element: HTMLElement;
  private scene: SceneInfo | null = null;
  private readonly part = select("Part", []);
  private readonly law = select("Law", LAWS.map((l) => [l, l]));
  private readonly young: Slider;
  private readonly poisson: Slider;
  private readonly density: Slider;
  private readonly damping: Slider;
  private readonly drag: Slider;
  private readonly stretch = limits("Stretch of springs");
  private readonly compress = limits("Compression of springs");
  private readonly strength: Slider;
  private readonly direction = select("Direction", DIRECTIONS.map(([name], i) => [String(i), name]));
  private readonly stepper = select("Stepper", STEPPERS);
  private readonly step = select("Step", []);
  private readonly pace: Slider;
  private readonly facts = new Facts();
  private readonly energies = new Facts();

  /** `more`: sections of other files. */
  constructor(
    private readonly send: (command: Command) => boolean,
    ...more: HTMLElement[]
  ) {
    const material = (key: string) => (value: number) => this.material(key, value);
    this.young = new Slider({ label: "Young’s modulus", low: 1e3, high: 1e9, log: true, show: (v) => si(v, "Pa"), changed: material("young") });
    this.poisson = new Slider({ label: "Poisson’s ratio", low: 0, high: 0.495, step: 0.005, show: (v) => digits(v), changed: material("poisson") });
    this.density = new Slider({ label: "Density", low: 100, high: 10000, log: true, show: (v) => `${digits(v)} kg/m³`, changed: material("density") });
    this.damping = new Slider({ label: "Damping ratio", low: 0, high: 2, step: 0.01, show: (v) => digits(v), changed: material("damping_ratio") });
    this.drag = new Slider({ label: "Drag", low: 0, high: 20, step: 0.1, show: (v) => `${digits(v)} 1/s`, changed: material("drag") });
    this.strength = new Slider({ label: "Gravity", low: 0, high: 30, step: 0.01, show: (v) => `${digits(v)} m/s²`, changed: () => this.sendGravity() });
    this.pace = new Slider({ label: "Time scale", low: 0.01, high: 4, log: true, show: (v) => `${digits(v, 2)}×`, changed: (value) => this.send({ type: "time_scale", value }) });
    this.part.input.addEventListener("change", () => this.showPart());
    this.law.input.addEventListener("change", () => this.material("law", this.law.input.value));
    this.stretch.input.addEventListener("change", () => this.material("stretch_limit", this.stretch.input.value));
    this.compress.input.addEventListener("change", () => this.material("compress_limit", this.compress.input.value));
    this.direction.input.addEventListener("change", () => this.sendGravity());
    this.stepper.input.addEventListener("change", () => this.send({ type: "stepping", key: "stepper", value: this.stepper.input.value }));
    this.step.input.addEventListener("change", () => {
      const value = this.step.input.value;
      this.send({ type: "stepping", key: "dt", value: value === "auto" ? value : Number(value) });
    });
    this.element = h(
      "aside",
      { id: "panel", "aria-label": "Values" },
      section("Material", this.part.row, this.law.row, this.young.element, this.poisson.element, this.density.element, this.damping.element, this.drag.element, this.stretch.row, this.compress.row),
      ...more,
      section("World", this.strength.element, this.direction.row),
      section("Time", this.stepper.row, this.step.row, this.pace.element, this.facts.element),
      section("Energy", this.energies.element),
    );
  }

  /** Everything except the parts that concern only this page. */
  setEnabled(on: boolean): void {
    for (const input of this.element.querySelectorAll<HTMLInputElement | HTMLSelectElement>("input:not(.own), select")) {
      input.disabled = !on;
    }
  }

  showScene(scene: SceneInfo): void {
    const newParts = this.scene?.opened !== scene.opened;
    this.scene = scene;
    if (newParts) {
      const several = scene.parts.length > 1;
      const name = (p: Part) => (p.region ? `${p.body}: ${p.region}` : p.body);
      const list: [string, string][] = scene.parts.map((p, i) => [String(i), name(p)]);
      fill(this.part.input, several ? [[EVERYTHING, "Everything"], ...list] : list);
      this.part.input.selectedIndex = 0;
      this.part.row.hidden = !several;
    }
    this.showPart();
    const size = Math.hypot(...scene.gravity);
    this.strength.set(size);
    if (size > 0) {
      const along = DIRECTIONS.map(([, d]) => d.reduce((s, c, i) => s + c * scene.gravity[i], 0));
      this.direction.input.value = String(along.indexOf(Math.max(...along)));
    }
    this.stepper.input.value = scene.stepper === "static" ? "implicit" : scene.stepper;
    const steps = ["auto", "0.0001", "0.0002", "0.0005", "0.001", "0.002", "0.005", "0.01", "0.02"];
    const now = scene.dt > 0 ? String(scene.dt) : "auto";
    if (!steps.includes(now)) steps.push(now);
    fill(this.step.input, steps.map((s) => [s, s === "auto" ? "Automatic" : si(Number(s), "s")]));
    this.step.input.value = now;
  }

  showStatus(s: Status): void {
    this.pace.set(s.time_scale);
    this.facts.show([
      ["Step taken", s.dt === null ? "–" : si(s.dt, "s")],
      ["Stable explicit step", s.stable_step === null ? "not needed" : si(s.stable_step, "s")],
      ["Time per step", s.ms_per_step > 0 ? si(1e-3 * s.ms_per_step, "s") : "–"],
      ["Steps per frame", s.steps_per_frame ? digits(s.steps_per_frame) : "–"],
      ...(s.stepper === "implicit"
        ? ([
            ["Newton steps per step", digits(s.newton_per_step)],
            ["Iterations per Newton step", digits(s.products_per_newton)],
          ] as [string, string][])
        : []),
      ["Could go at", s.capacity === null || s.capacity === 0 ? "–" : `${digits(s.capacity, 2)}× real time`],
    ]);
    const e = s.energy;
    this.energies.show([
      ["Kinetic", si(e.kinetic, "J")],
      ["Elastic", si(e.elastic, "J")],
      ["Gravity", si(e.gravity, "J")],
      ["Dissipated", si(e.dissipated, "J")],
      ["Work put in", si(e.work_in, "J")],
      ["Volume", `${s.volume_ratio >= 1 ? "+" : ""}${percent(s.volume_ratio - 1, 2)}`],
      ["Springs", `+${percent(s.max_stretch, 2)} to −${percent(Math.abs(s.max_compress), 2)}`],
      ...(s.contacts > 0 || s.deepest > 0
        ? ([
            ["Contacts", String(s.contacts)],
            ["Deepest penetration", si(s.deepest, "m")],
          ] as [string, string][])
        : []),
      ...(s.inverted_tets > 0 ? ([["Inverted tets", String(s.inverted_tets)]] as [string, string][]) : []),
    ]);
  }

  /** The part whose values are shown; for the whole scene the first. */
  private showPart(): void {
    const chosen = this.part.input.value;
    const part = this.scene?.parts[chosen === EVERYTHING || chosen === "" ? 0 : Number(chosen)];
    if (!part) return;
    if (![...this.law.input.options].some((o) => o.value === part.law)) {
      fill(this.law.input, [...LAWS, part.law].map((l) => [l, l]));
    }
    this.law.input.value = part.law;
    this.young.set(part.young);
    this.poisson.set(part.poisson);
    this.density.set(part.density);
    this.damping.set(part.damping_ratio);
    this.drag.set(part.drag);
    showLimit(this.stretch.input, part.stretch_limit);
    showLimit(this.compress.input, part.compress_limit);
  }

  private material(key: string, value: number | string): void {
    const chosen = this.part.input.value;
    const part = chosen === EVERYTHING ? undefined : this.scene?.parts[Number(chosen)];
    this.send({ type: "material", key, value, ...(part ? { body: part.body, region: part.region } : {}) });
  }

  private sendGravity(): void {
    const along = DIRECTIONS[Number(this.direction.input.value)][1];
    this.send({ type: "gravity", value: along.map((c) => c * this.strength.value) as Vec });
  }
}

/** A list of names and values that changes in place. */
class Facts {
  readonly element = h("dl", { class: "facts" });
  private readonly values = new Map<string, HTMLElement>();

  show(facts: [string, string][]): void {
    if (facts.map(([name]) => name).join() !== [...this.values.keys()].join()) {
      this.values.clear();
      this.element.replaceChildren();
      for (const [name] of facts) {
        const value = h("dd");
        this.values.set(name, value);
        this.element.append(h("dt", {}, name), value);
      }
    }
    for (const [name, text] of facts) {
      const value = this.values.get(name)!;
      if (value.textContent !== text) value.textContent = text;
    }
  }
}
