// Everything in the 3D view, and the effect of the pointer on it.
import * as THREE from "three";
import { BallTool } from "./ball";
import type { Arrangement } from "./compared";
import { titlesOf } from "./compare";
import { Hands } from "./hands";
import type { Shown } from "./options";
import { Picker } from "./picker";
import type { Command, Frame, SceneInfo, Status, Topology, Vec } from "./protocol";
import { Scalpel } from "./scalpel";
import { Spheres } from "./spheres";
import { cornersOf, Stage } from "./stage";
import { Tissue } from "./tissue";

const NEAR = 1; // diagonals from the body: obstacles within are in the first view
const FALL = 3; // diagonals from the body: ground within, to which it may fall, is in the first view

export class World {
  readonly stage: Stage;
  readonly tissue: Tissue;
  readonly spheres: Spheres;
  readonly hands: Hands;
  readonly ball: BallTool;
  readonly scalpel: Scalpel;
  /** The bounds of the whole body at rest, as far as they are known [m]. */
  readonly box = new THREE.Box3();
  shown: Frame | null = null;
  private scene: SceneInfo | null = null;
  private colored = false;
  private fitted = -1; // the scene that the camera was fitted to (its `opened`)
  private lookAround = false; // includes obstacles with the next status

  constructor(
    canvas: HTMLCanvasElement,
    labels: HTMLElement,
    send: (command: Command) => boolean,
  ) {
    this.stage = new Stage(canvas);
    this.tissue = new Tissue(labels);
    this.stage.scene.add(this.tissue.group);
    this.spheres = new Spheres(this.stage, labels);
    const picker = new Picker(this.stage, this.tissue);
    this.hands = new Hands(this.stage, this.tissue, picker, labels, send);
    this.ball = new BallTool(this.stage, picker, send);
    this.scalpel = new Scalpel(this.stage, this.tissue, picker, send);
  }

  /** Whether this browser has the controls. */
  setControls(have: boolean): void {
    this.hands.mayPull = this.ball.mayPush = this.scalpel.mayCut = have;
    if (have) return;
    this.hands.forget();
    this.ball.forget();
    this.scalpel.forget();
  }

  showScene(scene: SceneInfo, arrangement: Arrangement): void {
    const before = this.scene?.compare ?? "";
    this.scene = scene;
    this.spheres.showScene(scene.opened, scene.obstacles, scene.diagonal);
    this.tissue.compared.name(titlesOf(scene));
    if (before !== scene.compare && (!before || !scene.compare)) this.arrange(arrangement);
  }

  hear(status: Status): void {
    this.hands.hear(status.hands);
    this.spheres.hear(status);
    this.ball.hear(status.ball);
    this.tissue.compared.tell(status.distance?.largest ?? 0);
    if (!this.lookAround) return;
    this.lookAround = false;
    const all = this.box.clone();
    status.obstacles.forEach(({ center }, i) => {
      const at = new THREE.Vector3(...center);
      if (this.box.distanceToPoint(at) > NEAR * this.scene!.diagonal) return;
      all.union(new THREE.Box3().setFromCenterAndSize(at, new THREE.Vector3().setScalar(2 * Math.min(this.scene!.obstacles[i].radius, this.scene!.diagonal))));
    });
    if (!all.equals(this.box)) this.fit(all);
  }

  build(topology: Topology): void {
    const opened = this.scene?.opened ?? -1;
    // A cut or springs bring other nodes of the same scene: view and grabs stay.
    const same = opened === this.fitted;
    this.tissue.build(topology);
    this.shown = null;
    const box = new THREE.Box3().setFromArray(topology.rest);
    if (same) {
      this.box.union(box);
      this.hands.renumber();
      return;
    }
    this.forget();
    this.box.copy(box);
    this.fitted = opened;
    this.lookAround = (this.scene?.obstacles.length ?? 0) > 0;
    this.fit(box);
  }

  /** Fits the camera to everything, and to the ground to which it may fall. */
  private fit(box: THREE.Box3): void {
    const ground = this.scene?.ground ?? null;
    const seen = box.clone();
    if (ground) {
      const normal = new THREE.Vector3(...ground.normal).normalize();
      const plane = new THREE.Plane().setFromNormalAndCoplanarPoint(normal, new THREE.Vector3(...ground.point));
      const near = FALL * box.getSize(new THREE.Vector3()).length();
      for (const corner of cornersOf(box)) {
        const height = plane.distanceToPoint(corner);
        if (height > 0 && height < near) seen.expandByPoint(corner.addScaledVector(normal, -height));
      }
    }
    this.stage.fit(seen, ground);
  }

  /** Shows a frame, coloured or in the plain look. Returns false if it belongs to another topology. */
  show(frame: Frame, now: number): boolean {
    if (!this.tissue.fits(frame)) return false;
    this.tissue.show(frame, this.colored ? this.scene : null, now);
    this.shown = frame;
    this.stage.changed();
    return true;
  }

  setColored(on: boolean): void {
    this.colored = on;
    this.tissue.range.reset();
    if (!on && this.shown) this.tissue.show(this.shown, null, performance.now());
    this.stage.changed();
  }

  set(what: Shown, on: boolean): void {
    if (what === "grid") this.stage.setGrid(on);
    else this.tissue.set(what, on);
    this.stage.changed();
  }

  /** Arranges both bodies, over or beside each other: the camera turns to both. */
  arrange(how: Arrangement): void {
    const across = new THREE.Vector3().setFromMatrixColumn(this.stage.camera.matrixWorld, 0);
    const { compared } = this.tissue;
    const [was, comparing] = [compared.shift.clone(), Boolean(this.scene?.compare)];
    compared.arrange(comparing ? how : "over", this.box, across);
    if (this.shown) this.tissue.show(this.shown, this.colored ? this.scene : null, performance.now());
    if (!was.equals(compared.shift)) this.stage.include([this.box, this.box.clone().translate(compared.shift)]);
    this.stage.changed();
  }

  /** Shows body and obstacles in their current places, from a direction. */
  look(from: Vec, room?: number): void {
    // Only a part of a large object such as a table matters.
    const radii = this.scene?.obstacles.map((o) => Math.min(o.radius, this.scene!.diagonal)) ?? [];
    const boxes = this.spheres.obstaclesAt.map((at, i) =>
      new THREE.Box3().setFromCenterAndSize(new THREE.Vector3(...at), new THREE.Vector3().setScalar(2 * radii[i])));
    this.stage.look([this.tissue.box, ...boxes], new THREE.Vector3(...from).normalize(), room);
  }

  releaseAll(): void {
    this.hands.releaseAll();
    this.ball.release();
    this.scalpel.lift();
  }

  /** Removes all grabs: another scene, a reset, or loss of the controls. */
  forget(): void {
    this.hands.forget();
    this.ball.forget();
    this.scalpel.forget();
    this.spheres.drop();
  }

  /** Once per picture. Returns whether anything was drawn. */
  draw(now: number): boolean {
    this.hands.update();
    this.ball.update(now);
    this.scalpel.update();
    this.spheres.update(this.shown?.time ?? 0, now, this.tissue.compared.shift);
    this.tissue.compared.update(this.stage, this.tissue.box);
    if (this.hands.held.size > 0) this.stage.changed();
    return this.stage.draw(now);
  }
}
