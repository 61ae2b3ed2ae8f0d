// The ball tool: a press on the tissue makes a rigid ball there, which is pushed in while the
// button is held; dragging moves it sideways. The simulation gives the actual position of the ball
// (spheres.ts).
import * as THREE from "three";
import { glass, GLASS_ORDER } from "./glass";
import type { Picker } from "./picker";
import type { Command, SphereStatus, Vec } from "./protocol";
import type { Stage } from "./stage";

const PUSH_TIME = 220; // [ms], approximate duration of the push
const FLATTEST = 0.4; // smallest cosine between ray and surface at which the ball is drawn back
const NOTCH = 0.1; // of the radius, for one press of a key or notch of the wheel
export const DEEPEST = 2; // radii

export class BallTool {
  mayPush = false; // this browser has the controls
  radius = 0.02; // [m]
  /** Depth of the push from first touch, in radii. */
  depth = 0.6;
  /** Called when keys or wheel change the depth. */
  deepened: () => void = () => {};
  private on = false;
  private pointer = -1; // the pushing pointer
  private readonly plane = new THREE.Plane();
  private readonly inward = new THREE.Vector3(); // direction of the push
  private readonly target = new THREE.Vector3(); // of the centre, in the image plane
  private pushed = 0; // distance beyond the plane [m]
  private sent = "";
  private there = false; // at its full size in the last report
  private now = 0; // [ms]
  private readonly preview: THREE.Mesh;

  constructor(
    private readonly stage: Stage,
    private readonly picker: Picker,
    private readonly send: (command: Command) => boolean,
  ) {
    this.preview = new THREE.Mesh(
      new THREE.SphereGeometry(1, 48, 32),
      glass({ color: 0xffc763, clear: 0.1, rim: 0.6 }),
    );
    this.preview.renderOrder = GLASS_ORDER + 3;
    this.preview.visible = false;
    stage.scene.add(this.preview);
    const canvas = stage.canvas;
    canvas.addEventListener("pointerdown", (e) => this.down(e), { capture: true });
    canvas.addEventListener("pointermove", (e) => this.move(e));
    canvas.addEventListener("pointerleave", () => this.foresee(null));
    canvas.addEventListener("wheel", (e) => this.wheel(e), { capture: true, passive: false });
    for (const end of ["pointerup", "pointercancel", "lostpointercapture"] as const) {
      canvas.addEventListener(end, (e) => this.up(e));
    }
  }

  get pushing(): boolean {
    return this.pointer >= 0;
  }

  use(on: boolean): void {
    this.on = on;
    if (!on) this.release();
    this.foresee(null);
  }

  /** Changes the depth by notches; negative is less deep. */
  deepen(notches: number): void {
    this.depth = THREE.MathUtils.clamp(this.depth + NOTCH * notches, 0, DEEPEST);
    this.deepened();
  }

  release(): void {
    if (!this.pushing) return;
    this.forget();
    this.send({ type: "ball" });
  }

  /** The ball was removed: a reset, another scene, or loss of the controls. */
  forget(): void {
    this.pointer = -1;
    this.sent = "";
    this.there = false;
    this.foresee(null);
    this.stage.controls.enabled = true;
  }

  /** The ball of the simulation. While it is absent or still growing, its target is shown. */
  hear(ball: SphereStatus | null): void {
    this.there = ball !== null && ball.radius > 0.5 * this.radius;
  }

  /** Once per frame: continues the push and sends the target of the ball. */
  update(now: number): void {
    const passed = Math.min(now - this.now, 100);
    this.now = now;
    if (!this.pushing) return;
    this.pushed += (this.depth * this.radius - this.pushed) * (1 - Math.exp(-passed / PUSH_TIME));
    const center = this.target.clone().addScaledVector(this.inward, this.pushed);
    this.foresee(this.there ? null : center);
    const point = center.toArray() as Vec;
    const message: Command = { type: "ball", point, radius: this.radius };
    const key = point.map((c) => (c / this.radius).toFixed(4)).join() + this.radius;
    if (key !== this.sent && this.send(message)) this.sent = key;
  }

  /** The centre at which the ball touches the tissue at that point, under the pointer. */
  private touching(hit: THREE.Intersection, along: THREE.Vector3): THREE.Vector3 {
    const slope = hit.normal ? Math.abs(hit.normal.dot(along)) : 1;
    return hit.point.clone().addScaledVector(along, -this.radius / Math.max(slope, FLATTEST));
  }

  private down(event: PointerEvent): void {
    if (!this.on || !this.mayPush || this.pushing || event.button !== 0 || event.ctrlKey || event.metaKey) return;
    const hit = this.picker.hit(event);
    if (!hit) return;
    this.stage.controls.enabled = false;
    this.pointer = event.pointerId;
    this.stage.canvas.setPointerCapture(event.pointerId);
    this.target.copy(this.touching(hit, this.picker.along(event)));
    this.stage.camera.getWorldDirection(this.inward);
    this.plane.setFromNormalAndCoplanarPoint(this.inward, this.target);
    this.pushed = 0;
    this.foresee(null);
  }

  private move(event: PointerEvent): void {
    if (event.pointerId === this.pointer) {
      this.picker.onPlane(event, this.plane, this.target);
    } else if (this.on && this.mayPush && !this.pushing && event.buttons === 0 && event.pointerType !== "touch") {
      const hit = this.picker.hit(event);
      this.foresee(hit && this.touching(hit, this.picker.along(event)));
      this.stage.canvas.style.cursor = hit ? "crosshair" : "";
    }
  }

  private up(event: PointerEvent): void {
    if (event.pointerId === this.pointer) this.release();
  }

  private wheel(event: WheelEvent): void {
    if (!this.on || !(event.shiftKey || this.pushing)) return;
    event.preventDefault();
    event.stopImmediatePropagation();
    // With Shift some browsers turn the wheel sideways.
    this.deepen(-Math.sign(event.deltaY || event.deltaX));
  }

  /** Shows the place where the ball would appear; null: none. */
  private foresee(center: THREE.Vector3 | null): void {
    if (center === null && !this.preview.visible) return;
    this.preview.visible = center !== null;
    if (center) this.preview.position.copy(center);
    this.preview.scale.setScalar(this.radius);
    this.stage.changed();
  }
}
