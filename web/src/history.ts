// The data of the plots and the CSV: a sample of every status message since the start, in bounded
// memory.
import type { SceneInfo, Status, Vec } from "./protocol";

export interface Column {
  group: string; // the plot it belongs to
  title: string;
  unit: string; // SI; "%" for shares
  of: (s: Status) => number | null; // null: no value
}

const MOST = 6000; // samples
const size = (v: Vec) => Math.hypot(...v);

/** The recorded quantities of a scene. */
export function columnsOf(scene: SceneInfo): Column[] {
  const energy = (key: keyof Status["energy"], title: string): Column => ({
    group: "energy", title, unit: "J", of: (s) => s.energy[key],
  });
  const hand = (s: Status) => s.hands.find((h) => h.hand === 0);
  const pins = (s: Status) => s.hands.filter((h) => h.hand !== 0);
  return [
    energy("kinetic", "Kinetic"),
    energy("elastic", "Elastic"),
    energy("gravity", "Gravity"),
    energy("contact", "Contact"),
    energy("dissipated", "Dissipated"),
    energy("work_in", "Work put in"),
    {
      // As in energy.csv of a run: constant except for the error of the steps.
      group: "energy", title: "Total", unit: "J",
      of: ({ energy: e }) => e.kinetic + e.elastic + e.gravity + e.contact + e.dissipated - e.work_in,
    },
    ...scene.probes.map((name, i): Column => ({
      group: "displacement", title: name, unit: "m", of: (s) => (s.probes[i] ? size(s.probes[i]) : null),
    })),
    { group: "volume", title: "Change of volume", unit: "%", of: (s) => 100 * (s.volume_ratio - 1) },
    { group: "force", title: "Pull", unit: "N", of: (s) => { const h = hand(s); return h ? size(h.force) : null; } },
    { group: "force", title: "Pins", unit: "N", of: (s) => (pins(s).length > 0 ? pins(s).reduce((sum, h) => sum + size(h.force), 0) : null) },
    { group: "force", title: "Ball in hand", unit: "N", of: (s) => (s.ball ? size(s.ball.force) : null) },
    ...scene.obstacles.map(({ name }, i): Column => ({
      group: "force", title: name, unit: "N", of: (s) => (s.obstacles[i] ? size(s.obstacles[i].force) : null),
    })),
  ];
}

/** Samples of the columns over simulated time. If there are too many, every second one is dropped
 * and the rate is halved, so the density is the same at the start and at the end. */
export class History {
  columns: Column[] = [];
  time: number[] = []; // [s], growing
  values: (number | null)[][] = []; // of each column
  private scene = "";
  private stride = 1; // statuses from one sample to the next
  private since = 0; // statuses since the last permanent sample; the newest one is always present

  constructor(private readonly most = MOST) {}

  /** Restarts for another scene. Returns whether it is another. */
  begin(scene: SceneInfo): boolean {
    const key = JSON.stringify([scene.opened, scene.name, scene.probes, scene.obstacles]);
    if (key === this.scene) return false;
    this.scene = key;
    this.columns = columnsOf(scene);
    this.clear();
    return true;
  }

  add(s: Status): void {
    const last = this.time.length - 1;
    if (last >= 0 && s.time < this.time[last]) this.clear();
    else if (last >= 0 && s.time === this.time[last]) this.drop(); // paused, or a value changed
    else if (last >= 0) {
      if (this.since > 0) this.drop();
      this.since = (this.since + 1) % this.stride;
    }
    this.time.push(s.time);
    this.columns.forEach((c, i) => this.values[i].push(c.of(s)));
    if (this.time.length > this.most) this.thin();
  }

  get length(): number {
    return this.time.length;
  }

  private clear(): void {
    this.time = [];
    this.values = this.columns.map(() => []);
    this.stride = 1;
    this.since = 0;
  }

  private drop(): void {
    this.time.pop();
    for (const v of this.values) v.pop();
  }

  private thin(): void {
    const end = this.time.length - 1;
    const lastThatStays = this.since === 0 ? end : end - 1;
    if (lastThatStays % 2 !== 0) this.since += this.stride;
    this.stride *= 2;
    const keep = <T>(all: T[]) => all.filter((_, i) => i % 2 === 0 || i === end);
    this.time = keep(this.time);
    this.values = this.values.map(keep);
  }
}

/** All samples as a table with a column's name and unit above it. */
export function toCsv(history: History): string {
  const field = (text: string) => (/[",\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text);
  const name: Record<string, (c: Column) => string> = {
    displacement: (c) => `displacement of ${c.title}`,
    force: (c) => `force: ${c.title}`,
  };
  const head = ["time [s]", ...history.columns.map((c) => `${(name[c.group] ?? ((d: Column) => d.title))(c)} [${c.unit}]`)];
  const rows = history.time.map((t, i) => [t, ...history.values.map((v) => v[i] ?? "")].join());
  return [head.map(field).join(), ...rows].join("\n") + "\n";
}
