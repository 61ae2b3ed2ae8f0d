// Error messages, shown long enough to be read.
import { h, iconButton } from "./dom";

const SHORTEST = 9000; // [ms]
const PER_LETTER = 70;

export class Notice {
  readonly element: HTMLElement;
  private readonly text = h("p");
  private timer: ReturnType<typeof setTimeout> | undefined;

  constructor() {
    this.element = h("div", { id: "alert", role: "alert" }, this.text, iconButton("close", "Close the message", "", () => this.hide()));
    // It stays while the pointer is on it.
    this.element.addEventListener("pointerenter", () => clearTimeout(this.timer));
    this.element.addEventListener("pointerleave", () => this.hideIn(SHORTEST));
  }

  /** `keep`: until it is closed. */
  show(message: string, keep = false): void {
    this.text.textContent = message;
    this.element.classList.add("on");
    this.element.classList.toggle("keep", keep);
    this.hideIn(Math.max(SHORTEST, PER_LETTER * message.length));
  }

  hide(): void {
    clearTimeout(this.timer);
    this.element.classList.remove("on");
  }

  private hideIn(wait: number): void {
    clearTimeout(this.timer);
    if (!this.element.classList.contains("keep")) this.timer = setTimeout(() => this.hide(), wait);
  }
}
