// A slider with its number beside it; linear or logarithmic.
import { h } from "./dom";

export interface SliderOptions {
  label: string;
  low: number;
  high: number;
  log?: boolean;
  step?: number; // of linear sliders
  show: (value: number) => string;
  /** Called while the user moves it, at most every 50 ms. */
  changed: (value: number) => void;
}

const STEPS = 600; // of a logarithmic slider
const BETWEEN = 50; // [ms]

let count = 0;

export class Slider {
  readonly element: HTMLElement;
  readonly input: HTMLInputElement;
  private readonly output: HTMLOutputElement;
  private waiting: ReturnType<typeof setTimeout> | null = null;
  private told = 0;
  private touched = -1e9; // when the user last moved it [ms]

  constructor(private readonly options: SliderOptions) {
    const id = `slider-${++count}`;
    const { low, high, log } = options;
    this.input = h("input", {
      id,
      type: "range",
      min: log ? 0 : low,
      max: log ? STEPS : high,
      step: log ? 1 : (options.step ?? (high - low) / 500),
    });
    this.output = h("output", { for: id });
    this.element = h(
      "div",
      { class: "row slider" },
      h("label", { for: id }, options.label),
      this.output,
      this.input,
    );
    this.input.addEventListener("input", () => this.moved());
    this.set(low);
  }

  /** The value of the simulation; ignored while the user moves the slider. */
  set(value: number): void {
    if (performance.now() - this.touched >= 700) this.put(value);
  }

  put(value: number): void {
    const { low, high, log } = this.options;
    const at = log ? (STEPS * Math.log(value / low)) / Math.log(high / low) : value;
    this.input.value = String(at);
    this.write(value);
  }

  /** The meaning of the value has changed. */
  refresh(): void {
    this.write(this.value);
  }

  get value(): number {
    const at = Number(this.input.value);
    const { low, high, log } = this.options;
    return log ? Number((low * (high / low) ** (at / STEPS)).toPrecision(3)) : at;
  }

  private moved(): void {
    this.touched = performance.now();
    this.write(this.value);
    if (this.waiting !== null) return;
    const wait = Math.max(0, this.told + BETWEEN - performance.now());
    this.waiting = setTimeout(() => {
      this.waiting = null;
      this.told = performance.now();
      this.options.changed(this.value);
    }, wait);
  }

  private write(value: number): void {
    const text = this.options.show(value);
    this.output.value = text;
    this.input.setAttribute("aria-valuetext", text);
    const share = (Number(this.input.value) - Number(this.input.min)) / (Number(this.input.max) - Number(this.input.min));
    this.input.style.setProperty("--share", `${100 * share}%`);
  }
}
