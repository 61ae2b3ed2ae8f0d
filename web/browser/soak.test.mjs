// Twenty seconds of what ./dev test soak does for ten minutes.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { soak } from "./soak.mjs";
import { launch } from "./support.mjs";

let browser;
before(async () => {
  browser = await launch();
});
after(() => browser?.close());

test("random use breaks nothing", { timeout: 600_000 }, async () => {
  const { samples } = await soak(browser, { seconds: 20, every: 5, seed: 7, scenes: ["beam", "pull", "press"] });
  assert.ok(samples.length > 0);
});
