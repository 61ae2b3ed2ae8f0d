// The display of the bodies: surface, overlays, and colours.
import * as THREE from "three";
import { categories, ColorMap, diverging, linearOf, sequential } from "./colors";
import { Compared } from "./compared";
import { type Overlay, Overlays } from "./overlays";
import type { Frame, SceneInfo, Topology } from "./protocol";
import { Range } from "./range";
import { splitCorners } from "./smooth";
import { Surface } from "./surface";

const CREASE = (60 / 180) * Math.PI;
const FLESH = linearOf("#7d3028");
const LIGHTER = 1.35; // of the regions in the plain look
const PLAIN_SPRING = linearOf("#e8b9a4");

export class Tissue {
  readonly group = new THREE.Group();
  readonly range = new Range();
  readonly compared: Compared;
  /** Positions of the nodes as last shown [m]. */
  positions: Float32Array = new Float32Array();
  rest: Float32Array = new Float32Array();
  private topology: Topology | null = null;
  private readonly surface = new Surface({ clear: 0.1, rim: 0.62 });
  private readonly overlays = new Overlays();
  private plain: Float32Array = new Float32Array();
  private plainSprings: Float32Array = new Float32Array();

  constructor(labels: HTMLElement) {
    this.compared = new Compared(labels);
    this.group.add(this.surface.group, this.overlays.group, this.compared.group);
  }

  /** The objects that the pointer can hit. */
  get mesh(): THREE.Mesh {
    return this.surface.mesh;
  }
  get box(): THREE.Box3 {
    return this.surface.box;
  }
  get springs(): number {
    return (this.topology?.springs.length ?? 0) / 2;
  }

  build(topology: Topology): void {
    this.topology = topology;
    this.rest = topology.rest.slice();
    const corners = splitCorners(topology.triangles, topology.rest, CREASE);
    this.surface.build(corners);
    this.compared.build(corners, topology.region.length);
    this.overlays.build(topology);
    // The interior is visible through a surface of glass.
    this.surface.setGlass(topology.springs.length > 0);
    this.overlays.set("springs", topology.springs.length > 0);
    this.plain = plainColors(topology);
    this.plainSprings = new Float32Array(topology.rest.length).map((_, i) => PLAIN_SPRING[i % 3]);
    this.place(topology.rest);
    this.paint(this.plain);
  }

  fits(frame: Frame): boolean {
    return this.topology?.revision === frame.revision && 3 * frame.value.length === this.rest.length;
  }

  /** Shows a frame. `scene` null: in the plain look. */
  show(frame: Frame, scene: SceneInfo | null, now: number): void {
    this.place(frame.position);
    this.overlays.touch(frame.contact);
    const info = scene?.quantities[frame.quantity];
    this.surface.setColored(info !== undefined);
    let colors = this.plain;
    if (info?.name === "region") {
      colors = this.regionColors();
    } else if (info) {
      this.range.take(frame.value, floorOf(info.name, scene!), now);
      colors = this.valueColors(frame.value, info.signed);
    }
    this.paint(colors);
    // Only the distance is a value of both bodies.
    this.compared.show(frame.compared, info?.name === "distance" ? colors : null);
  }

  set(name: Exclude<Overlay, "springs">, on: boolean): void {
    this.overlays.set(name, on);
  }

  point(node: number, to: THREE.Vector3): THREE.Vector3 {
    return to.fromArray(this.positions, 3 * node);
  }

  /** The node at a rest position; -1: none. */
  nodeAtRest({ x, y, z }: THREE.Vector3): number {
    for (let i = 0; i < this.rest.length; i += 3) {
      if (this.rest[i] === x && this.rest[i + 1] === y && this.rest[i + 2] === z) return i / 3;
    }
    return -1;
  }

  /** The node of a triangle's corner nearest to the point. */
  nearest(face: THREE.Face, point: THREE.Vector3): number {
    const at = new THREE.Vector3();
    let best = 0;
    let least = Infinity;
    for (const vertex of [face.a, face.b, face.c]) {
      const node = this.surface.node(vertex);
      const distance = this.point(node, at).distanceToSquared(point);
      if (distance < least) [best, least] = [node, distance];
    }
    return best;
  }

  private place(x: Float32Array): void {
    this.positions = new Float32Array(x);
    this.surface.place(x);
    this.overlays.place(x);
  }

  private paint(colors: Float32Array): void {
    this.surface.paint(colors);
    this.overlays.paint(colors === this.plain ? this.plainSprings : colors);
  }

  private valueColors(values: Float32Array, signed: boolean): Float32Array {
    const map = signed ? diverging : sequential;
    const colors = new Float32Array(this.rest.length);
    for (let n = 0; n < values.length; ++n) {
      const share = values[n] / this.range.top;
      const i = 3 * ColorMap.index(signed ? 0.5 + 0.5 * share : share);
      colors.set(map.linear.subarray(i, i + 3), 3 * n);
    }
    return colors;
  }

  private regionColors(): Float32Array {
    const colors = new Float32Array(this.rest.length);
    this.topology!.region.forEach((r, n) => colors.set(linearOf(categories[r % categories.length]), 3 * n));
    return colors;
  }
}

/** The smallest range in which the colours of a quantity show more than noise. */
function floorOf(name: string, scene: SceneInfo): number {
  const softest = Math.min(...scene.parts.map((p) => p.young));
  const floors: Record<string, number> = {
    displacement: 1e-3 * scene.diagonal,
    distance: 1e-4 * scene.diagonal,
    stretch: 1e-3,
    volume: 1e-3,
    stress: 1e-4 * softest,
    energy: 1e-8 * softest,
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
