// Rigid objects: obstacles of the scene and the ball, at their positions in the simulation.
import * as THREE from "three";
import { si } from "./format";
import { glass, GLASS_ORDER, nearestOnly } from "./glass";
import { Label } from "./labels";
import type { ObstacleInfo, SphereStatus, Status, Vec } from "./protocol";
import type { Stage } from "./stage";
import { Track } from "./track";

const LEAST_FORCE = 1e-3; // [N], smallest force with a label
const GROWTH = 0.3; // share of the difference between radii, per picture
const SHAPE = new THREE.SphereGeometry(1, 64, 40);
const PLANE = 4; // diameter of the drawn disc of a plane, in diagonals of the bodies

/** The geometry of an obstacle other than a sphere, in its own axes and in metres. */
function geometryOf(o: ObstacleInfo, diagonal: number): THREE.BufferGeometry | null {
  if (o.shape === "plane") return new THREE.CircleGeometry((PLANE / 2) * diagonal, 64).rotateX(-Math.PI / 2);
  if (o.shape === "sphere") return null;
  const soup = new THREE.BufferGeometry();
  soup.setAttribute("position", new THREE.Float32BufferAttribute(o.vertices, 3));
  soup.setIndex(o.triangles);
  if (o.normals.length > 0) return soup.setAttribute("normal", new THREE.Float32BufferAttribute(o.normals, 3));
  const flat = soup.toNonIndexed();
  flat.computeVertexNormals();
  return flat;
}

/** A rigid object with its force, and a twin beside a compared body. */
class Sphere {
  readonly group = new THREE.Group();
  readonly twin: THREE.Group;
  private readonly track = new Track();
  private readonly label: Label;
  private readonly turn = new THREE.Quaternion();

  /** `own`: its geometry in metres; null: a sphere, whose radius may change. */
  constructor(
    labels: HTMLElement,
    className: string,
    materials: THREE.Material[],
    private radius: number,
    private readonly own: THREE.BufferGeometry | null = null,
  ) {
    materials.forEach((material, i) => {
      const mesh = new THREE.Mesh(own ?? SHAPE, material);
      mesh.castShadow = i === 0;
      mesh.receiveShadow = true;
      // The last material is visible; the one before it hides its far side.
      mesh.renderOrder = material.transparent ? GLASS_ORDER + 2 + i : 0;
      this.group.add(mesh);
    });
    if (!own) this.group.scale.setScalar(radius);
    this.twin = this.group.clone();
    this.group.visible = this.twin.visible = false;
    this.label = new Label(labels, className);
  }

  hear(status: SphereStatus, time: number): void {
    this.track.hear(status.center, time);
    if (!this.own) this.radius = status.radius;
    if (status.turn) this.turn.set(...status.turn);
    const force = Math.hypot(...status.force);
    this.label.write(force < LEAST_FORCE ? "" : si(force, "N", force < 1 ? 2 : 3));
  }

  /** `beside`: offset of the twin; zero: there is none. Returns whether the picture changed. */
  update(stage: Stage, time: number, now: number, beside: THREE.Vector3): boolean {
    if (!this.track.known) return false;
    const appears = !this.group.visible;
    this.group.visible = true;
    const moved = this.track.follow(this.group.position, time, now, this.radius);
    const grows = !this.own && Math.abs(this.radius / this.group.scale.x - 1) > 0.01;
    const turns = this.group.quaternion.angleTo(this.turn) > 1e-4;
    if (turns) this.group.quaternion.slerp(this.turn, appears ? 1 : GROWTH);
    this.twin.quaternion.copy(this.group.quaternion);
    if (grows) this.group.scale.setScalar(THREE.MathUtils.lerp(this.group.scale.x, this.radius, GROWTH));
    this.twin.scale.copy(this.group.scale);
    this.twin.visible = beside.lengthSq() > 0;
    this.twin.position.copy(this.group.position).add(beside);
    const pixels = this.radius / stage.metresPerPixel();
    this.label.place(stage, this.group.position, 0.74 * pixels + 6, -0.74 * pixels - 20);
    return moved || grows || turns || appears;
  }

  remove(): void {
    this.label.remove();
    this.own?.dispose();
    this.group.removeFromParent();
    this.twin.removeFromParent();
  }
}

export class Spheres {
  private readonly group = new THREE.Group();
  private obstacles: Sphere[] = [];
  private ball: Sphere | null = null;
  private known = "";
  private readonly steel = new THREE.MeshPhysicalMaterial({
    color: 0x8ea2b4,
    roughness: 0.38,
    clearcoat: 0.7,
    clearcoatRoughness: 0.25,
  });
  // Visible from both sides and transparent: objects in a bowl or behind a wall matter.
  private readonly sheet = new THREE.MeshPhysicalMaterial({
    color: 0x8ea2b4,
    roughness: 0.45,
    side: THREE.DoubleSide,
    transparent: true,
    opacity: 0.45,
    depthWrite: false,
  });
  // The tissue behind the ball must be visible.
  private readonly amber = [nearestOnly(), glass({ color: 0xffc763, clear: 0.34, rim: 0.95 })];

  constructor(
    private readonly stage: Stage,
    private readonly labels: HTMLElement,
  ) {
    stage.scene.add(this.group);
  }

  /** Position of the drawn ball [m]; null: none. */
  get ballAt(): Vec | null {
    return this.ball ? (this.ball.group.position.toArray() as Vec) : null;
  }
  get obstaclesAt(): Vec[] {
    return this.obstacles.map((o) => o.group.position.toArray() as Vec);
  }

  showScene(opened: number, obstacles: ObstacleInfo[], diagonal: number): void {
    const key = JSON.stringify([opened, obstacles]);
    if (key === this.known) return;
    this.known = key;
    for (const o of this.obstacles) o.remove();
    this.obstacles = obstacles.map((o) => {
      const material = o.shape === "plane" || o.shape === "mesh" ? this.sheet : this.steel;
      return new Sphere(this.labels, "force steel", [material], o.radius, geometryOf(o, diagonal));
    });
    for (const o of this.obstacles) this.group.add(o.group, o.twin);
  }

  hear(status: Status): void {
    status.obstacles.forEach((o, i) => this.obstacles[i]?.hear(o, status.time));
    if (!status.ball) return this.drop();
    if (!this.ball) {
      this.ball = new Sphere(this.labels, "force", this.amber, status.ball.radius);
      this.group.add(this.ball.group, this.ball.twin);
    }
    this.ball.hear(status.ball, status.time);
  }

  /** The ball was removed. */
  drop(): void {
    if (!this.ball) return;
    this.ball.remove();
    this.ball = null;
    this.stage.changed();
  }

  /** Once per picture, which shows the simulated time [s]; `now` [ms]; `beside`: offset of a
   * compared body from the first [m]. */
  update(time: number, now: number, beside: THREE.Vector3): void {
    for (const sphere of this.ball ? [...this.obstacles, this.ball] : this.obstacles) {
      if (sphere.update(this.stage, time, now, beside)) this.stage.changed();
    }
  }
}
