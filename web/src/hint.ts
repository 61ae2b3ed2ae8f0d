// The first steps, until the first use.
import { h, iconButton } from "./dom";

const SEEN = "sinew-first-steps";

export class Hint {
  readonly element: HTMLElement;

  constructor(canvas: HTMLCanvasElement) {
    const finger = matchMedia("(pointer: coarse)").matches;
    const steps = finger
      ? ["Press ▶ to run", "Drag the tissue to pull it", "Drag beside it to turn"]
      : ["Space runs", "Drag the tissue to pull it", "Drag beside it to turn", "H lists all keys"];
    this.element = h("div", { id: "hint", role: "note", hidden: known() },
      ...steps.map((s) => h("span", {}, s)), iconButton("close", "Close the first steps", "", () => this.done()));
    canvas.addEventListener("pointerdown", () => this.done());
  }

  done(): void {
    if (this.element.hidden) return;
    this.element.hidden = true;
    try {
      localStorage.setItem(SEEN, "yes");
    } catch {
      // A browser without storage shows it again the next time.
    }
  }
}

function known(): boolean {
  try {
    return localStorage.getItem(SEEN) !== null;
  } catch {
    return false;
  }
}
