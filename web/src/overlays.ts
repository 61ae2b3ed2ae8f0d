// Lines and points over the surface: edges, ghost, pinned nodes, springs, nodes in contact.
import * as THREE from "three";
import type { Topology } from "./protocol";

export type Overlay = "wireframe" | "ghost" | "pins" | "springs" | "contacts";

const SPRING_OPACITY = 0.9; // for a thousand springs; with more springs each is clearer
const CONTACT_PIXELS = 11;
const THROUGH = 0.3; // opacity of a mark behind another surface

export class Overlays {
  readonly group = new THREE.Group();
  private readonly wires: THREE.LineSegments;
  private readonly ghost: THREE.Mesh;
  private readonly pins: THREE.Points;
  private readonly springs: THREE.LineSegments<THREE.BufferGeometry, THREE.LineBasicMaterial>;
  private readonly contacts: THREE.Points[];
  private position = new THREE.BufferAttribute(new Float32Array(), 3); // by node, shared by all but the ghost
  private color = new THREE.BufferAttribute(new Float32Array(), 3);
  private touching = new THREE.BufferAttribute(new Uint32Array(), 1); // nodes

  constructor() {
    this.wires = new THREE.LineSegments(
      new THREE.BufferGeometry(),
      new THREE.LineBasicMaterial({ color: 0x0b0f14, transparent: true, opacity: 0.45 }),
    );
    this.ghost = new THREE.Mesh(
      new THREE.BufferGeometry(),
      new THREE.MeshBasicMaterial({ color: 0x9fc3e8, transparent: true, opacity: 0.13, depthWrite: false }),
    );
    this.pins = new THREE.Points(
      new THREE.BufferGeometry(),
      new THREE.PointsMaterial({ color: 0x7fd4ff, size: 5, sizeAttenuation: false }),
    );
    this.springs = new THREE.LineSegments(
      new THREE.BufferGeometry(),
      new THREE.LineBasicMaterial({ vertexColors: true, transparent: true, depthWrite: false }),
    );
    // A mark usually lies between two bodies, so it is visible through them.
    const map = ringTexture();
    this.contacts = [1, THROUGH].map((opacity) => new THREE.Points(
      new THREE.BufferGeometry(),
      new THREE.PointsMaterial({ map, size: CONTACT_PIXELS, sizeAttenuation: false, transparent: true, opacity, depthWrite: false, depthTest: opacity === 1 }),
    ));
    for (const marks of this.contacts) marks.renderOrder = 8;
    for (const o of [this.wires, this.ghost, this.pins, this.springs, ...this.contacts]) {
      o.visible = false;
      o.frustumCulled = false;
      this.group.add(o);
    }
  }

  set(name: Overlay, on: boolean): void {
    if (name === "contacts") for (const marks of this.contacts) marks.visible = on;
    else ({ wireframe: this.wires, ghost: this.ghost, pins: this.pins, springs: this.springs })[name].visible = on;
  }

  build(topology: Topology): void {
    for (const o of [this.wires, this.ghost, this.pins, this.springs, ...this.contacts]) o.geometry.dispose();
    const nodes = topology.rest.length / 3;
    const byNode = () => new THREE.BufferAttribute(new Float32Array(3 * nodes), 3).setUsage(THREE.DynamicDrawUsage);
    this.position = byNode();
    this.color = byNode();
    this.touching = new THREE.BufferAttribute(new Uint32Array(nodes), 1).setUsage(THREE.DynamicDrawUsage);
    const geometry = (index: THREE.BufferAttribute) => {
      const made = new THREE.BufferGeometry().setAttribute("position", this.position);
      return made.setIndex(index);
    };
    const pinned = Uint32Array.from(Array.from(topology.pinned.keys()).filter((i) => topology.pinned[i]));
    this.wires.geometry = geometry(new THREE.BufferAttribute(edgesOf(topology.triangles), 1));
    this.pins.geometry = geometry(new THREE.BufferAttribute(pinned, 1));
    this.springs.geometry = geometry(new THREE.BufferAttribute(topology.springs.slice(), 1));
    this.springs.geometry.setAttribute("color", this.color);
    const opacity = SPRING_OPACITY / Math.sqrt(Math.max(1, topology.springs.length / 2000));
    this.springs.material.opacity = Math.max(0.12, opacity);
    for (const marks of this.contacts) marks.geometry = geometry(this.touching);
    this.touch(null);
    this.ghost.geometry = new THREE.BufferGeometry();
    this.ghost.geometry.setAttribute("position", new THREE.BufferAttribute(topology.rest.slice(), 3));
    this.ghost.geometry.setIndex(new THREE.BufferAttribute(topology.triangles.slice(), 1));
  }

  place(x: Float32Array): void {
    (this.position.array as Float32Array).set(x);
    this.position.needsUpdate = true;
  }

  /** Three linear components a node, the colours of spring ends. */
  paint(colors: Float32Array): void {
    if (!this.springs.visible) return;
    (this.color.array as Float32Array).set(colors);
    this.color.needsUpdate = true;
  }

  /** Marks the nodes in contact: those with the value 1. */
  touch(contact: Uint8Array | null): void {
    let count = 0;
    contact?.forEach((is, node) => {
      if (is) this.touching.array[count++] = node;
    });
    this.touching.needsUpdate = true;
    for (const marks of this.contacts) marks.geometry.setDrawRange(0, count);
  }
}

/** A pale disc with a dark rim: visible on any colour. */
function ringTexture(): THREE.Texture {
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = 64;
  const context = canvas.getContext("2d")!;
  const disc = (radius: number, color: string) => {
    context.fillStyle = color;
    context.beginPath();
    context.arc(32, 32, radius, 0, 2 * Math.PI);
    context.fill();
  };
  disc(30, "#0b0f14");
  disc(21, "#fff3b8");
  disc(10, "#0b0f14");
  const texture = new THREE.CanvasTexture(canvas);
  texture.colorSpace = THREE.SRGBColorSpace;
  return texture;
}

/** Every edge of the triangles once. */
function edgesOf(triangles: Uint32Array): Uint32Array {
  const edges: number[] = [];
  for (let t = 0; t < triangles.length; t += 3) {
    for (let c = 0; c < 3; ++c) {
      const [a, b] = [triangles[t + c], triangles[t + ((c + 1) % 3)]];
      if (a < b) edges.push(a, b); // the neighbour has it in the other direction
    }
  }
  return Uint32Array.from(edges);
}
