// Interpolates positions that are reported ten times a second for the time of each frame.
import * as THREE from "three";
import type { Vec } from "./protocol";

const SETTLE = 40; // [ms] in which a prediction error is removed
const STILL = 1e-5; // share of its size: smaller motions are not visible
const JUMP = 1.5; // share of its size: a larger change is a placement, not a motion

export class Track {
  private readonly at = new THREE.Vector3();
  private readonly velocity = new THREE.Vector3(); // [m/s], of simulated time
  private readonly wanted = new THREE.Vector3();
  private time = -1; // of the last report, simulated [s]
  private between = 0; // time between the last two reports [s]
  private now = 0;
  private fresh = true;

  get known(): boolean {
    return this.time >= 0;
  }

  hear(center: Vec, time: number): void {
    const to = this.wanted.fromArray(center);
    if (this.time < 0 || time < this.time) {
      this.velocity.set(0, 0, 0);
      this.fresh = true;
    } else if (time > this.time) {
      this.between = time - this.time;
      this.velocity.copy(to).sub(this.at).divideScalar(this.between);
    } else if (!to.equals(this.at)) {
      this.velocity.set(0, 0, 0); // placed elsewhere while the time stands still
    }
    this.at.copy(to);
    this.time = time;
  }

  /** Moves `shown` to its position at a simulated time [s]; `now` is the real time [ms], `size`
   * that of the object [m]. Returns whether the motion is visible. */
  follow(shown: THREE.Vector3, time: number, now: number, size: number): boolean {
    const ahead = THREE.MathUtils.clamp(time - this.time, 0, 1.2 * this.between);
    this.wanted.copy(this.at).addScaledVector(this.velocity, ahead);
    const share = this.fresh ? 1 : 1 - Math.exp(-Math.max(0, now - this.now) / SETTLE);
    this.now = now;
    this.fresh = false;
    const way = shown.distanceTo(this.wanted);
    if (way < STILL * size) return false;
    shown.lerp(this.wanted, way > JUMP * size ? 1 : share);
    return true;
  }
}
