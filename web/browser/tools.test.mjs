// What is in the scene: ball, obstacles, contacts, springs, cut, comparison of laws.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { launch, nodeInFront, picture, serve, state, until, visit } from "./support.mjs";

let browser, press, liver;
before(async () => {
  browser = await launch();
  press = await serve("scenes/press.toml");
  liver = await serve("scenes/liver.toml");
});
after(async () => {
  await browser?.close();
  await press?.stop();
  await liver?.stop();
});

const run = async (page, on) => {
  if ((await state(page, "status")).running !== on) await page.keyboard.press("Space");
  await until(page, (want) => window.sinew.state.status.running === want, on);
};
const reset = async (page) => {
  await run(page, false);
  await page.keyboard.press("r");
  await until(page, () => window.sinew.state.status.time === 0 && window.sinew.state.time === 0);
};
/** Runs until the liver no longer swings away from under the pointer. */
const settled = async (page) => {
  await run(page, true);
  await until(page, () => window.sinew.state.time > 1.5, null, 120);
};
const nodes = (page) => page.evaluate(() => window.sinew.state.rest.length / 3);
const ballTool = async (page) => {
  await page.getByRole("button", { name: "Push with a ball" }).click();
  await until(page, () => !document.querySelector("#ball-card").hidden);
};

test("the ball goes in while it is held, is shown where it is, and goes away", () =>
  visit(browser, liver.url, { width: 1280, height: 720 }, async (page) => {
    await reset(page);
    await settled(page);
    await ballTool(page);
    const camera = await state(page, "camera");
    const { at } = await nodeInFront(page);
    await page.mouse.move(...at);
    await page.mouse.down();
    await until(page, () => window.sinew.state.status.ball?.contacts > 0);
    await until(page, () => /N$/.test([...document.querySelectorAll(".force")].map((e) => e.textContent).join("")));
    await page.keyboard.press("k");
    await until(page, () => window.sinew.state.contacts > 0);
    const depth = page.getByLabel("Depth", { exact: true });
    const before = Number(await depth.inputValue());
    await page.keyboard.press("]");
    await page.mouse.wheel(0, -100);
    await until(page, (d) => Number(document.querySelectorAll("#ball-card input")[1].value) > d + 0.15, before);
    await page.mouse.move(at[0] + 30, at[1], { steps: 4 });
    await until(page, () => {
      const { ball, status } = window.sinew.state;
      return ball && status.ball && Math.hypot(...ball.map((c, i) => c - status.ball.center[i])) < 0.2 * status.ball.radius;
    });
    await picture(page, "ball");
    assert.deepEqual(await state(page, "camera"), camera);
    await page.mouse.up();
    await until(page, () => window.sinew.state.status.ball === null && window.sinew.state.ball === null);
    await until(page, () => window.sinew.state.contacts === 0);
  }));

test("the ball's radius is set beside the tool; T goes through the tools", () =>
  visit(browser, liver.url, {}, async (page) => {
    await reset(page);
    for (const name of ["Pin", "Push with a ball"]) {
      await page.keyboard.press("t");
      assert.equal(await page.getByRole("button", { name, exact: true }).getAttribute("aria-pressed"), "true");
    }
    const radius = page.getByLabel("Radius");
    await radius.focus();
    await page.keyboard.press("Home");
    await page.waitForTimeout(100); // sliders tell no faster than every 50 ms
    await settled(page);
    const { at } = await nodeInFront(page);
    await page.mouse.move(...at);
    await page.mouse.down();
    await until(page, () => {
      const { status, scene } = window.sinew.state;
      return status.ball && Math.abs(status.ball.radius / (0.02 * scene.diagonal) - 1) < 0.05;
    });
    await page.mouse.up();
    await page.keyboard.press("t");
    assert.equal(await page.locator("#ball-card").isVisible(), false);
  }));

test("obstacles are shown where they are, and the nodes that touch them", () =>
  visit(browser, press.url, { width: 1280, height: 720 }, async (page) => {
    await reset(page);
    await page.keyboard.press("k");
    const apart = () => page.evaluate(() => {
      const { obstacles, status } = window.sinew.state;
      return Math.hypot(...obstacles[0].map((c, i) => c - status.obstacles[0].center[i]));
    });
    await until(page, () => window.sinew.state.obstacles.length === 1);
    assert.ok((await apart()) < 1e-6);
    await page.keyboard.press("Shift+S");
    for (let i = 0; i < 20; ++i) await page.keyboard.press("Shift+S");
    await until(page, () => window.sinew.state.time > 0.25 && window.sinew.state.contacts > 0);
    await until(page, () => {
      const { obstacles, status } = window.sinew.state;
      return Math.hypot(...obstacles[0].map((c, i) => c - status.obstacles[0].center[i])) < 1e-4;
    });
    await picture(page, "obstacle");
  }));

test("springs show all nodes, the camera stays", () =>
  visit(browser, liver.url, { width: 1280, height: 720 }, async (page) => {
    await reset(page);
    const [camera, surface] = [await state(page, "camera"), await nodes(page)];
    await page.keyboard.press("l");
    await until(page, () => window.sinew.state.springs === window.sinew.state.scene.springs);
    assert.equal(await nodes(page), (await state(page, "scene")).nodes);
    assert.deepEqual(await state(page, "camera"), camera);
    await picture(page, "springs");
    await page.keyboard.press("l");
    await until(page, () => window.sinew.state.springs === 0);
    assert.equal(await nodes(page), surface);
  }));

test("a cut follows its slider and its direction; what is held stays held", () =>
  visit(browser, liver.url, { width: 1280, height: 720 }, async (page) => {
    await reset(page);
    await run(page, true);
    const camera = await state(page, "camera");
    const { at } = await nodeInFront(page);
    await page.mouse.move(...at);
    await page.mouse.down();
    await page.mouse.move(at[0], at[1] - 60, { steps: 4 });
    await until(page, () => window.sinew.state.status.hands.length === 1);
    await page.keyboard.press("x");
    // Tets are left out whole. The scene's message comes before that of the cut mesh.
    const isCut = () => {
      const { rest, scene, frame } = window.sinew.state;
      if (scene.cut === null || !(frame > 0)) return false;
      const [x, y, z] = scene.cut.normal;
      let most = -Infinity;
      for (let i = 0; i < rest.length; i += 3) most = Math.max(most, x * rest[i] + y * rest[i + 1] + z * rest[i + 2]);
      return most - scene.cut.offset < 0.02;
    };
    const shownCut = (test) => until(page, ([t, r]) => window.sinew.state.scene.cut && window.sinew.state.revision > r && new Map(Object.entries({
      z: (n) => n[2] === 1, flipped: (n) => n[2] === -1, x: (n) => n[0] === 1, facing: (n) => n.every((c) => Math.abs(c) < 0.99),
    })).get(t)(window.sinew.state.scene.cut.normal), [test, revision]);
    let revision = await state(page, "revision");
    await until(page, isCut);
    assert.equal(await state(page, "pulling"), true);
    assert.equal((await state(page, "status")).hands.length, 1);
    await page.mouse.up();
    await until(page, () => window.sinew.state.status.hands.length === 0);
    await run(page, false);
    revision = -1;
    await shownCut("z");
    await page.getByRole("button", { name: "The other half" }).click();
    await shownCut("flipped");
    await page.selectOption("#cut-axis", "facing");
    await shownCut("facing");
    await page.selectOption("#cut-axis", "x");
    await shownCut("x");
    const offset = (await state(page, "scene")).cut.offset;
    await page.getByLabel("Offset").focus();
    for (let i = 0; i < 2; ++i) await page.keyboard.press("PageUp");
    await until(page, (o) => window.sinew.state.scene.cut.offset > o + 0.01, offset);
    await page.selectOption("#coloring", "stress");
    await picture(page, "cut");
    assert.deepEqual(await state(page, "camera"), camera);
    await page.keyboard.press("x");
    await until(page, () => window.sinew.state.scene.cut === null);
    await page.selectOption("#coloring", "plain");
  }));

test("two laws over and beside each other, and how far they are apart", () =>
  visit(browser, liver.url, { width: 1280, height: 720 }, async (page) => {
    await reset(page);
    await page.selectOption("#coloring", "speed");
    await page.selectOption("#compare-law", "lloyd");
    await until(page, () => window.sinew.state.compared === "over");
    assert.equal(await page.inputValue("#coloring"), "distance");
    await run(page, true);
    await until(page, () => window.sinew.state.status.distance?.largest > 1e-3);
    await until(page, () => /^Largest distance .* mean /.test(document.querySelector("#distance").textContent));
    assert.equal(await page.locator(".law:visible").count(), 2);
    await picture(page, "over");
    const camera = await state(page, "camera");
    await page.getByText("Beside it", { exact: true }).click();
    await until(page, () => window.sinew.state.compared === "beside");
    await until(page, (from) => Math.hypot(...window.sinew.state.camera.map((c, i) => c - from[i])) > 0.05, camera);
    await picture(page, "beside");
    await page.selectOption("#compare-law", "");
    await until(page, () => window.sinew.state.compared === null && window.sinew.state.scene.compare === "");
    assert.equal(await page.inputValue("#coloring"), "speed");
    assert.equal(await page.locator(".law:visible").count(), 0);
  }));

test("who only watches sees it, and cannot change it", () =>
  visit(browser, liver.url, { width: 480, height: 320 }, async (first) => {
    await visit(browser, liver.url, { width: 900, height: 600 }, async (second) => {
      await first.keyboard.press("x");
      await until(second, () => document.querySelector("#show-cut").checked);
      for (const id of ["#show-cut", "#cut-axis", "#show-springs", "#compare-law"]) {
        assert.equal(await second.locator(id).isDisabled(), true, id);
      }
      assert.equal(await second.locator("#show-contacts").isDisabled(), false);
      await first.keyboard.press("x");
      await until(second, () => !document.querySelector("#show-cut").checked);
    });
  }));

test("on a phone the options are a sheet, and the ball follows a finger", () =>
  visit(browser, liver.url, { width: 390, height: 780, hasTouch: true, isMobile: true }, async (page) => {
    await reset(page);
    const options = page.locator("#view-options");
    assert.equal(await options.isVisible(), false);
    await page.getByRole("button", { name: "What is shown" }).tap();
    assert.equal(await options.isVisible(), true);
    await picture(page, "phone-options");
    await page.getByRole("button", { name: "Panel" }).tap();
    assert.equal(await options.isVisible(), false);
    await page.getByRole("button", { name: "Panel" }).tap();
    const inside = await page.evaluate(() => [...document.querySelectorAll("#transport *")].every((e) => {
      const { left, right } = e.getBoundingClientRect();
      return left >= 0 && right <= innerWidth;
    }));
    assert.ok(inside, "the transport leaves the screen");
    await page.getByRole("button", { name: "Run" }).tap();
    await until(page, () => window.sinew.state.status.running);
    await page.getByRole("button", { name: "Push with a ball" }).tap();
    const { at } = await nodeInFront(page);
    const finger = await page.context().newCDPSession(page);
    const touch = (type, ...points) => finger.send("Input.dispatchTouchEvent", { type, touchPoints: points.map(([x, y]) => ({ x, y })) });
    await touch("touchStart", at);
    await until(page, () => window.sinew.state.pushing && window.sinew.state.status.ball);
    await touch("touchMove", [at[0] + 20, at[1]]);
    await until(page, () => window.sinew.state.status.ball?.contacts > 0);
    await picture(page, "phone-ball");
    await touch("touchEnd");
    await until(page, () => window.sinew.state.status.ball === null);
  }));

test("the scalpel cuts along its way, and a cut can be undone and made again", () =>
  visit(browser, liver.url, { width: 1280, height: 720 }, async (page) => {
    await reset(page);
    await page.getByRole("button", { name: "Cut with a scalpel" }).click();
    await until(page, () => !document.querySelector("#scalpel-card").hidden);
    const before = await nodes(page);
    const camera = await state(page, "camera");
    const { at } = await nodeInFront(page);
    await page.mouse.move(at[0] - 40, at[1] - 60);
    await page.mouse.down();
    await until(page, () => window.sinew.state.cutting);
    await page.mouse.move(at[0] + 30, at[1] + 80, { steps: 12 });
    await until(page, () => window.sinew.state.status.cut_area > 1e-4);
    await page.mouse.up();
    await until(page, () => !window.sinew.state.cutting && window.sinew.state.status.can_undo);
    await until(page, (n) => window.sinew.state.rest.length / 3 > n, before);
    assert.deepEqual(await state(page, "camera"), camera); // neither the drag nor the new mesh turned it
    await until(page, () => /cm² cut/.test(document.querySelector("#cut-done").textContent));
    let after = 0; // when the last of the cut has come
    while (after !== (await nodes(page))) {
      after = await nodes(page);
      await page.waitForTimeout(700);
    }
    await picture(page, "scalpel");
    await page.getByRole("button", { name: "Undo the last cut" }).click();
    await until(page, (n) => window.sinew.state.rest.length / 3 === n, before);
    assert.equal((await state(page, "status")).can_undo, false);
    await page.keyboard.press("Shift+Z");
    await until(page, (n) => window.sinew.state.rest.length / 3 === n, after);
    await run(page, true); // and it goes on
    await until(page, () => window.sinew.state.time > 0.3, null, 120);
    await picture(page, "scalpel-open");
    await reset(page);
    await until(page, (n) => window.sinew.state.rest.length / 3 === n, before);
    assert.equal((await state(page, "status")).cut_area, 0);
    await page.keyboard.press("t"); // the next tool: from the start
    await until(page, () => document.querySelector("#scalpel-card").hidden);
  }));
