// One plot over simulated time: uPlot with units on its axes, zoom, a readout, keyboard and touch.
import uPlot from "uplot";
import "uplot/dist/uPlot.min.css";
import { digits } from "./format";

export interface Line {
  title: string;
  color: string;
  width: number;
  shown: boolean;
}

export interface ChartOptions {
  unit: string;
  floor: number; // smallest range of the axis, so that noise does not fill it
  lines: Line[];
  /** Called with the sample under the pointer; null: none, the newest is shown. */
  pointed: (index: number | null) => void;
  zoomed: (is: boolean) => void;
}

type Data = [number[], ...(number | null)[][]];

const QUIET = "#a3b1bf";
const FONT = '11px system-ui, -apple-system, "Segoe UI", Roboto, "Noto Sans", sans-serif';
const PREFIXES: [number, string][] = [[1e9, "G"], [1e6, "M"], [1e3, "k"], [1, ""], [1e-3, "m"], [1e-6, "µ"], [1e-9, "n"]];

/** The numbers of an axis: one prefix for all, and enough digits to distinguish them. */
export function ticks(values: number[], unit: string): string[] {
  const most = Math.max(...values.map(Math.abs), 0);
  const apart = values.length > 1 ? Math.abs(values[1] - values[0]) : most;
  const [factor, prefix] =
    unit === "%" || unit === "s" || most === 0
      ? [1, ""]
      : (PREFIXES.find(([f]) => most >= f * 0.9999) ?? PREFIXES[PREFIXES.length - 1]);
  const count = (v: number) => Math.min(12, Math.max(1, Math.ceil(Math.log10(Math.abs(v) / apart) + 1e-9) + 2));
  // Steps of an axis have at most two digits (2.5); zero is often only approximate.
  return values.map((v) => `${Math.abs(v) < 1e-6 * apart ? "0" : digits(v / factor, count(v))} ${prefix}${unit}`);
}

export class Chart {
  private readonly plot: uPlot;
  private zoom: { min: number; max: number } | null = null;
  private times: number[] = [];

  constructor(private readonly parent: HTMLElement, private readonly options: ChartOptions) {
    const { unit, lines } = options;
    const axis = { stroke: QUIET, font: FONT, ticks: { show: false }, grid: { stroke: "rgb(255 255 255 / 7%)", width: 1 } };
    this.plot = new uPlot(
      {
        width: Math.max(1, parent.clientWidth),
        height: Math.max(1, parent.clientHeight),
        padding: [10, 14, 0, 0],
        legend: { show: false },
        cursor: { y: false, drag: { x: true, y: false, dist: 4 }, points: { size: 7 } },
        scales: { x: { time: false }, y: { range: (_, low, high) => this.range(low, high) } },
        axes: [
          { ...axis, size: 26, gap: 4, space: 70, values: (_, at) => ticks(at, "s") },
          { ...axis, gap: 6, space: 34, size: (_, texts) => 18 + 6.2 * Math.max(4, ...(texts ?? []).map((t) => t.length)), values: (_, at) => ticks(at, unit) },
        ],
        series: [
          {},
          ...lines.map((l) => ({ label: l.title, stroke: l.color, width: l.width, show: l.shown, points: { show: false } })),
        ],
        hooks: {
          setCursor: [(u) => options.pointed(u.cursor.idx ?? null)],
          setScale: [(_, key) => key === "x" && this.scaled()],
        },
      },
      [[], ...lines.map(() => [])],
      parent,
    );
    parent.addEventListener("keydown", this.key);
    this.plot.over.addEventListener("pointerdown", (e) => this.touch(e));
    this.plot.over.addEventListener("pointermove", (e) => this.touch(e));
  }

  set(data: Data): void {
    this.times = data[0];
    // A zoom stays while the simulation continues, unless no samples are left in it.
    const zoom = this.zoom && this.zoom.min < (this.times.at(-1) ?? 0) ? this.zoom : null;
    if (!zoom) return this.plot.setData(data, true);
    this.plot.batch(() => {
      this.plot.setData(data, false);
      this.plot.setScale("x", zoom);
    });
  }

  show(line: number, is: boolean): void {
    this.plot.setSeries(line + 1, { show: is });
  }

  fit(): void {
    const { clientWidth: width, clientHeight: height } = this.parent;
    if (width > 0 && height > 0 && (width !== this.plot.width || height !== this.plot.height)) {
      this.plot.setSize({ width, height });
    }
  }

  /** Shows the whole range again. */
  whole(): void {
    if (this.times.length > 0) this.plot.setScale("x", { min: this.times[0], max: this.times[this.times.length - 1] });
  }

  destroy(): void {
    this.parent.removeEventListener("keydown", this.key);
    this.plot.destroy();
  }

  private range(low: number | null, high: number | null): [number, number] {
    const { floor } = this.options;
    if (low === null || high === null) return [0, floor];
    const span = Math.max(high - low, floor, 1e-6 * Math.max(Math.abs(low), Math.abs(high)));
    const middle = 0.5 * (low + high);
    return high - low < span ? [middle - 0.6 * span, middle + 0.6 * span] : [low - 0.08 * span, high + 0.08 * span];
  }

  /** Called when the range of time has changed. */
  private scaled(): void {
    const { min, max } = this.plot.scales.x;
    const [first, last] = [this.times[0], this.times[this.times.length - 1]];
    const part = min !== undefined && max !== undefined && this.times.length > 1 && (min > first || max < last);
    this.zoom = part ? { min, max } : null;
    this.options.zoomed(part);
  }

  /** A touch reads values, because it cannot hover. */
  private touch(event: PointerEvent): void {
    if (event.pointerType !== "touch") return;
    const { left, top } = this.plot.over.getBoundingClientRect();
    this.plot.setCursor({ left: event.clientX - left, top: event.clientY - top });
  }

  private readonly key = (event: KeyboardEvent): void => {
    if (this.times.length === 0 || event.ctrlKey || event.metaKey || event.altKey) return;
    const { min = 0, max = 0 } = this.plot.scales.x;
    const at = this.plot.cursor.idx ?? this.times.length - 1;
    const by = event.shiftKey ? 10 : 1;
    const zoom = (factor: number) => {
      const middle = Math.min(max, Math.max(min, this.times[at]));
      const to = { min: middle - factor * (middle - min), max: middle + factor * (max - middle) };
      this.plot.setScale("x", { min: Math.max(to.min, this.times[0]), max: Math.min(to.max, this.times[this.times.length - 1]) });
    };
    const actions: Record<string, () => void> = {
      ArrowLeft: () => this.point(at - by),
      ArrowRight: () => this.point(at + by),
      "+": () => zoom(0.5),
      "-": () => zoom(2),
      "0": () => this.whole(),
    };
    const action = actions[event.key];
    if (!action) return;
    event.preventDefault();
    event.stopPropagation();
    action();
  };

  private point(index: number): void {
    const i = Math.min(this.times.length - 1, Math.max(0, index));
    this.plot.setCursor({ left: this.plot.valToPos(this.times[i], "x"), top: 0.5 * this.plot.over.clientHeight });
  }
}
