// Comparison of laws: the second law, and the display of both bodies.
import { type Arrangement, SAME_PLACE } from "./compared";
import { h } from "./dom";
import { fill, section, select } from "./form";
import { digits, length } from "./format";
import type { Command, SceneInfo, Status } from "./protocol";

export class CompareControl {
  readonly element: HTMLElement;
  arrangement: Arrangement = "over";
  private readonly law = select("With", []);
  private readonly ways = new Map<Arrangement, HTMLInputElement>();
  private readonly show: HTMLElement;
  private readonly words = h("p", { id: "distance", role: "status" });

  /** `arranged`: called with the chosen display of both bodies. */
  constructor(send: (command: Command) => boolean, arranged: (how: Arrangement) => void) {
    this.law.input.id = "compare-law";
    this.law.row.querySelector("label")!.htmlFor = "compare-law";
    this.law.input.addEventListener("change", () => {
      const law = this.law.input.value;
      send(law ? { type: "compare", law } : { type: "compare" });
    });
    for (const [how, text] of [["over", "Over it"], ["beside", "Beside it"]] as const) {
      const input = h("input", { type: "radio", name: "arrangement", id: `show-${how}`, class: "own", "aria-label": text });
      input.checked = how === this.arrangement;
      input.addEventListener("change", () => arranged((this.arrangement = how)));
      this.ways.set(how, input);
    }
    this.show = h("div", { class: "row select" }, h("span", {}, "Show"),
      h("div", { class: "choice", role: "radiogroup", "aria-label": "Show the compared body" },
        ...[...this.ways].map(([how, input]) => h("label", {}, input, h("span", {}, how === "over" ? "Over it" : "Beside it")))));
    this.element = section("Compare laws", this.law.row, this.show, this.words);
    this.element.id = "compare";
  }

  showScene(scene: SceneInfo): void {
    this.element.hidden = scene.laws.length === 0;
    fill(this.law.input, [["", "None"], ...scene.laws.map((l): [string, string] => [l.name, l.title])]);
    this.law.input.value = scene.compare;
    this.show.hidden = this.words.hidden = !scene.compare;
  }

  showStatus(status: Status): void {
    const text = status.distance ? distanceInWords(status.distance) : "";
    if (this.words.textContent !== text) this.words.textContent = text;
  }
}

export function distanceInWords({ largest, mean }: { largest: number; mean: number }): string {
  if (largest < SAME_PLACE) return "Both are in the same place";
  // Tenths of a millimetre are also shown in millimetres.
  const text = (metres: number) => (metres >= 1e-4 && metres < 1e-2 ? `${digits(1e3 * metres, 2)} mm` : length(metres, 2));
  const unbroken = (metres: number) => text(metres).replace(" ", "\u00a0");
  return `Largest distance ${unbroken(largest)}, mean ${unbroken(mean)}`;
}

/** Titles of the laws of the first body and of the compared one; null: there is none. */
export function titlesOf(scene: SceneInfo): [string, string] | null {
  if (!scene.compare) return null;
  const title = (name: string) => scene.laws.find((l) => l.name === name)?.title ?? name;
  const own = new Set(scene.parts.map((p) => p.law));
  return [own.size === 1 ? title([...own][0]) : "As the scene says", title(scene.compare)];
}
