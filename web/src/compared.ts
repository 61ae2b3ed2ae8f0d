// The body with another law: over the first as glass, or beside it.
import * as THREE from "three";
import { linearOf } from "./colors";
import { length } from "./format";
import { Label } from "./labels";
import type { Corners } from "./smooth";
import { cornersOf, type Stage } from "./stage";
import { Surface } from "./surface";

export type Arrangement = "over" | "beside";

const ICE = linearOf("#5cc4e8"); // of the glass
const DEEP = linearOf("#2a6a86"); // of the solid body
const APART = 1.1; // of the body's extent, from middle to middle
export const SAME_PLACE = 1e-7; // [m]: smaller distances count as zero
const ABOVE = 34; // [px] of the labels over the bodies
const ROW = 28;
const SEEN_THROUGH = 1.5; // largest distances

export class Compared {
  readonly group: THREE.Group;
  arrangement: Arrangement = "over";
  /** Offset of this body's drawing from the first body [m]. */
  readonly shift = new THREE.Vector3();
  private readonly nearer = { value: 0 }; // [m]
  private readonly surface = new Surface({ clear: 0.1, rim: 0.62, nearer: this.nearer });
  private readonly labels: [Label, Label];
  private titles: [string, string] | null = null;
  private ice: Float32Array = new Float32Array();
  private deep: Float32Array = new Float32Array();

  constructor(labels: HTMLElement) {
    this.group = this.surface.group;
    this.group.visible = false;
    this.surface.setGlass(true);
    this.labels = [new Label(labels, "law first"), new Label(labels, "law second")];
    for (const label of this.labels) label.element.hidden = true;
  }

  get shown(): boolean {
    return this.group.visible;
  }

  build(corners: Corners, nodes: number): void {
    this.surface.build(corners);
    this.ice = new Float32Array(3 * nodes).map((_, i) => ICE[i % 3]);
    this.deep = new Float32Array(3 * nodes).map((_, i) => DEEP[i % 3]);
    this.group.visible = false; // until a frame has its position
  }

  /** Titles of the laws of both bodies; none: nothing is compared. */
  name(titles: [string, string] | null): void {
    this.titles = titles;
    for (const label of this.labels) label.element.hidden = titles === null;
    this.tell(0);
  }

  /** The largest distance of the bodies [m]. */
  tell(largest: number): void {
    if (!this.titles) return;
    // It is visible inside the first body, but not through anything else.
    this.nearer.value = SEEN_THROUGH * largest;
    this.labels[0].write(this.titles[0]);
    this.labels[1].write(this.titles[1] + (largest > SAME_PLACE ? ` · up to ${length(largest, 2)} away` : ""));
  }

  /** `across`: the camera's current direction to the right. */
  arrange(how: Arrangement, box: THREE.Box3, across: THREE.Vector3): void {
    this.arrangement = how;
    this.surface.setGlass(how === "over");
    for (const label of this.labels) label.element.classList.toggle("over", how === "over");
    this.shift.set(0, 0, 0);
    if (how === "beside") this.shift.copy(across).multiplyScalar(APART * extentAlong(box, across));
    this.group.position.copy(this.shift);
  }

  /** Positions [m] and colours by node; colours only if both bodies share them. */
  show(x: Float32Array | null, colors: Float32Array | null): void {
    this.group.visible = x !== null;
    if (!x) return;
    this.surface.place(x);
    const beside = this.arrangement === "beside";
    this.surface.setColored(beside && colors !== null);
    this.surface.paint(beside ? (colors ?? this.deep) : this.ice);
  }

  /** Once per frame: the names above the bodies. `first`: the bounds of the first one. */
  update(stage: Stage, first: THREE.Box3): void {
    if (!this.shown) return;
    const over = this.arrangement === "over";
    const own = this.surface.box.clone().translate(this.shift);
    const top = topOf(over ? own.union(first) : first, stage.camera);
    this.labels[0].put(stage, top, 0, -ABOVE - (over ? ROW : 0));
    this.labels[1].put(stage, over ? top : topOf(own, stage.camera), 0, -ABOVE);
  }
}

function extentAlong(box: THREE.Box3, axis: THREE.Vector3): number {
  const size = box.getSize(new THREE.Vector3());
  return Math.abs(size.x * axis.x) + Math.abs(size.y * axis.y) + Math.abs(size.z * axis.z);
}

/** The middle of the upper edge of a box in the image, from -1 to 1. */
function topOf(box: THREE.Box3, camera: THREE.Camera): THREE.Vector3 {
  const seen = new THREE.Box3();
  for (const corner of cornersOf(box)) seen.expandByPoint(corner.project(camera));
  return new THREE.Vector3(0.5 * (seen.min.x + seen.max.x), seen.max.y, seen.max.z);
}
