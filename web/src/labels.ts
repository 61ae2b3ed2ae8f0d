// Labels at positions in the scene.
import * as THREE from "three";
import type { Stage } from "./stage";

export class Label {
  readonly element = document.createElement("div");
  private readonly on = new THREE.Vector3();

  constructor(parent: HTMLElement, className: string) {
    this.element.className = className;
    parent.append(this.element);
  }

  write(text: string): void {
    if (this.element.textContent !== text) this.element.textContent = text;
  }

  /** Places it beside a point [m], offset by pixels to the right and below. */
  place(stage: Stage, point: THREE.Vector3, right: number, below: number): void {
    this.put(stage, this.on.copy(point).project(stage.camera), right, below);
  }

  /** The same beside a position in the image, from -1 to 1. */
  put(stage: Stage, { x, y, z }: THREE.Vector3, right: number, below: number): void {
    const { clientWidth: w, clientHeight: h } = stage.canvas;
    this.element.style.visibility = z < 1 ? "" : "hidden"; // not behind the viewer
    this.element.style.transform = `translate(${0.5 * w * (1 + x) + right}px, ${0.5 * h * (1 - y) + below}px)`;
  }

  remove(): void {
    this.element.remove();
  }
}
