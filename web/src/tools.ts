// The tools of the pointer: pull, pin, push with a ball, cut. Buttons and the tools' values.
import { DEEPEST } from "./ball";
import type { BallTool } from "./ball";
import { h, iconButton } from "./dom";
import { length } from "./format";
import type { Hands } from "./hands";
import type { Command, Status } from "./protocol";
import { DEEPEST_CUT, SHALLOWEST } from "./scalpel";
import type { Scalpel } from "./scalpel";
import { Slider } from "./slider";

const TOOLS = ["pull", "pin", "ball", "scalpel"] as const;
export type Tool = (typeof TOOLS)[number];
const LABELS: Record<Tool, string> = { pull: "Pull", pin: "Pin", ball: "Push with a ball", scalpel: "Cut with a scalpel" };
const SMALLEST = 0.02; // of the body's diagonal
const LARGEST = 0.2;
const USUAL = 0.08;

export class Tools {
  readonly buttons: HTMLButtonElement[];
  /** The values of the ball and of the scalpel; each is shown while it is the tool. */
  readonly cards: HTMLElement[];
  private tool: Tool = "pull";
  private diagonal = 0.1; // [m]
  private readonly radius: Slider;
  private readonly depth: Slider;
  private readonly reach: Slider;
  private readonly undo: HTMLButtonElement;
  private readonly redo: HTMLButtonElement;
  private readonly done = h("p", { id: "cut-done", role: "status" });

  constructor(
    private readonly hands: Hands,
    private readonly ball: BallTool,
    private readonly scalpel: Scalpel,
    private readonly send: (command: Command) => boolean,
  ) {
    this.buttons = TOOLS.map((tool) => iconButton(tool, LABELS[tool], "T", () => this.use(tool)));
    this.radius = new Slider({
      label: "Radius",
      low: SMALLEST,
      high: LARGEST,
      step: 0.002,
      show: (share) => length(share * this.diagonal, 2),
      changed: (share) => (ball.radius = share * this.diagonal),
    });
    this.depth = new Slider({
      label: "Depth",
      low: 0,
      high: DEEPEST,
      step: 0.05,
      show: (radii) => length(radii * this.radius.value * this.diagonal, 2),
      changed: (radii) => (ball.depth = radii),
    });
    this.radius.input.addEventListener("input", () => this.depth.refresh());
    ball.deepened = () => this.depth.put(ball.depth);
    this.radius.put(USUAL);
    this.depth.put(ball.depth);
    this.reach = new Slider({
      label: "Cut depth",
      low: SHALLOWEST,
      high: DEEPEST_CUT,
      step: 0.01,
      show: (share) => (share >= DEEPEST_CUT ? "through" : length(share * this.diagonal, 2)),
      changed: (share) => (scalpel.depth = share),
    });
    scalpel.deepened = () => this.reach.put(scalpel.depth);
    this.reach.put(scalpel.depth);
    this.undo = iconButton("undo", "Undo the last cut", "Z", () => this.takeBack());
    this.redo = iconButton("redo", "Make it again", "Shift + Z", () => this.makeAgain());
    const keys = (what: string) => h("span", { class: "keys" }, h("kbd", {}, "["), " ", h("kbd", {}, "]"), ` ${what}`);
    this.cards = [
      h("div", { id: "ball-card", class: "tool-card", role: "group", "aria-label": "Ball" },
        this.radius.element, this.depth.element,
        h("p", {}, "Press on the tissue and hold; drag to stroke it. ", keys("less deep, deeper"))),
      h("div", { id: "scalpel-card", class: "tool-card", role: "group", "aria-label": "Scalpel" },
        this.reach.element, h("div", { class: "again" }, this.undo, this.redo, this.done),
        h("p", {}, "Press on the tissue and draw. Undo returns to the moment before the cut. ", keys("less deep, deeper"))),
    ];
    this.use("pull");
  }

  use(tool: Tool): void {
    this.tool = tool;
    this.buttons.forEach((button, i) => button.setAttribute("aria-pressed", String(TOOLS[i] === tool)));
    this.hands.tool = tool === "pull" || tool === "pin" ? tool : null;
    this.ball.use(tool === "ball");
    this.scalpel.use(tool === "scalpel");
    this.cards[0].hidden = tool !== "ball";
    this.cards[1].hidden = tool !== "scalpel";
  }

  next(): void {
    this.use(TOOLS[(TOOLS.indexOf(this.tool) + 1) % TOOLS.length]);
  }

  /** Less deep, or deeper, by a notch: the tool in use. */
  deepen(notches: number): void {
    if (this.tool === "scalpel") this.scalpel.deepen(notches);
    else this.ball.deepen(notches);
  }

  takeBack(): void {
    this.send({ type: "undo" });
  }

  makeAgain(): void {
    this.send({ type: "redo" });
  }

  hear(status: Status): void {
    for (const [button, can] of [[this.undo, status.can_undo], [this.redo, status.can_redo]] as const) {
      if (button.disabled !== can) continue;
      // A button that is disabled while it has the focus would keep the keys to itself.
      if (!can && document.activeElement === button) document.querySelector<HTMLElement>("#view")!.focus();
      button.disabled = !can;
    }
    const area = status.cut_area >= 1e-3 ? `${(1e4 * status.cut_area).toFixed(0)} cm²` : `${(1e4 * status.cut_area).toPrecision(2)} cm²`;
    const text = status.cut_area > 0 ? `${area} cut${status.pieces > 1 ? `, ${status.pieces} pieces` : ""}` : "";
    if (this.done.textContent !== text) this.done.textContent = text;
  }

  /** The size of the body [m], of which the tools' values are a share. */
  setDiagonal(diagonal: number): void {
    this.diagonal = diagonal;
    this.ball.radius = this.radius.value * diagonal;
    this.scalpel.setDiagonal(diagonal);
    this.radius.refresh();
    this.depth.refresh();
    this.reach.refresh();
  }
}
