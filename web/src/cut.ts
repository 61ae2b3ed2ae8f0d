// The cut: the hidden half of the body, by a direction and a slider.
import * as THREE from "three";
import { h, iconButton } from "./dom";
import { length } from "./format";
import type { Command, CutPlane, Vec } from "./protocol";
import { Slider } from "./slider";

const AXES: [string, string, Vec][] = [
  ["x", "Across x", [1, 0, 0]],
  ["y", "Across y", [0, 1, 0]],
  ["z", "Across z", [0, 0, 1]],
];
const FACING = "facing";
const SAME = 1e-4; // of the direction

export class CutControl {
  readonly label: HTMLElement;
  readonly settings: HTMLElement;
  private readonly toggle = h("input", { type: "checkbox", id: "show-cut" });
  private readonly axis = h("select", { id: "cut-axis", "aria-label": "Direction of the cut" },
    ...AXES.map(([value, text]) => h("option", { value }, text)), h("option", { value: FACING }, "Facing me"));
  private readonly other = iconButton("flip", "The other half", "", () => this.flip());
  private readonly slider: Slider;
  private readonly normal = new THREE.Vector3(0, 0, 1);
  private box = new THREE.Box3();

  /** `towardsViewer`: the direction from the body to the camera. */
  constructor(
    private readonly send: (command: Command) => boolean,
    private readonly towardsViewer: () => THREE.Vector3,
  ) {
    this.axis.value = "z";
    this.slider = new Slider({
      label: "Offset",
      low: 0,
      high: 1,
      step: 0.005,
      show: (share) => length(this.offset(share)),
      changed: () => this.tell(),
    });
    this.slider.set(0.5);
    this.toggle.addEventListener("change", () => this.set(this.toggle.checked));
    this.axis.addEventListener("change", () => this.turn());
    this.settings = h("div", { id: "cut-settings" },
      h("div", { class: "beside" }, this.axis, this.other), this.slider.element);
    this.label = h("label", { class: "toggle", title: "Cut (X)" }, this.toggle, h("span", {}, "Cut"));
    this.settings.hidden = true;
  }

  get on(): boolean {
    return this.toggle.checked;
  }

  set(on: boolean): void {
    if (on && this.axis.value === FACING) this.normal.copy(this.towardsViewer());
    this.show(on);
    this.tell();
  }

  setEnabled(on: boolean): void {
    for (const part of [this.toggle, this.axis, this.other, this.slider.input]) part.disabled = !on;
  }

  /** The bounds of the whole body at rest [m]. */
  setBox(box: THREE.Box3): void {
    this.box = box;
    this.slider.refresh();
  }

  /** The cut of the server: this viewer's, or another's. */
  hear(cut: CutPlane | null): void {
    this.show(cut !== null);
    if (!cut) return;
    const normal = new THREE.Vector3(...cut.normal);
    const size = normal.length() || 1;
    if (normal.divideScalar(size).distanceTo(this.normal) > SAME) {
      this.normal.copy(normal);
      const along = AXES.find(([, , axis]) => Math.abs(normal.dot(new THREE.Vector3(...axis))) > 1 - SAME);
      this.axis.value = along?.[0] ?? FACING;
    }
    const [low, high] = this.reach();
    if (high > low) this.slider.set(THREE.MathUtils.clamp((cut.offset / size - low) / (high - low), 0, 1));
  }

  private show(on: boolean): void {
    this.toggle.checked = on;
    this.settings.hidden = !on;
  }

  private turn(): void {
    const axis = AXES.find(([value]) => value === this.axis.value);
    if (axis) this.normal.fromArray(axis[2]);
    else this.normal.copy(this.towardsViewer());
    this.slider.refresh();
    this.tell();
  }

  private flip(): void {
    this.normal.negate();
    this.slider.put(1 - this.slider.value);
    this.tell();
  }

  private tell(): void {
    if (!this.on) this.send({ type: "cut" });
    else this.send({ type: "cut", normal: this.normal.toArray() as Vec, offset: this.offset(this.slider.value) });
  }

  private offset(share: number): number {
    const [low, high] = this.reach();
    return low + share * (high - low);
  }

  /** Extent of the body along the direction, from and to [m]. */
  private reach(): [number, number] {
    if (this.box.isEmpty()) return [0, 0];
    const middle = this.box.getCenter(new THREE.Vector3()).dot(this.normal);
    const size = this.box.getSize(new THREE.Vector3()).multiplyScalar(0.5);
    const half = Math.abs(this.normal.x) * size.x + Math.abs(this.normal.y) * size.y + Math.abs(this.normal.z) * size.z;
    return [middle - half, middle + half];
  }
}
