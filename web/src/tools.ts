// The tools of the pointer: pull, pin, or push with a ball. Buttons and the ball's values.
import { DEEPEST } from "./ball";
import type { BallTool } from "./ball";
import { h, iconButton } from "./dom";
import { length } from "./format";
import type { Hands } from "./hands";
import { Slider } from "./slider";

const TOOLS = ["pull", "pin", "ball"] as const;
export type Tool = (typeof TOOLS)[number];
const LABELS: Record<Tool, string> = { pull: "Pull", pin: "Pin", ball: "Push with a ball" };
const SMALLEST = 0.02; // of the body's diagonal
const LARGEST = 0.2;
const USUAL = 0.08;

export class Tools {
  readonly buttons: HTMLButtonElement[];
  /** The ball's values; shown while it is the tool. */
  readonly card: HTMLElement;
  private tool: Tool = "pull";
  private diagonal = 0.1; // [m]
  private readonly radius: Slider;
  private readonly depth: Slider;

  constructor(
    private readonly hands: Hands,
    private readonly ball: BallTool,
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
    this.card = h("div", { id: "ball-card", role: "group", "aria-label": "Ball" },
      this.radius.element, this.depth.element,
      h("p", {}, "Press on the tissue and hold; drag to stroke it. ",
        h("span", { class: "keys" }, h("kbd", {}, "["), " ", h("kbd", {}, "]"), " less deep, deeper")));
    this.use("pull");
  }

  use(tool: Tool): void {
    this.tool = tool;
    this.buttons.forEach((button, i) => button.setAttribute("aria-pressed", String(TOOLS[i] === tool)));
    this.hands.tool = tool === "ball" ? null : tool;
    this.ball.use(tool === "ball");
    this.card.hidden = tool !== "ball";
  }

  next(): void {
    this.use(TOOLS[(TOOLS.indexOf(this.tool) + 1) % TOOLS.length]);
  }

  /** The size of the body [m], of which the ball's radius is a share. */
  setDiagonal(diagonal: number): void {
    this.diagonal = diagonal;
    this.ball.radius = this.radius.value * diagonal;
    this.radius.refresh();
    this.depth.refresh();
  }
}
