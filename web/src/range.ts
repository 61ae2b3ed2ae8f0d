// The range of the colour bar: follows the largest value without flicker.
import { niceAbove } from "./format";

const CALM = 1500; // [ms] that values have to stay low before the range shrinks

export class Range {
  top = 1e-9;
  private lowSince = -1;

  reset(): void {
    this.top = 1e-9;
    this.lowSince = -1;
  }

  /** Takes in the values of a frame at a time in [ms]. Returns whether the range changed. */
  take(values: Float32Array, floor: number, now: number): boolean {
    let most = 0;
    for (let i = 0; i < values.length; ++i) most = Math.max(most, Math.abs(values[i]));
    if (!Number.isFinite(most)) return false;
    const wanted = niceAbove(Math.max(most, floor));
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
