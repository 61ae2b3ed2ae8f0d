import { describe, expect, it } from "vitest";
import { ColorMap, diverging, sequential } from "../src/colors";
import { length, niceAbove, percent, quantity, si } from "../src/format";
import { Range } from "../src/range";
import { splitCorners } from "../src/smooth";

describe("numbers", () => {
  it("have prefixes", () => {
    expect(si(15000, "Pa")).toBe("15 kPa");
    expect(si(1e9, "Pa")).toBe("1 GPa");
    expect(si(999.9, "Pa")).toBe("1 kPa");
    expect(si(0.000273, "s")).toBe("273 µs");
    expect(si(0, "N")).toBe("0 N");
    expect(si(-0.004, "J")).toBe("−4 mJ");
    expect(si(Infinity, "s")).toBe("∞ s");
    expect(length(0.05)).toBe("5 cm");
    expect(length(0.002)).toBe("2 mm");
    expect(percent(-0.021)).toBe("−2.1 %");
    expect(quantity(0.5, "")).toBe("50 %");
  });

  it("are rounded up to nice ones", () => {
    for (const [value, nice] of [[0.9, 1], [1, 1], [1.01, 2], [3, 5], [7, 10], [0.0012, 0.002]]) {
      expect(niceAbove(value)).toBeCloseTo(nice, 12);
    }
    expect(niceAbove(0)).toBeGreaterThan(0);
  });
});

describe("colour maps", () => {
  const light = (map: ColorMap, i: number) =>
    0.2126 * map.linear[3 * i] + 0.7152 * map.linear[3 * i + 1] + 0.0722 * map.linear[3 * i + 2];

  it("grow lighter all the way, so that no colour vision is needed", () => {
    for (let i = 1; i < ColorMap.size; ++i) expect(light(sequential, i)).toBeGreaterThan(light(sequential, i - 1));
  });
  it("of both signs are lightest in the middle", () => {
    const middle = ColorMap.size / 2;
    for (let i = 8; i < middle; i += 8) {
      expect(light(diverging, i)).toBeGreaterThan(light(diverging, i - 8));
      expect(light(diverging, ColorMap.size - 1 - i)).toBeGreaterThan(light(diverging, ColorMap.size + 7 - i));
    }
  });
  it("take any share", () => {
    for (const share of [-1, 0, 0.3, 1, 7, NaN, Infinity]) {
      const i = ColorMap.index(share);
      expect(i >= 0 && i < ColorMap.size).toBe(true);
    }
  });
});

describe("the range of the colour bar", () => {
  it("grows at once and shrinks only when values stay low", () => {
    const range = new Range();
    range.take(Float32Array.of(0.3, -0.9), 1e-6, 0);
    expect(range.top).toBeCloseTo(1);
    range.take(Float32Array.of(0.1), 1e-6, 10);
    range.take(Float32Array.of(0.1), 1e-6, 1000);
    expect(range.top).toBeCloseTo(1);
    range.take(Float32Array.of(0.1), 1e-6, 3000);
    expect(range.top).toBeCloseTo(0.1);
    range.take(Float32Array.of(NaN), 1e-6, 3001);
    expect(range.top).toBeCloseTo(0.1);
  });
  it("is not stretched by a stray value, but says that there is one", () => {
    const values = new Float32Array(1000).map((_, i) => 0.04 * Math.sin(i));
    values[7] = -5;
    const range = new Range();
    range.take(values, 1e-6, 0);
    expect(range.top).toBeCloseTo(0.1);
    expect([range.above, range.below]).toEqual([false, true]);
    values[7] = 0;
    range.take(values, 1e-6, 5000);
    expect(range.below).toBe(false);
  });
});

describe("corners", () => {
  // Two triangles that share an edge, folded by an angle.
  const fold = (angle: number) =>
    splitCorners(Uint32Array.of(0, 1, 2, 1, 0, 3),
      Float32Array.of(0, 0, 0, 1, 0, 0, 0, 1, 0, 0, -Math.cos(angle), -Math.sin(angle)), Math.PI / 3);

  it("are shared where the surface is round", () => {
    expect(fold(0.3).node.length).toBe(4);
  });
  it("are split where it has an edge", () => {
    const { node, index } = fold(1.5);
    expect(node.length).toBe(6);
    expect([...index].map((v) => node[v])).toEqual([0, 1, 2, 1, 0, 3]);
  });
});
