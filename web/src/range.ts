// The range of the colour bar: follows the large values without flicker, but not outliers.
import { niceAbove } from "./format";

const CALM = 1500; // [ms] that values have to stay low before the range shrinks
const USUAL = 0.995; // share of the nodes whose values are no outliers
const STRAY = 2; // times the largest usual value: larger values are beyond the bar
const LOOKED_AT = 8192; // values at most

export class Range {
  top = 1e-9;
  private lowSince = -1;
  private aboveAt = -Infinity; // when a value was last above the bar, and below it [ms]
  private belowAt = -Infinity;
  private now = 0;

  reset(): void {
    this.top = 1e-9;
    this.lowSince = -1;
    this.aboveAt = this.belowAt = -Infinity;
  }

  /** Whether values exceed the bar, or did a moment ago. */
  get above(): boolean {
    return this.now - this.aboveAt < CALM;
  }
  /** The same below minus the top. */
  get below(): boolean {
    return this.now - this.belowAt < CALM;
  }

  /** Takes in the values of a frame at a time in [ms]. Returns whether the range changed. */
  take(values: Float32Array, floor: number, now: number): boolean {
    let [most, least] = [-Infinity, Infinity];
    for (let i = 0; i < values.length; ++i) {
      const value = values[i];
      if (!Number.isFinite(value)) return false;
      if (value > most) most = value;
      if (value < least) least = value;
    }
    if (values.length === 0) return false;
    this.now = now;
    const extreme = Math.max(most, -least);
    const wanted = niceAbove(Math.max(Math.min(extreme, STRAY * usualSize(values)), floor));
    const changed = this.follow(wanted, now);
    if (most > this.top * (1 + 1e-6)) this.aboveAt = now;
    if (-least > this.top * (1 + 1e-6)) this.belowAt = now;
    return changed;
  }

  private follow(wanted: number, now: number): boolean {
    if (wanted > this.top) {
      this.top = wanted;
      this.lowSince = -1;
      return true;
    }
    if (wanted > 0.45 * this.top) {
      this.lowSince = -1;
      return false;
    }
    if (this.lowSince < 0) this.lowSince = now;
    if (now - this.lowSince < CALM) return false;
    this.top = wanted;
    this.lowSince = -1;
    return true;
  }
}

/** The bound of all values except outliers. Of many values only a sample is used. */
function usualSize(values: Float32Array): number {
  const every = Math.ceil(values.length / LOOKED_AT);
  const sizes = new Float32Array(Math.ceil(values.length / every));
  for (let i = 0; i < sizes.length; ++i) sizes[i] = Math.abs(values[i * every]);
  sizes.sort();
  return sizes[Math.floor(USUAL * (sizes.length - 1))];
}
