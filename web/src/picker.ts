// Finds the point under the pointer.
import * as THREE from "three";
import type { Stage } from "./stage";
import type { Tissue } from "./tissue";

export class Picker {
  private readonly ray = new THREE.Raycaster();

  constructor(
    private readonly stage: Stage,
    private readonly tissue: Tissue,
  ) {}

  /** First intersection of the ray under the pointer with tissue. */
  hit(event: MouseEvent): THREE.Intersection | null {
    this.ray.setFromCamera(this.place(event), this.stage.camera);
    return this.ray.intersectObject(this.tissue.mesh, false)[0] ?? null;
  }

  /** Intersection of that ray with a plane; null if there is none. */
  onPlane(event: MouseEvent, plane: THREE.Plane, to: THREE.Vector3): THREE.Vector3 | null {
    this.ray.setFromCamera(this.place(event), this.stage.camera);
    return this.ray.ray.intersectPlane(plane, to);
  }

  /** The direction of that ray. */
  along(event: MouseEvent): THREE.Vector3 {
    this.ray.setFromCamera(this.place(event), this.stage.camera);
    return this.ray.ray.direction.clone();
  }

  private place(event: MouseEvent): THREE.Vector2 {
    const { left, top, width, height } = this.stage.canvas.getBoundingClientRect();
    return new THREE.Vector2((2 * (event.clientX - left)) / width - 1, 1 - (2 * (event.clientY - top)) / height);
  }
}
