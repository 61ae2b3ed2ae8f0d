// What is around the scene: plots, downloads, gallery, files that are dropped.
import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { launch, picture, root, serve, state, until, visit } from "./support.mjs";

let browser, server;
before(async () => {
  browser = await launch();
  server = await serve("scenes/beam.toml");
});
after(async () => {
  await browser?.close();
  await server?.stop();
});

const SIZE = { width: 1280, height: 720 };
const text = (page, selector) => page.evaluate((s) => document.querySelector(s)?.textContent ?? "", selector);
const run = async (page, seconds) => {
  if (!(await state(page, "status")).running) await page.keyboard.press("Space");
  const from = await state(page, "time");
  await until(page, (t) => window.sinew.state.time > t, from + seconds);
};
const pause = async (page) => {
  if ((await state(page, "status")).running) await page.keyboard.press("Space");
  await until(page, () => !window.sinew.state.status.running);
};
const reset = async (page) => {
  await pause(page);
  await page.keyboard.press("r");
  await until(page, () => window.sinew.state.status.time === 0 && window.sinew.state.time === 0);
};
const saved = async (page, id) => {
  await page.keyboard.press("e");
  const [download] = await Promise.all([page.waitForEvent("download"), page.locator(`#save-${id}`).click()]);
  return { name: download.suggestedFilename(), bytes: await readFile(await download.path()) };
};
/** Drops files, given as [name, content], on the page. */
const drop = (page, files) =>
  page.evaluate((list) => {
    const data = new DataTransfer();
    for (const [name, content] of list) data.items.add(new File([content], name));
    for (const type of ["dragenter", "dragover", "drop"]) {
      document.body.dispatchEvent(new DragEvent(type, { dataTransfer: data, bubbles: true, cancelable: true }));
    }
  }, files);
const complaint = (page, pattern) =>
  until(page, (source) => {
    const e = document.querySelector("#alert");
    return e.classList.contains("on") && new RegExp(source).test(e.textContent);
  }, pattern.source);

test("plots follow the simulation, can be read and zoomed, and start anew", () =>
  visit(browser, server.url, SIZE, async (page) => {
    await reset(page);
    await page.keyboard.press("d");
    await run(page, 0.6);
    await until(page, () => window.sinew.state.samples > 5);
    const lines = await page.locator(".plot-legend button").allTextContents();
    assert.equal(lines.length, 7);
    for (const line of lines) assert.match(line, / [nµmkM]?J$/, line);
    const pixels = () => page.evaluate(() => {
      const canvas = document.querySelector("#plots canvas");
      const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
      let bright = 0;
      for (let i = 0; i < data.length; i += 4) if (data[i + 3] > 200 && Math.max(data[i], data[i + 1], data[i + 2]) > 140) ++bright;
      return bright;
    });
    assert.ok((await pixels()) > 500, "nothing is drawn");

    await page.getByRole("tab", { name: "Displacement" }).click();
    assert.match(await text(page, ".plot-legend button"), /^tip.* [mµn]?m$/);
    await run(page, 0.3);
    await picture(page, "plots");
    const all = page.getByRole("button", { name: "All", exact: true });
    const box = await page.locator("#plots .u-over").boundingBox();
    const y = box.y + 0.5 * box.height;
    await page.mouse.move(box.x + 0.2 * box.width, y);
    await page.mouse.down();
    await page.mouse.move(box.x + 0.6 * box.width, y, { steps: 4 });
    await page.mouse.up();
    await until(page, () => !document.querySelector("#plots .bar .text").hidden);
    await page.mouse.move(box.x + 0.3 * box.width, y);
    await until(page, () => {
      const [, at] = /at ([\d.]+) s/.exec(document.querySelector("#plots .when").textContent);
      return Number(at) < window.sinew.state.status.time - 0.05;
    });
    assert.ok(await all.isVisible(), "the zoom is lost while it runs");
    await all.click();
    assert.equal(await all.isVisible(), false);

    await page.locator("#plots .area").focus();
    await page.keyboard.press("+");
    assert.ok(await all.isVisible());
    await page.keyboard.press("0");
    await page.locator(".plot-legend button").first().click();
    assert.equal(await page.locator(".plot-legend button").first().getAttribute("aria-pressed"), "false");
    await page.locator(".plot-legend button").first().click();

    await page.locator("#view").focus(); // the space bar presses the button that has the focus
    await reset(page);
    await until(page, () => window.sinew.state.samples === 1);
    await page.keyboard.press("d");
    assert.equal(await page.locator("#plots").isVisible(), false);
  }));

test("picture, data, scene and state are saved from one menu", () =>
  visit(browser, server.url, { ...SIZE, acceptDownloads: true }, async (page) => {
    await reset(page);
    await run(page, 0.3);
    await pause(page);
    const png = await saved(page, "picture");
    assert.equal(png.name, "beam.png");
    assert.equal(png.bytes.subarray(1, 4).toString(), "PNG");
    assert.ok(png.bytes.length > 5000);
    const csv = await saved(page, "data");
    assert.equal(csv.name, "beam.csv");
    const rows = csv.bytes.toString().trim().split("\n");
    assert.match(rows[0], /^time \[s\],Kinetic \[J\],.*Total \[J\],displacement of tip \[m\],Change of volume \[%\]/);
    assert.equal(rows.length, (await state(page, "samples")) + 1);
    assert.equal(rows.at(-1).split(",").length, rows[0].split(",").length);
    assert.match((await saved(page, "scene")).bytes.toString(), /\[body\.beam\]/);
    const vtu = await saved(page, "state");
    assert.equal(vtu.name, "beam.vtu");
    assert.match(vtu.bytes.toString("latin1"), /UnstructuredGrid[^]*displacement/);
    await page.keyboard.press("e");
    await picture(page, "save");
    await page.keyboard.press("Escape");
    assert.equal(await page.locator("#save-menu").isVisible(), false);
  }));

test("a video is recorded, of a simulation that stands still too", () =>
  visit(browser, server.url, { width: 480, height: 320, acceptDownloads: true }, async (page) => {
    await reset(page);
    await page.keyboard.press("e");
    await page.locator("#save-video").click();
    const stop = page.getByRole("button", { name: /Stop the video, 0:0[1-9]/ });
    await stop.waitFor({ timeout: 60_000 });
    const [download] = await Promise.all([page.waitForEvent("download", { timeout: 60_000 }), page.locator("#recording").click()]);
    assert.match(download.suggestedFilename(), /^beam\.webm$/);
    const bytes = await readFile(await download.path());
    assert.equal(bytes.subarray(0, 4).toString("hex"), "1a45dfa3");
    assert.ok(bytes.length > 5000, `${bytes.length} bytes`);
    assert.equal(await page.locator("#recording").isVisible(), false);
  }));

test("a scene of the gallery is opened, by who has the controls", () =>
  visit(browser, server.url, SIZE, async (page) => {
    await page.keyboard.press("o");
    await until(page, () => document.querySelectorAll(".scene").length > 8);
    await picture(page, "gallery");
    const { opened } = await state(page, "scene");
    assert.equal(await page.locator(".scene[aria-current=true]").getAttribute("data-name"), "beam");
    await visit(browser, server.url, { width: 800, height: 600 }, async (second) => {
      await second.getByRole("button", { name: "Scenes" }).click();
      await until(second, () => document.querySelectorAll(".scene").length > 8);
      assert.ok(await second.locator(".scene").first().isDisabled());
      assert.match(await text(second, ".watching-note"), /has the controls/);
    });
    await page.locator(".scene[data-name=twist]").click();
    await until(page, (n) => window.sinew.state.scene.opened > n && window.sinew.state.scene.name === "twist", opened);
    await until(page, () => document.querySelector("#opening").hidden && window.sinew.state.samples === 1);
    assert.match(await page.title(), /twist/i);
  }));

test("the scene before runs on while another is opened, and the opening can be cancelled", () =>
  visit(browser, server.url, SIZE, async (page) => {
    const { opened } = await state(page, "scene");
    await run(page, 0.1);
    const scene = "[body.block]\nshape = \"box\"\nsize = [0.1, 0.1, 0.1]\ncells = [70, 70, 70]\n[pin.top]\nselect = { side = \"+y\" }\n";
    await drop(page, [["large block.toml", scene]]);
    await page.waitForSelector("#cancel-opening:visible");
    const time = await page.evaluate(() => window.sinew.state.time);
    await until(page, (t) => window.sinew.state.time > t, time);
    await picture(page, "opening");
    await page.click("#cancel-opening");
    await until(page, () => document.querySelector("#opening").hidden);
    await complaint(page, /the opening was cancelled/);
    assert.equal((await state(page, "scene")).opened, opened);
    await pause(page);
  }));

test("dropped files are opened, or it is said why not", () =>
  visit(browser, server.url, SIZE, async (page) => {
    const { opened } = await state(page, "scene");
    const node = "4 3 0 0\n1 0 0 0\n2 0.1 0 0\n3 0 0.1 0\n4 0 0 0.1\n";
    const ele = "1 4 0\n1 1 2 3 4\n";
    await drop(page, [["one tet.node", node], ["one tet.ele", ele]]);
    await until(page, (n) => window.sinew.state.scene.opened > n, opened);
    assert.equal(await state(page, "scene").then((s) => s.tets), 1);

    const scene = await readFile(join(root, "scenes/beam.toml"), "utf8");
    await drop(page, [["mine.toml", scene.replace(/^title = .*$/m, 'title = "A beam of mine"')]]);
    await until(page, () => window.sinew.state.scene.title === "A beam of mine");

    await drop(page, [["photo.jpg", "x"]]);
    await complaint(page, /photo\.jpg: not a scene/);
    await drop(page, [["broken.mesh", "MeshVersionFormatted 2\nDimension 3\nVertices\nmany\n"]]);
    await complaint(page, /broken\.mesh/);
    await drop(page, [["lost.toml", '[body.a]\nmesh = "nowhere.mesh"\nyoung = 1e4\n']]);
    await complaint(page, /nowhere\.mesh/);
    await picture(page, "refused");
    assert.equal(await state(page, "scene").then((s) => s.title), "A beam of mine");
    await page.getByRole("button", { name: "Close the message" }).click();
    await until(page, () => !document.querySelector("#alert").classList.contains("on"));
  }));

test("without a scene the page begins with the gallery; all of it is of use on a phone", async () => {
  const bare = await serve(null);
  try {
    await visit(browser, bare.url, { width: 390, height: 780, hasTouch: true, isMobile: true }, async (page) => {
      await until(page, () => document.querySelector("#gallery").open && document.querySelectorAll(".scene").length > 8);
      await picture(page, "gallery-phone");
      await page.locator(".scene[data-name=pull]").tap();
      await until(page, () => window.sinew.state.scene.name === "pull" && document.querySelector("#opening").hidden);
      await page.getByRole("button", { name: "Plots" }).tap();
      await page.getByRole("button", { name: "Run" }).tap();
      await until(page, () => window.sinew.state.samples > 5);
      await picture(page, "plots-phone");
      assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth));
      await page.getByRole("button", { name: "Save" }).tap();
      assert.ok(await page.getByRole("menuitem", { name: /Picture/ }).isVisible());
    });
  } finally {
    assert.equal(await bare.stop(), 0);
  }
});
