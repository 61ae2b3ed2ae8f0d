// Pulling and pinning: the pointer on the tissue becomes a grab of the protocol (`hand`).
import * as THREE from "three";
import { si } from "./format";
import { Label } from "./labels";
import type { Picker } from "./picker";
import type { Command, HandInfo, Vec } from "./protocol";
import type { Stage } from "./stage";
import type { Tissue } from "./tissue";

const PULLING = 0; // the grab of the pointer; numbers from 1 on are pins
const MOST_HANDS = 16;

interface Held {
  node: number; // -1: hidden by a cut
  rest: THREE.Vector3; // of the node; identifies it in a new topology
  target: THREE.Vector3;
  arrow: THREE.Group;
  label: Label;
}

export class Hands {
  tool: "pull" | "pin" | null = "pull"; // null: another tool has the pointer
  mayPull = false; // this browser has the controls
  readonly held = new Map<number, Held>();
  private readonly plane = new THREE.Plane();
  private pointer = -1; // the pulling pointer
  private moved = false; // since the last frame
  private known = new Map<number, HandInfo>();

  constructor(
    private readonly stage: Stage,
    private readonly tissue: Tissue,
    private readonly picker: Picker,
    private readonly labels: HTMLElement,
    private readonly send: (command: Command) => boolean,
  ) {
    const canvas = stage.canvas;
    canvas.addEventListener("pointerdown", (e) => this.down(e), { capture: true });
    canvas.addEventListener("pointermove", (e) => this.move(e));
    for (const end of ["pointerup", "pointercancel", "lostpointercapture"] as const) {
      canvas.addEventListener(end, (e) => this.up(e));
    }
  }

  /** The grabs of the simulation. */
  hear(hands: HandInfo[]): void {
    this.known = new Map(hands.map((h) => [h.hand, h]));
  }

  /** The topology has new node numbers: grabs keep their nodes. */
  renumber(): void {
    for (const held of this.held.values()) held.node = this.tissue.nodeAtRest(held.rest);
  }

  releaseAll(): void {
    for (const hand of [...this.held.keys()]) this.release(hand);
  }

  /** All grabs were removed: another scene, or a reset. */
  forget(): void {
    for (const hand of [...this.held.keys()]) this.remove(hand);
    this.pointer = -1;
    this.stage.controls.enabled = true;
  }

  get pulling(): boolean {
    return this.pointer >= 0;
  }
  get pins(): number {
    return this.held.size - (this.pulling ? 1 : 0);
  }

  /** Once per frame: sends the last move, places arrows and labels. */
  update(): void {
    const pull = this.held.get(PULLING);
    if (this.moved && pull) this.send({ type: "drag", hand: PULLING, point: pull.target.toArray() as Vec });
    this.moved = false;
    const from = new THREE.Vector3();
    for (const [hand, held] of this.held) {
      const known = this.known.get(hand);
      if (held.node >= 0) this.tissue.point(held.node, from);
      else from.fromArray(known?.at ?? held.target.toArray());
      placeArrow(held.arrow, from, held.target, 3.2 * this.stage.metresPerPixel());
      const force = known && Math.hypot(...known.force);
      held.label.write(force === undefined ? "" : si(force, "N", force < 1 ? 2 : 3));
      held.label.place(this.stage, held.target, 14, -12);
    }
  }

  private down(event: PointerEvent): void {
    if (!this.tool || !this.mayPull || this.pulling || event.button !== 0 || event.ctrlKey || event.metaKey) return;
    const hit = this.picker.hit(event);
    if (!hit?.face) return;
    this.stage.controls.enabled = false;
    if (this.tool === "pin" || event.shiftKey) {
      this.togglePin(hit);
      return;
    }
    this.pointer = event.pointerId;
    this.stage.canvas.setPointerCapture(event.pointerId);
    const facing = this.stage.camera.getWorldDirection(new THREE.Vector3());
    this.plane.setFromNormalAndCoplanarPoint(facing, hit.point);
    this.grab(PULLING, this.tissue.nearest(hit.face, hit.point), hit.point);
  }

  private move(event: PointerEvent): void {
    if (event.pointerId !== this.pointer) {
      if (this.tool && event.buttons === 0) {
        this.stage.canvas.style.cursor = this.mayPull && this.picker.hit(event) ? "grab" : "";
      }
      return;
    }
    const target = this.held.get(PULLING)?.target;
    if (target && this.picker.onPlane(event, this.plane, target)) this.moved = true;
  }

  private up(event: PointerEvent): void {
    if (event.pointerId === this.pointer) {
      this.pointer = -1;
      this.release(PULLING);
    }
    if (this.tool && !this.pulling) this.stage.controls.enabled = true;
  }

  private togglePin(hit: THREE.Intersection): void {
    const near = 18 * this.stage.metresPerPixel();
    for (const [hand, held] of this.held) {
      if (hand !== PULLING && held.target.distanceTo(hit.point) < near) return this.release(hand);
    }
    for (let hand = 1; hand < MOST_HANDS; ++hand) {
      if (this.held.has(hand)) continue;
      return this.grab(hand, this.tissue.nearest(hit.face!, hit.point), hit.point);
    }
  }

  private grab(hand: number, node: number, point: THREE.Vector3): void {
    if (!this.send({ type: "grab", hand, node, point: point.toArray() as Vec })) return;
    const arrow = makeArrow(hand === PULLING ? 0xffd27a : 0x7fd4ff);
    const label = new Label(this.labels, hand === PULLING ? "force" : "force pin");
    this.stage.scene.add(arrow);
    const rest = new THREE.Vector3().fromArray(this.tissue.rest, 3 * node);
    this.held.set(hand, { node, rest, target: point.clone(), arrow, label });
  }

  private release(hand: number): void {
    if (!this.held.has(hand)) return;
    this.send({ type: "release", hand });
    this.remove(hand);
  }

  private remove(hand: number): void {
    const held = this.held.get(hand);
    held?.arrow.removeFromParent();
    this.stage.changed();
    held?.label.remove();
    this.held.delete(hand);
  }
}

function makeArrow(color: number): THREE.Group {
  const material = new THREE.MeshBasicMaterial({ color, depthTest: false, transparent: true, opacity: 0.95 });
  const group = new THREE.Group();
  const shaft = new THREE.Mesh(new THREE.CylinderGeometry(0.28, 0.28, 1, 12), material);
  const ball = new THREE.Mesh(new THREE.SphereGeometry(1.5, 20, 14), material);
  const foot = new THREE.Mesh(new THREE.SphereGeometry(0.9, 16, 10), material);
  group.add(shaft, ball, foot);
  for (const part of group.children) part.renderOrder = 10;
  return group;
}

/** From `from` to `to`, `width` [m] thick. */
function placeArrow(arrow: THREE.Group, from: THREE.Vector3, to: THREE.Vector3, width: number): void {
  const [shaft, ball, foot] = arrow.children;
  const way = to.clone().sub(from);
  const length = way.length();
  shaft.visible = length > 1e-9;
  if (shaft.visible) {
    shaft.position.copy(from).addScaledVector(way, 0.5);
    shaft.quaternion.setFromUnitVectors(new THREE.Vector3(0, 1, 0), way.divideScalar(length));
    shaft.scale.set(width, length, width);
  }
  ball.position.copy(to);
  foot.position.copy(from);
  ball.scale.setScalar(width);
  foot.scale.setScalar(width);
}
