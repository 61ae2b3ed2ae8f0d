// The surface of one body: a mesh with positions and colours by node.
import * as THREE from "three";
import { glass, GLASS_ORDER, type GlassOptions, nearestOnly } from "./glass";
import type { Corners } from "./smooth";

const TISSUE_GLOSS = { roughness: 0.5, clearcoat: 0.45, clearcoatRoughness: 0.35 };
const COLOR_GLOSS = { roughness: 0.85, clearcoat: 0, clearcoatRoughness: 0.3 }; // little gloss, so that colours are legible

export class Surface {
  readonly group = new THREE.Group();
  readonly mesh: THREE.Mesh<THREE.BufferGeometry, THREE.MeshPhysicalMaterial>;
  private readonly veil: THREE.Mesh; // hides the far sides of the glass
  private readonly solid: THREE.MeshPhysicalMaterial;
  private readonly clear: THREE.MeshPhysicalMaterial;
  /** The bounds of the surface [m]. */
  readonly box = new THREE.Box3();
  private nodeOf: Uint32Array = new Uint32Array();

  /** `glassy`: options of the glass. */
  constructor(glassy: GlassOptions) {
    this.solid = new THREE.MeshPhysicalMaterial({
      vertexColors: true,
      ...TISSUE_GLOSS,
      side: THREE.DoubleSide,
      shadowSide: THREE.BackSide,
    });
    // Draws lines and points in front of the faces that contain them.
    this.solid.polygonOffset = true;
    this.solid.polygonOffsetFactor = 1;
    this.solid.polygonOffsetUnits = 1;
    this.clear = glass({ vertexColors: true, ...glassy });
    this.mesh = new THREE.Mesh(new THREE.BufferGeometry(), this.solid);
    this.mesh.castShadow = true;
    this.mesh.receiveShadow = true;
    this.veil = new THREE.Mesh(this.mesh.geometry, nearestOnly(glassy.nearer));
    this.veil.renderOrder = GLASS_ORDER - 1;
    this.veil.visible = false;
    for (const o of [this.mesh, this.veil]) {
      o.frustumCulled = false;
      this.group.add(o);
    }
  }

  build(corners: Corners): void {
    this.nodeOf = corners.node;
    this.mesh.geometry.dispose();
    const geometry = new THREE.BufferGeometry();
    geometry.setIndex(new THREE.BufferAttribute(corners.index, 1));
    for (const name of ["position", "normal", "color"]) {
      const attribute = new THREE.BufferAttribute(new Float32Array(3 * corners.node.length), 3);
      geometry.setAttribute(name, attribute.setUsage(THREE.DynamicDrawUsage));
    }
    geometry.boundingSphere = new THREE.Sphere();
    this.mesh.geometry = this.veil.geometry = geometry;
    // If it was drawn before there was a surface, it was compiled without normals: flat.
    this.solid.needsUpdate = this.clear.needsUpdate = true;
  }

  /** The node that a vertex of the mesh belongs to. */
  node(vertex: number): number {
    return this.nodeOf[vertex];
  }

  setColored(on: boolean): void {
    Object.assign(this.solid, on ? COLOR_GLOSS : TISSUE_GLOSS);
  }

  setGlass(on: boolean): void {
    this.mesh.material = on ? this.clear : this.solid;
    this.mesh.renderOrder = on ? GLASS_ORDER : 0;
    this.veil.visible = on;
  }

  place(x: Float32Array): void {
    const geometry = this.mesh.geometry;
    this.spread(x, geometry.getAttribute("position"));
    geometry.computeVertexNormals();
    this.box.setFromArray(x).getBoundingSphere(geometry.boundingSphere!);
  }

  /** Three linear components a node. */
  paint(colors: Float32Array): void {
    this.spread(colors, this.mesh.geometry.getAttribute("color"));
  }

  private spread(byNode: Float32Array, attribute: THREE.BufferAttribute | THREE.InterleavedBufferAttribute): void {
    const to = attribute.array as Float32Array;
    for (let v = 0; v < this.nodeOf.length; ++v) {
      const n = 3 * this.nodeOf[v];
      to[3 * v] = byNode[n];
      to[3 * v + 1] = byNode[n + 1];
      to[3 * v + 2] = byNode[n + 2];
    }
    attribute.needsUpdate = true;
  }
}
