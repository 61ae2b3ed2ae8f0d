// The page in a real browser, with a real simulation behind it.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { launch, nodeInFront, picture, serve, state, until, visit } from "./support.mjs";

let browser, server;
before(async () => {
  browser = await launch();
  server = await serve("scenes/liver.toml");
});
after(async () => {
  await browser?.close();
  await server?.stop();
});

const running = (page, is) => until(page, (want) => window.sinew.state.status.running === want, is);
const paused = async (page) => {
  if ((await state(page, "status")).running) await page.keyboard.press("Space");
  await running(page, false);
};
const reset = async (page) => {
  await paused(page);
  await page.keyboard.press("r");
  await until(page, () => window.sinew.state.status.time === 0 && window.sinew.state.time === 0);
};

test("loads, runs, pauses and steps by key", () =>
  visit(browser, server.url, { width: 1280, height: 720 }, async (page) => {
    assert.match(await page.title(), /liver/i);
    assert.equal(await state(page, "controls"), true);
    await picture(page, "liver");
    await page.keyboard.press("Space");
    await until(page, () => window.sinew.state.time > 0.3);
    await page.keyboard.press("Space");
    await running(page, false);
    const before = (await state(page, "status")).step;
    await page.keyboard.press("s");
    await until(page, (n) => window.sinew.state.status.step === n, before + 1);
    const time = await state(page, "time");
    await page.keyboard.press("Shift+S");
    await until(page, (t) => window.sinew.state.time > t + 0.001, time);
    await page.keyboard.press("r");
    await until(page, () => window.sinew.state.time === 0);
  }));

test("every colouring has its bar in physical units", () =>
  visit(browser, server.url, { width: 1280, height: 720 }, async (page) => {
    await page.keyboard.press("Space");
    await until(page, () => window.sinew.state.time > 0.4);
    await paused(page);
    for (const [name, unit] of [["displacement", / (c|m)m$/], ["stretch", / %$/], ["volume", / %$/], ["stress", / k?Pa$/], ["speed", /m\/s$/]]) {
      await page.selectOption("#coloring", name);
      await until(page, (n) => {
        const { scene } = window.sinew.state;
        const title = scene.quantities.find((q) => q.name === n).title;
        return document.querySelector("#colorbar .title")?.textContent === title;
      }, name);
      await until(page, (source) => new RegExp(source).test(document.querySelector("#colorbar .ticks span")?.textContent ?? ""), unit.source);
    }
    await page.selectOption("#coloring", "region");
    await until(page, () => document.querySelectorAll("#colorbar .entry").length === 3);
    await page.selectOption("#coloring", "stress");
    await page.keyboard.press("w");
    await page.waitForTimeout(1000);
    await picture(page, "stress");
    await reset(page);
  }));

test("orbits beside the tissue, and not on it", () =>
  visit(browser, server.url, {}, async (page) => {
    const start = await state(page, "camera");
    await page.mouse.move(120, 330);
    await page.mouse.down();
    await page.mouse.move(240, 350, { steps: 6 });
    await page.mouse.up();
    await until(page, (from) => Math.hypot(...window.sinew.state.camera.map((c, i) => c - from[i])) > 0.05, start);
    await page.mouse.wheel(0, -400);
    await page.keyboard.press("f");
    await until(page, (from) => Math.hypot(...window.sinew.state.camera.map((c, i) => c - from[i])) < 0.02, start);
  }));

test("the liver follows the hand, and springs back", () =>
  visit(browser, server.url, { width: 1280, height: 720 }, async (page) => {
    await reset(page);
    await page.keyboard.press("Space");
    await until(page, () => window.sinew.state.time > 1.5);
    const { node, at } = await nodeInFront(page);
    const y = () => page.evaluate((n) => window.sinew.state.positions[3 * n + 1], node);
    const rest = await y();
    const camera = await state(page, "camera");
    await page.mouse.move(...at);
    await page.mouse.down();
    await until(page, () => window.sinew.state.pulling);
    await page.mouse.move(at[0], at[1] - 150, { steps: 8 });
    await until(page, ([n, from]) => window.sinew.state.positions[3 * n + 1] > from + 0.02, [node, rest]);
    await until(page, () => / m?N$/.test(document.querySelector(".force")?.textContent ?? ""));
    await picture(page, "pull");
    assert.deepEqual(await state(page, "camera"), camera);
    await page.mouse.up();
    await until(page, () => window.sinew.state.status.hands.length === 0);
    await until(page, ([n, to]) => Math.abs(window.sinew.state.positions[3 * n + 1] - to) < 0.012, [node, rest]);
  }));

test("pins stay when the pointer goes, and let go again", () =>
  visit(browser, server.url, {}, async (page) => {
    await reset(page);
    const { at } = await nodeInFront(page);
    await page.mouse.move(...at);
    await page.keyboard.down("Shift");
    await page.mouse.click(...at);
    await page.keyboard.up("Shift");
    await until(page, () => window.sinew.state.status.hands.length === 1);
    assert.equal(await state(page, "pins"), 1);
    await page.keyboard.press("Escape");
    await until(page, () => window.sinew.state.status.hands.length === 0);
  }));

test("Young's modulus goes to 1 GPa and back while it runs", () =>
  visit(browser, server.url, { width: 1280, height: 720 }, async (page) => {
    await reset(page);
    await page.keyboard.press("Space");
    const slider = page.getByLabel("Young’s modulus");
    const drive = async (key, young) => {
      await slider.focus();
      await page.keyboard.press(key);
      await until(page, (e) => window.sinew.state.scene.parts.every((p) => Math.abs(p.young / e - 1) < 0.01), young);
    };
    await drive("End", 1e9);
    await until(page, () => window.sinew.state.status.stepper === "implicit"); // keeps pace
    await picture(page, "gigapascal");
    const extent = () => page.evaluate(() => Math.max(...window.sinew.state.positions.map(Math.abs)));
    assert.ok((await extent()) < 0.5);
    await drive("Home", 1e3);
    const from = await state(page, "time");
    await until(page, (t) => window.sinew.state.time > t + 0.01, from);
    assert.ok((await extent()) < 2);
    assert.equal((await state(page, "status")).error, "");
    await slider.evaluate((e) => { e.value = "100"; e.dispatchEvent(new Event("input")); });
    await until(page, () => Math.abs(window.sinew.state.scene.parts[0].young / 1e4 - 1) < 0.01);
    await reset(page);
  }));

test("limits on springs come and go while it runs", () =>
  visit(browser, server.url, {}, async (page) => {
    await reset(page);
    const limit = (value) => until(page, (l) => window.sinew.state.scene.parts.every((p) => p.stretch_limit === l), value);
    await page.getByLabel("Stretch of springs").selectOption("0.1");
    await limit(0.1);
    await page.keyboard.press("Escape");
    await page.locator("#view").focus();
    await page.keyboard.press("Space");
    await until(page, () => window.sinew.state.time > 0.1);
    await paused(page);
    assert.ok((await state(page, "status")).max_stretch < 0.12);
    await page.getByLabel("Stretch of springs").selectOption("inf");
    await limit(null);
    await reset(page);
  }));

test("two may watch, one has the controls, the other may take them", async () => {
  await visit(browser, server.url, { width: 480, height: 320 }, async (first) => {
    await visit(browser, server.url, { width: 480, height: 320 }, async (second) => {
      assert.equal(await state(first, "controls"), true);
      await until(second, () => !window.sinew.state.controls && !document.querySelector("#take-control").hidden);
      assert.equal(await second.getByLabel("Young’s modulus").isDisabled(), true);
      await first.keyboard.press("Space");
      await until(second, () => window.sinew.state.status.running);
      await second.getByRole("button", { name: "Take the controls" }).click();
      await until(first, () => !window.sinew.state.controls);
      await until(second, () => window.sinew.state.controls);
      await second.keyboard.press("Space");
      await running(first, false);
    });
    await until(first, () => window.sinew.state.controls);
  });
});

test("keyboard and screen readers reach everything; the help names the keys", () =>
  visit(browser, server.url, { width: 1280, height: 720 }, async (page) => {
    const nameless = await page.evaluate(() =>
      [...document.querySelectorAll("button, input, select")]
        .filter((e) => !(e.getAttribute("aria-label") || e.labels?.length || e.textContent.trim()))
        .map((e) => e.outerHTML));
    assert.deepEqual(nameless, []);
    await page.keyboard.press("h");
    await until(page, () => document.querySelector("#help").open);
    await picture(page, "help");
    await page.keyboard.press("Escape");
    await until(page, () => !document.querySelector("#help").open);
    const reached = new Set();
    for (let i = 0; i < 60; ++i) {
      await page.keyboard.press("Tab");
      reached.add(await page.evaluate(() => document.activeElement.getAttribute("aria-label") ?? document.activeElement.id));
    }
    for (const name of ["Run", "One step", "Back to the start", "Pull", "Panel", "Colour by"]) {
      assert.ok(reached.has(name), `${name} is not reached: ${[...reached]}`);
    }
  }));

test("is of use on a phone", () =>
  visit(browser, server.url, { width: 390, height: 780, hasTouch: true, isMobile: true }, async (page) => {
    assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth));
    await picture(page, "phone");
    await page.getByRole("button", { name: "Run" }).tap();
    await running(page, true);
    await page.getByRole("button", { name: "Panel" }).tap();
    assert.ok(await page.getByLabel("Young’s modulus").isVisible());
    await page.getByRole("button", { name: "Pause" }).tap();
    await running(page, false);
  }));
