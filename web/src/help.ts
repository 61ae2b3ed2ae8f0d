// The overlay that names every key and gesture.
import { h } from "./dom";

export const KEYS: [string, string][] = [
  ["Space", "Run or pause"],
  ["S", "One step"],
  ["Shift + S", "One frame (1/60 s)"],
  ["R", "Back to the start"],
  ["T", "Next tool: pull, pin, push, cut"],
  ["[ ]", "Ball or scalpel less deep, deeper"],
  ["Z", "Undo the last cut (Shift: make it again)"],
  ["Esc", "Let go of everything; close this"],
  ["C", "Next colouring (Shift: previous)"],
  ["W", "Wireframe"],
  ["U", "Undeformed ghost"],
  ["N", "Pinned nodes"],
  ["K", "Nodes that touch something"],
  ["L", "Springs, through a clear surface"],
  ["X", "Cut"],
  ["G", "Ground grid"],
  ["V", "Options of the view"],
  ["F", "Whole body in view"],
  ["P", "Panel"],
  ["D", "Plots"],
  ["E", "Save: picture, video, data, scene, state"],
  ["O", "Scenes"],
  ["H or ?", "This help"],
];
const GESTURES: [string, string][] = [
  ["Drag the tissue", "Pull it: a spring from there to the pointer"],
  ["Shift + click the tissue", "Pin it there; again: let go"],
  ["Hold the tissue with the ball tool", "A ball is pushed in there; drag to stroke, Shift + wheel: how deep"],
  ["Drag over the tissue with the scalpel", "It is cut along the way, as deep as the slider says"],
  ["Drag beside it", "Turn the view"],
  ["Wheel or two fingers", "Zoom"],
  ["Right button or two fingers", "Move the view"],
  ["Drop files", "Open a scene with its meshes, or a mesh"],
  ["Drag in a plot", "Zoom in; double click: all"],
];

export class Help {
  readonly element: HTMLDialogElement;

  constructor() {
    const close = h("button", { type: "button", class: "text" }, "Close");
    const list = (entries: [string, string][], className = "") =>
      h("dl", { class: className }, ...entries.flatMap(([key, what]) => [h("dt", {}, h("kbd", {}, key)), h("dd", {}, what)]));
    this.element = h("dialog", { id: "help", "aria-label": "Keys and gestures", "data-key": "h" },
      h("h2", {}, "Keys"), list(KEYS, "pairs"), h("h2", {}, "Mouse and touch"), list(GESTURES), close);
    close.addEventListener("click", () => this.element.close());
    this.element.addEventListener("click", (e) => {
      if (e.target === this.element) this.element.close();
    });
  }

  toggle(): void {
    if (this.element.open) this.element.close();
    else this.element.showModal();
  }
}
