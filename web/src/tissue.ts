// The surface of the bodies: geometry that follows the frames, and its looks.
import * as THREE from "three";
import { categories, ColorMap, diverging, linearOf, sequential } from "./colors";
import type { Frame, SceneInfo, Topology } from "./protocol";
import { Range } from "./range";
import { splitCorners } from "./smooth";

const CREASE = (60 / 180) * Math.PI;
const FLESH = linearOf("#7d3028");
const TISSUE_GLOSS = { roughness: 0.5, clearcoat: 0.45, clearcoatRoughness: 0.35 };
const COLOR_GLOSS = { roughness: 0.85, clearcoat: 0, clearcoatRoughness: 0.3 }; // colours read true
const LIGHTER = 1.35; // of the regions in the plain look

export class Tissue {
  readonly group = new THREE.Group();
  readonly mesh: THREE.Mesh<THREE.BufferGeometry, THREE.MeshPhysicalMaterial>;
  readonly range = new Range();
  /** Positions of the surface nodes as last shown [m]. */
  positions: Float32Array = new Float32Array();
  rest: Float32Array = new Float32Array();
  private topology: Topology | null = null;
  private nodeOf: Uint32Array = new Uint32Array();
  private readonly wires: THREE.LineSegments;
  private readonly ghost: THREE.Mesh;
  private readonly pins: THREE.Points;
  private plain: Float32Array = new Float32Array();

  constructor() {
    const material = new THREE.MeshPhysicalMaterial({
      vertexColors: true,
      ...TISSUE_GLOSS,
      side: THREE.DoubleSide,
      shadowSide: THREE.BackSide,
    });
    this.mesh = new THREE.Mesh(new THREE.BufferGeometry(), material);
    this.mesh.castShadow = true;
    this.mesh.receiveShadow = true;
    this.wires = new THREE.LineSegments(
      new THREE.BufferGeometry(),
      new THREE.LineBasicMaterial({ color: 0x0b0f14, transparent: true, opacity: 0.45 }),
    );
    this.wires.visible = false;
    this.ghost = new THREE.Mesh(
      new THREE.BufferGeometry(),
      new THREE.MeshBasicMaterial({ color: 0x9fc3e8, transparent: true, opacity: 0.13, depthWrite: false }),
    );
    this.ghost.visible = false;
    this.pins = new THREE.Points(
      new THREE.BufferGeometry(),
      new THREE.PointsMaterial({ color: 0x7fd4ff, size: 5, sizeAttenuation: false }),
    );
    this.pins.visible = false;
    for (const o of [this.mesh, this.wires, this.ghost, this.pins]) {
      o.frustumCulled = false;
      this.group.add(o);
    }
    // Lines and points in front of the faces they lie in.
    material.polygonOffset = true;
    material.polygonOffsetFactor = 1;
    material.polygonOffsetUnits = 1;
  }

  build(topology: Topology): void {
    this.topology = topology;
    this.rest = topology.rest.slice();
    const { node, index } = splitCorners(topology.triangles, topology.rest, CREASE);
    this.nodeOf = node;
    for (const o of [this.mesh, this.wires, this.ghost, this.pins]) o.geometry.dispose();
    const geometry = new THREE.BufferGeometry();
    geometry.setIndex(new THREE.BufferAttribute(index, 1));
    for (const name of ["position", "normal", "color"]) {
      const attribute = new THREE.BufferAttribute(new Float32Array(3 * node.length), 3);
      geometry.setAttribute(name, attribute.setUsage(THREE.DynamicDrawUsage));
    }
    geometry.boundingSphere = new THREE.Sphere();
    this.mesh.geometry = geometry;
    // Drawn before any surface was there, it was compiled for one without normals: flat.
    this.mesh.material.needsUpdate = true;

    // Lines and pins share one set of positions by node.
    const byNode = new THREE.BufferAttribute(topology.rest.slice(), 3).setUsage(THREE.DynamicDrawUsage);
    this.wires.geometry = new THREE.BufferGeometry().setAttribute("position", byNode);
    this.wires.geometry.setIndex(new THREE.BufferAttribute(edgesOf(topology.triangles), 1));
    this.pins.geometry = new THREE.BufferGeometry().setAttribute("position", byNode);
    const pinned = Array.from(topology.pinned.keys()).filter((i) => topology.pinned[i]);
    this.pins.geometry.setIndex(pinned);
    this.ghost.geometry = new THREE.BufferGeometry();
    this.ghost.geometry.setAttribute("position", new THREE.BufferAttribute(topology.rest.slice(), 3));
    this.ghost.geometry.setIndex(new THREE.BufferAttribute(topology.triangles.slice(), 1));
    this.plain = plainColors(topology);
    this.range.reset();
    this.place(topology.rest);
    this.paint(this.plain);
  }

  get nodes(): number {
    return this.rest.length / 3;
  }

  fits(frame: Frame): boolean {
    return this.topology?.revision === frame.revision && 3 * frame.value.length === this.rest.length;
  }

  /** Shows a frame. `scene` null: in the plain look. Returns whether the colour bar changed. */
  show(frame: Frame, scene: SceneInfo | null, now: number): boolean {
    this.place(frame.position);
    const info = scene?.quantities[frame.quantity];
    this.setGloss(info ? COLOR_GLOSS : TISSUE_GLOSS);
    if (!info) {
      this.paint(this.plain);
      return false;
    }
    if (info.name === "region") {
      this.paintRegions();
      return false;
    }
    const changed = this.range.take(frame.value, floorOf(info.name, scene!), now);
    this.paintValues(frame.value, info.signed);
    return changed;
  }

  private setGloss(gloss: typeof TISSUE_GLOSS): void {
    Object.assign(this.mesh.material, gloss);
  }

  setWireframe(on: boolean): void {
    this.wires.visible = on;
  }
  setGhost(on: boolean): void {
    this.ghost.visible = on;
  }
  setPins(on: boolean): void {
    this.pins.visible = on;
  }

  point(node: number, to: THREE.Vector3): THREE.Vector3 {
    return to.fromArray(this.positions, 3 * node);
  }

  /** The surface node of a triangle's corner nearest to the point. */
  nearest(face: THREE.Face, point: THREE.Vector3): number {
    const at = new THREE.Vector3();
    let best = 0;
    let least = Infinity;
    for (const vertex of [face.a, face.b, face.c]) {
      const node = this.nodeOf[vertex];
      const distance = this.point(node, at).distanceToSquared(point);
      if (distance < least) [best, least] = [node, distance];
    }
    return best;
  }

  private place(x: Float32Array): void {
    this.positions = new Float32Array(x);
    const geometry = this.mesh.geometry;
    const to = geometry.getAttribute("position").array as Float32Array;
    for (let v = 0; v < this.nodeOf.length; ++v) {
      const n = 3 * this.nodeOf[v];
      to[3 * v] = x[n];
      to[3 * v + 1] = x[n + 1];
      to[3 * v + 2] = x[n + 2];
    }
    geometry.getAttribute("position").needsUpdate = true;
    geometry.computeVertexNormals();
    const box = new THREE.Box3().setFromArray(x);
    box.getBoundingSphere(geometry.boundingSphere!);
    const byNode = this.wires.geometry.getAttribute("position") as THREE.BufferAttribute;
    (byNode.array as Float32Array).set(x);
    byNode.needsUpdate = true;
  }

  private paint(byNode: Float32Array): void {
    const color = this.mesh.geometry.getAttribute("color");
    const to = color.array as Float32Array;
    for (let v = 0; v < this.nodeOf.length; ++v) {
      const n = 3 * this.nodeOf[v];
      to[3 * v] = byNode[n];
      to[3 * v + 1] = byNode[n + 1];
      to[3 * v + 2] = byNode[n + 2];
    }
    color.needsUpdate = true;
  }

  private paintValues(values: Float32Array, signed: boolean): void {
    const map = signed ? diverging : sequential;
    const colors = new Float32Array(this.rest.length);
    for (let n = 0; n < values.length; ++n) {
      const share = values[n] / this.range.top;
      const i = 3 * ColorMap.index(signed ? 0.5 + 0.5 * share : share);
      colors.set(map.linear.subarray(i, i + 3), 3 * n);
    }
    this.paint(colors);
  }

  private paintRegions(): void {
    const colors = new Float32Array(this.rest.length);
    this.topology!.region.forEach((r, n) => colors.set(linearOf(categories[r % categories.length]), 3 * n));
    this.paint(colors);
  }
}

/** What a quantity has to reach before its colours mean more than noise. */
function floorOf(name: string, scene: SceneInfo): number {
  const softest = Math.min(...scene.parts.map((p) => p.young));
  const floors: Record<string, number> = {
    displacement: 1e-3 * scene.diagonal,
    stretch: 1e-3,
    volume: 1e-3,
    stress: 1e-4 * softest,
    speed: 1e-3 * scene.diagonal,
  };
  return floors[name] ?? 1e-9;
}

function plainColors(topology: Topology): Float32Array {
  const colors = new Float32Array(topology.rest.length);
  topology.region.forEach((r, n) => {
    const light = r === 0 ? 1 : LIGHTER;
    for (let c = 0; c < 3; ++c) colors[3 * n + c] = FLESH[c] * light;
  });
  return colors;
}

/** Every edge of the triangles once. */
function edgesOf(triangles: Uint32Array): Uint32Array {
  const edges: number[] = [];
  for (let t = 0; t < triangles.length; t += 3) {
    for (let c = 0; c < 3; ++c) {
      const [a, b] = [triangles[t + c], triangles[t + ((c + 1) % 3)]];
      if (a < b) edges.push(a, b); // the neighbour has it the other way round
    }
  }
  return Uint32Array.from(edges);
}
