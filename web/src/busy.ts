// Says that a step takes long, and offers to cancel it. The server sends a frame or a status after
// every step, at least every tenth of a second; silence means that it is at one.
import { h } from "./dom";

const LONG = 1000; // [ms]

export class Busy {
  readonly element: HTMLElement;
  private readonly text = h("span");
  private readonly button = h("button", { type: "button", class: "text", id: "cancel-step" }, "Cancel the step");
  private last = performance.now();
  private awaited = false;

  constructor(cancel: () => boolean) {
    this.element = h("div", { id: "busy", role: "status" }, this.text, this.button);
    this.button.addEventListener("click", () => {
      if (cancel()) this.text.textContent = "Cancelling …";
    });
  }

  heard(): void {
    this.last = performance.now();
    this.awaited = false;
  }

  /** A command was sent to which the server answers. */
  expect(): void {
    if (!this.awaited) this.last = performance.now();
    this.awaited = true;
  }

  /** Called with every picture. `running`: steps are being taken; `controls`: the button works. */
  update(running: boolean, controls: boolean): void {
    const silent = performance.now() - this.last;
    const shown = (running || this.awaited) && silent > LONG;
    if (this.element.hidden === !shown) {
      if (shown && !this.text.textContent!.startsWith("Cancel")) this.say(silent);
      return;
    }
    this.element.hidden = !shown;
    this.button.hidden = !controls;
    this.say(silent);
  }

  private say(silent: number): void {
    this.text.textContent = `A step has taken ${Math.floor(silent / 1000)} s so far`;
  }
}
