import { describe, expect, it } from "vitest";
import { columnsOf, History, toCsv } from "../src/history";
import type { SceneInfo, Status } from "../src/protocol";

const scene = (opened = 1) =>
  ({ opened, name: "beam", probes: ['tip, "left"'], obstacles: [{ name: "plate", radius: 0.1 }] }) as SceneInfo;
const status = (time: number, kinetic = 0) =>
  ({
    time,
    energy: { kinetic, elastic: 2, gravity: -3, contact: 0, dissipated: 0.5, work_in: 1 },
    volume_ratio: 0.99,
    hands: [],
    probes: [[0.003, 0, 0.004]],
    obstacles: [{ center: [0, 0, 0], force: [0, -2, 0], contacts: 3 }],
    ball: null,
  }) as unknown as Status;
const column = (h: History, title: string) => h.values[h.columns.findIndex((c) => c.title === title)];

describe("the history", () => {
  it("has what a scene shows", () => {
    const h = new History();
    expect(h.begin(scene())).toBe(true);
    h.add(status(0.1, 4));
    expect(column(h, "Total")).toEqual([4 + 2 - 3 + 0.5 - 1]);
    expect(column(h, 'tip, "left"')[0]).toBeCloseTo(0.005);
    expect(column(h, "Change of volume")[0]).toBeCloseTo(-1);
    expect(column(h, "plate")).toEqual([2]);
    expect(column(h, "Ball in hand")).toEqual([null]);
    expect(new Set(columnsOf(scene()).map((c) => c.group))).toEqual(new Set(["energy", "displacement", "volume", "force"]));
  });

  it("keeps one sample of a time that stands still", () => {
    const h = new History();
    h.begin(scene());
    for (const kinetic of [1, 2, 3]) h.add(status(0.5, kinetic));
    expect(h.time).toEqual([0.5]);
    expect(column(h, "Kinetic")).toEqual([3]);
  });

  it("starts anew when time goes back, or with another scene", () => {
    const h = new History();
    h.begin(scene());
    h.add(status(1));
    h.add(status(2));
    h.add(status(0));
    expect(h.time).toEqual([0]);
    expect(h.begin(scene())).toBe(false);
    expect(h.begin(scene(2))).toBe(true);
    expect(h.length).toBe(0);
  });

  it("stays bounded, whole, evenly dense and has the newest", () => {
    for (const most of [20, 21]) {
      const h = new History(most);
      h.begin(scene());
      for (let i = 0; i < 1000; ++i) {
        h.add(status(i));
        expect(h.length).toBeLessThanOrEqual(most + 1);
        expect(h.time[0]).toBe(0);
        expect(h.time[h.length - 1]).toBe(i);
        expect(h.values.every((v) => v.length === h.length)).toBe(true);
      }
      const gaps = h.time.slice(1, -1).map((t, i) => t - h.time[i]);
      expect(new Set(gaps)).toEqual(new Set([64]));
    }
  });
});

describe("the table", () => {
  it("names columns with units, quotes what has to be, and leaves out what was not there", () => {
    const h = new History();
    h.begin(scene());
    h.add(status(0.25));
    const [head, row, end] = toCsv(h).split("\n");
    expect(head).toMatch(/^time \[s\],Kinetic \[J\],/);
    expect(head).toContain(',"displacement of tip, ""left"" [m]",');
    expect(head).toContain(",Change of volume [%],");
    expect(head).toMatch(/,force: Ball in hand \[N\],force: plate \[N\]$/);
    expect(row).toMatch(/^0\.25,0,2,-3,/);
    expect(row).toMatch(/,,,,2$/);
    expect(end).toBe("");
  });
});
