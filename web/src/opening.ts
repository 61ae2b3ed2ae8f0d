// Shows the progress of sending files and opening a scene.
import { h } from "./dom";

export class Opening {
  readonly element: HTMLElement;
  private readonly text = h("span");
  private readonly bar = h("progress", { max: 1, "aria-label": "Sent" });
  private readonly button = h("button", { type: "button", class: "text", id: "cancel-opening" }, "Cancel");
  private opened = -1; // number of scenes that the server had opened at the start
  private latest = 0;
  pending = false;

  constructor(cancel: () => void) {
    this.element = h("div", { id: "opening", role: "status", hidden: true }, h("i", { class: "spinner", "aria-hidden": "true" }), this.text, this.bar, this.button);
    this.button.addEventListener("click", cancel);
  }

  /** `share` of a file that has been sent. */
  sending(name: string, share: number): void {
    this.show(`Sending ${name} …`);
    this.bar.hidden = false;
    this.button.hidden = true;
    this.bar.value = share;
  }

  begin(title: string): void {
    this.show(`Opening ${title} …`);
    this.bar.hidden = true;
    this.button.hidden = false;
    this.opened = this.latest;
    this.pending = true;
  }

  /** A scene has opened; with the number of opened scenes. */
  scene(opened: number): void {
    this.latest = opened;
    if (this.pending && opened > this.opened) this.end();
  }

  end(): void {
    this.pending = false;
    this.button.blur(); // a hidden button would keep the keys
    this.element.hidden = true;
  }

  private show(text: string): void {
    this.element.hidden = false;
    if (this.text.textContent !== text) this.text.textContent = text;
  }
}
