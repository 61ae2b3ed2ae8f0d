// The scalpel: a press on the tissue puts a blade there that reaches in along the view; dragging
// draws it on, and the simulation cuts what it sweeps.
import * as THREE from "three";
import type { Picker } from "./picker";
import type { Command, Vec } from "./protocol";
import type { Stage } from "./stage";
import type { Tissue } from "./tissue";

const ABOVE = 0.04; // of the body's diagonal: how far the heel stays out of the tissue
const RING = 0.012; // of the diagonal: radius of the mark at the surface
const NOTCH = 0.02; // of the diagonal, for one press of a key
export const SHALLOWEST = 0.02; // of the diagonal
export const DEEPEST_CUT = 1; // of the diagonal: through everything
const BETWEEN = 0.004; // of the diagonal: shorter moves are not sent

export class Scalpel {
  mayCut = false; // this browser has the controls
  /** How far the blade reaches in, as a share of the body's diagonal. */
  depth = 0.12;
  /** Called when keys change the depth. */
  deepened: () => void = () => {};
  private on = false;
  private diagonal = 0.1; // [m]
  private pointer = -1; // the cutting pointer
  private readonly plane = new THREE.Plane(); // where the pointer is beside the tissue
  private readonly at = new THREE.Vector3(); // of the blade at the surface
  private readonly along = new THREE.Vector3(); // of the blade, from heel to tip
  private readonly sent = new THREE.Vector3();
  private moved = false; // since the last message
  private readonly mark: THREE.Mesh;

  constructor(
    private readonly stage: Stage,
    private readonly tissue: Tissue,
    private readonly picker: Picker,
    private readonly send: (command: Command) => boolean,
  ) {
    this.mark = new THREE.Mesh(
      new THREE.RingGeometry(0.7, 1, 40),
      new THREE.MeshBasicMaterial({ color: 0xffe9b0, depthTest: false, transparent: true, side: THREE.DoubleSide }),
    );
    this.mark.renderOrder = 1000;
    this.mark.visible = false;
    stage.scene.add(this.mark);
    const canvas = stage.canvas;
    canvas.addEventListener("pointerdown", (e) => this.down(e), { capture: true });
    canvas.addEventListener("pointermove", (e) => this.move(e));
    canvas.addEventListener("pointerleave", () => this.show(false));
    for (const end of ["pointerup", "pointercancel", "lostpointercapture"] as const) {
      canvas.addEventListener(end, (e) => this.up(e));
    }
  }

  get cutting(): boolean {
    return this.pointer >= 0;
  }

  use(on: boolean): void {
    this.on = on;
    if (!on) this.lift();
    this.show(false);
  }

  setDiagonal(diagonal: number): void {
    this.diagonal = diagonal;
  }

  /** Changes the depth by notches; negative is less deep. */
  deepen(notches: number): void {
    this.depth = THREE.MathUtils.clamp(this.depth + NOTCH * notches, SHALLOWEST, DEEPEST_CUT);
    this.deepened();
  }

  /** Ends the stroke. */
  lift(): void {
    if (!this.cutting) return;
    this.update();
    this.forget();
    this.send({ type: "blade" });
  }

  /** The stroke was ended elsewhere: a reset, another scene, or loss of the controls. */
  forget(): void {
    this.pointer = -1;
    this.moved = false;
    this.show(false);
    this.stage.controls.enabled = true;
  }

  /** Once per picture: sends the way of the blade. */
  update(): void {
    if (!this.cutting || !this.moved) return;
    if (this.at.distanceTo(this.sent) < BETWEEN * this.diagonal) return;
    if (this.send({ type: "blade", ...this.edge() })) this.sent.copy(this.at);
    this.moved = false;
  }

  private edge(): { heel: Vec; tip: Vec } {
    const heel = this.at.clone().addScaledVector(this.along, -ABOVE * this.diagonal);
    const tip = this.at.clone().addScaledVector(this.along, this.depth * this.diagonal);
    return { heel: heel.toArray() as Vec, tip: tip.toArray() as Vec };
  }

  private down(event: PointerEvent): void {
    if (!this.on || !this.mayCut || this.cutting || event.button !== 0 || event.ctrlKey || event.metaKey) return;
    const hit = this.picker.hit(event);
    if (!hit?.face) return;
    this.stage.controls.enabled = false;
    this.follow(event, hit);
    const node = this.tissue.nearest(hit.face, hit.point);
    if (!this.send({ type: "blade", node, ...this.edge() })) {
      this.stage.controls.enabled = true;
      return;
    }
    this.sent.copy(this.at);
    this.pointer = event.pointerId;
    this.stage.canvas.setPointerCapture(event.pointerId);
  }

  private move(event: PointerEvent): void {
    if (this.cutting ? event.pointerId !== this.pointer : !this.on || !this.mayCut || event.buttons !== 0) return;
    const hit = this.picker.hit(event);
    if (!this.cutting && !hit) {
      this.show(false);
      this.stage.canvas.style.cursor = "";
      return;
    }
    this.follow(event, hit);
    this.moved = true;
    this.stage.canvas.style.cursor = "crosshair";
    this.show(true);
  }

  /** Puts the blade on the tissue under the pointer; beside it, as far from the viewer as before. */
  private follow(event: PointerEvent, hit: THREE.Intersection | null): void {
    this.along.copy(this.picker.along(event));
    if (hit) {
      this.at.copy(hit.point);
      this.plane.setFromNormalAndCoplanarPoint(this.stage.camera.getWorldDirection(new THREE.Vector3()), hit.point);
    } else {
      this.picker.onPlane(event, this.plane, this.at);
    }
  }

  private up(event: PointerEvent): void {
    if (event.pointerId === this.pointer) this.lift();
  }

  private show(on: boolean): void {
    if (!on && !this.mark.visible) return;
    this.mark.visible = on;
    this.mark.position.copy(this.at);
    this.mark.scale.setScalar(RING * this.diagonal);
    this.mark.quaternion.copy(this.stage.camera.quaternion);
    this.stage.changed();
  }
}
