import * as THREE from "three";
import { describe, expect, it } from "vitest";
import { distanceInWords, titlesOf } from "../src/compare";
import type { SceneInfo } from "../src/protocol";
import { Track } from "../src/track";

describe("something that moves", () => {
  const at = new THREE.Vector3();

  it("is where it was reported at first, and goes on between reports", () => {
    const track = new Track();
    expect(track.known).toBe(false);
    track.hear([0, 0, 0], 0);
    track.follow(at, 0, 0, 1);
    track.hear([0.1, 0, 0], 0.1);
    for (let now = 0; now <= 1000; now += 16) track.follow(at, 0.15, now, 1);
    expect(at.x).toBeCloseTo(0.15, 3);
    // Not on and on when no report comes.
    for (let now = 1000; now <= 2000; now += 16) track.follow(at, 9, now, 1);
    expect(at.x).toBeLessThan(0.23);
  });

  it("is put where it is when time goes back, and rests while it stands still", () => {
    const track = new Track();
    track.hear([0, 0, 0], 1);
    track.hear([0.1, 0, 0], 1.1);
    track.follow(at, 1.1, 0, 1);
    track.hear([0, 0, 0], 0);
    expect(track.follow(at, 0, 16, 1)).toBe(true);
    expect(at.x).toBe(0);
    expect(track.follow(at, 0, 32, 1)).toBe(false);
  });
});

describe("a comparison", () => {
  const scene = {
    compare: "lloyd",
    laws: [{ name: "neo-hookean", title: "Neo-Hookean" }, { name: "lloyd", title: "Lloyd" }],
    parts: [{ law: "neo-hookean" }, { law: "neo-hookean" }],
  } as unknown as SceneInfo;

  it("says how far the bodies are apart", () => {
    expect(distanceInWords({ largest: 0.0031, mean: 0.0008 })).toBe("Largest distance 3.1\u00a0mm, mean 0.8\u00a0mm");
    expect(distanceInWords({ largest: 1e-17, mean: 1e-18 })).toBe("Both are in the same place");
  });
  it("names both laws", () => {
    expect(titlesOf(scene)).toEqual(["Neo-Hookean", "Lloyd"]);
    expect(titlesOf({ ...scene, compare: "" })).toBeNull();
    const mixed = { ...scene, parts: [{ law: "lloyd" }, { law: "neo-hookean" }] } as unknown as SceneInfo;
    expect(titlesOf(mixed)?.[0]).toBe("As the scene says");
  });
});
