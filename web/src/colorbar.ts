// The colour bar with its quantity, in physical units; for regions, a legend.
import { categories, diverging, sequential } from "./colors";
import { h } from "./dom";
import { quantity } from "./format";
import type { SceneInfo } from "./protocol";
import type { Range } from "./range";

export class ColorBar {
  readonly element = h("div", { id: "colorbar", role: "img" });
  private shown = "";

  /** `index` into the scene's quantities, -1: nothing to show. */
  show(scene: SceneInfo | null, index: number, range: Range): void {
    const { top, above, below } = range;
    const info = scene?.quantities[index];
    const key = JSON.stringify([info?.name, top, above, below, scene?.regions]);
    if (key === this.shown) return;
    this.shown = key;
    this.element.hidden = !info;
    if (!info || !scene) return;
    if (info.name === "region") {
      this.element.className = "legend";
      this.element.replaceChildren(
        h("div", { class: "title" }, info.title),
        ...scene.regions.map((name, i) =>
          h("div", { class: "entry" }, h("i", { style: `background:${categories[i % categories.length]}` }), name),
        ),
      );
      this.element.setAttribute("aria-label", `Colours: ${scene.regions.join(", ")}`);
      return;
    }
    const shares = info.signed ? [1, 0.5, 0, -0.5, -1] : [1, 0.75, 0.5, 0.25, 0];
    const texts = shares.map((s) => (info.signed && s > 0 ? "+" : "") + quantity(s * top, info.unit));
    // Outliers may be beyond the bar: its ends show that.
    if (above) texts[0] = `≥ ${texts[0]}`;
    if (below && info.signed) texts[4] = `≤ ${texts[4]}`;
    this.element.className = "bar";
    this.element.replaceChildren(
      h("div", { class: "title" }, info.title),
      h("div", { class: "scale" },
        h("div", { class: "colors", style: `background:${(info.signed ? diverging : sequential).gradient()}` }),
        h("div", { class: "ticks" }, ...texts.map((t) => h("span", {}, t))),
      ),
    );
    this.element.setAttribute("aria-label", `${info.title}: colours from ${texts[4]} to ${texts[0]}`);
  }
}

/** A bar of a round length with its label. */
export class ScaleBar {
  readonly element = h("div", { id: "scalebar", "aria-hidden": "true" }, h("span"), h("i"));
  private shown = "";

  show(metresPerPixel: number, text: (metres: number) => string): void {
    const most = 140 * metresPerPixel;
    const power = 10 ** Math.floor(Math.log10(most));
    const metres = [5, 2, 1].map((m) => m * power).find((m) => m <= most) ?? power;
    const width = `${Math.round(metres / metresPerPixel)}px`;
    const label = text(metres);
    if (this.shown === width + label) return;
    this.shown = width + label;
    (this.element.children[0] as HTMLElement).textContent = label;
    (this.element.children[1] as HTMLElement).style.width = width;
  }
}
