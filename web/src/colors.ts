// Colour maps for any colour vision: lightness alone gives the order. They interpolate a few anchors
// linearly in OKLab (Ottosson 2020), a perceptually uniform space.

type Rgb = [number, number, number]; // sRGB, 0 to 1

const toLinear = (c: number) => (c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4);
const toSrgb = (c: number) => (c <= 0.0031308 ? 12.92 * c : 1.055 * c ** (1 / 2.4) - 0.055);

function toLab([r, g, b]: Rgb): Rgb {
  const [R, G, B] = [toLinear(r), toLinear(g), toLinear(b)];
  const l = Math.cbrt(0.4122214708 * R + 0.5363325363 * G + 0.0514459929 * B);
  const m = Math.cbrt(0.2119034982 * R + 0.6806995451 * G + 0.1073969566 * B);
  const s = Math.cbrt(0.0883024619 * R + 0.2817188376 * G + 0.6299787005 * B);
  return [
    0.2104542553 * l + 0.793617785 * m - 0.0040720468 * s,
    1.9779984951 * l - 2.428592205 * m + 0.4505937099 * s,
    0.0259040371 * l + 0.7827717662 * m - 0.808675766 * s,
  ];
}

function fromLab([L, a, b]: Rgb): Rgb {
  const l = (L + 0.3963377774 * a + 0.2158037573 * b) ** 3;
  const m = (L - 0.1055613458 * a - 0.0638541728 * b) ** 3;
  const s = (L - 0.0894841775 * a - 1.291485548 * b) ** 3;
  const clamp = (c: number) => Math.min(1, Math.max(0, toSrgb(Math.min(1, Math.max(0, c)))));
  return [
    clamp(4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s),
    clamp(-1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s),
    clamp(-0.0041960863 * l - 0.7034186147 * m + 1.707614701 * s),
  ];
}

const hex = (text: string): Rgb => [1, 3, 5].map((i) => parseInt(text.slice(i, i + 2), 16) / 255) as Rgb;

export class ColorMap {
  static readonly size = 256;
  readonly srgb: Rgb[] = [];
  /** 3 linear components each, for the vertices of a mesh. */
  readonly linear = new Float32Array(3 * ColorMap.size);

  constructor(anchors: string[]) {
    const labs = anchors.map((a) => toLab(hex(a)));
    for (let i = 0; i < ColorMap.size; ++i) {
      const at = (i / (ColorMap.size - 1)) * (labs.length - 1);
      const k = Math.min(Math.floor(at), labs.length - 2);
      const mix = labs[k].map((c, j) => c + (at - k) * (labs[k + 1][j] - c)) as Rgb;
      const color = fromLab(mix);
      this.srgb.push(color);
      color.forEach((c, j) => (this.linear[3 * i + j] = toLinear(c)));
    }
  }

  /** Index of the colour for a share from 0 to 1. */
  static index(share: number): number {
    if (!(share > 0)) return 0;
    return share >= 1 ? ColorMap.size - 1 : Math.floor(share * ColorMap.size);
  }

  /** For CSS, bottom to top. */
  gradient(): string {
    const stops = [];
    for (let i = 0; i < ColorMap.size; i += 15) {
      stops.push(`rgb(${this.srgb[i].map((c) => Math.round(255 * c)).join(" ")})`);
    }
    return `linear-gradient(to top, ${stops.join(", ")})`;
  }
}

/** From small to large: dark blue, through grey violet and orange, to pale yellow. */
export const sequential = new ColorMap(["#2a3f9d", "#6a4fb0", "#b0579b", "#e0746c", "#f7b055", "#fdf3b0"]);
/** Around zero: blue below, pale in the middle, orange brown above. */
export const diverging = new ColorMap(["#0b4a8f", "#4f93c8", "#e9edf0", "#e39a52", "#8c3a06"]);
/** Regions, far apart in lightness and hue. */
export const categories = ["#b5533f", "#f2c14e", "#4f9dde", "#7fc8a0", "#c58be0", "#e88f6a", "#5d6bc4", "#d9d9d9"];

export function linearOf(color: string): Rgb {
  return hex(color).map(toLinear) as Rgb;
}
