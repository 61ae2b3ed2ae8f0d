// What the page does when the server goes and comes; how fast frames and hands are.
import assert from "node:assert/strict";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, relative } from "node:path";
import { after, before, test } from "node:test";
import { launch, pictures, root, serve, state, until, visit } from "./support.mjs";

let browser;
before(async () => {
  browser = await launch();
});
after(() => browser?.close());

test("comes back by itself after the server was gone", async () => {
  let server = await serve("scenes/beam.toml");
  try {
    await visit(browser, server.url, {}, async (page, faults) => {
      assert.equal(await server.stop(), 0);
      await until(page, () => !document.querySelector("#lost").hidden);
      server = await serve("scenes/beam.toml", { port: server.port });
      await until(page, () => document.querySelector("#lost").hidden && window.sinew.state.controls);
      await page.keyboard.press("Space");
      await until(page, () => window.sinew.state.time > 0.05);
      faults.length = 0; // the browser itself complains of a server that is not there
    });
  } finally {
    assert.equal(await server.stop(), 0);
  }
});

test("other machines need the token", async () => {
  const server = await serve("scenes/beam.toml", { host: "0.0.0.0" });
  try {
    assert.match(server.url, /\?token=[0-9a-f]{32}$/);
    await visit(browser, server.url, {}, async (page) => {
      assert.equal(await state(page, "controls"), true);
      const without = await page.request.get(new URL("/", server.url).href);
      assert.equal(without.status(), 403);
    });
  } finally {
    await server.stop();
  }
});

test("a step that takes long is said, and can be cancelled", { timeout: 180_000 }, async () => {
  const folder = mkdtempSync(join(tmpdir(), "sinew-busy-"));
  const scene = join(folder, "block.toml");
  writeFileSync(scene, `stepper = "implicit"
tolerance = 1e-9
[body.block]
shape = "box"
size = [0.1, 0.1, 0.1]
cells = [28, 28, 28]
young = 1e4
poisson = 0.4995
[pin.top]
select = { side = "+y" }
`);
  const server = await serve(relative(root, scene));
  after(() => server.stop());
  await visit(browser, server.url, {}, async (page) => {
    await until(page, () => window.sinew.state.controls);
    await page.keyboard.press("Space");
    await page.waitForSelector("#busy:not([hidden])", { timeout: 60_000 });
    await page.screenshot({ path: join(pictures, "busy.png") });
    assert.match(await page.textContent("#busy"), /A step has taken \d+ s so far/);
    await page.click("#cancel-step");
    await until(page, () => window.sinew.state.status.running === false);
    await until(page, () => document.querySelector("#busy").hidden);
    assert.match(await page.textContent("#alert"), /cancelled/);
  });
  await server.stop();
  rmSync(folder, { recursive: true });
});

// Without drawing: a bare page of the same origin that only counts.
test("frames stream at the display's rate, hands act at once", { timeout: 180_000 }, async () => {
  for (const scene of ["scenes/liver.toml", "scenes/liver-fine.toml"]) {
    const server = await serve(scene);
    after(() => server.stop()); // also of a test that has failed
    const context = await browser.newContext();
    const page = await context.newPage();
    await page.goto(new URL("/scene.toml", server.url).href);
    const measured = await page.evaluate(async () => {
      const socket = new WebSocket(`ws://${location.host}/live`);
      socket.binaryType = "arraybuffer";
      const say = (m) => socket.send(JSON.stringify(m));
      let rest, status, frames = 0, bytes = 0, onFrame = () => {};
      const ready = new Promise((done) => {
        socket.onmessage = ({ data }) => {
          if (typeof data === "string") {
            const m = JSON.parse(data);
            if (m.type === "status") status = m;
            return;
          }
          const head = new DataView(data);
          const nodes = head.getUint32(12, true);
          if (head.getUint16(6, true) === 1) {
            rest = new Float32Array(data.slice(40 + 12 * head.getUint32(32, true)), 0, 3 * nodes);
            return;
          }
          say({ type: "seen", frame: Number(head.getBigUint64(16, true)) });
          ++frames;
          bytes += data.byteLength;
          onFrame(new Float32Array(data, 40, 3 * nodes), head.getFloat64(24, true));
          done();
        };
      });
      await ready;
      say({ type: "play" });
      await new Promise((done) => setTimeout(done, 1500));
      frames = bytes = 0;
      const start = performance.now();
      await new Promise((done) => setTimeout(done, 4000));
      const seconds = (performance.now() - start) / 1000;
      const result = { fps: frames / seconds, MBps: bytes / seconds / 1e6, rate: status.rate, stepper: status.stepper };
      // From a jump of the hand to the first frame in which the node has moved more than it did.
      let node = 2; // the z of the node furthest to the front
      for (let i = 2; i < rest.length; i += 3) if (rest[i] > rest[node]) node = i;
      const n = (node - 2) / 3;
      const waits = [];
      for (let i = 0; i < 8; ++i) {
        let last, speed = 0;
        await new Promise((done) => {
          onFrame = (x) => { if (last) { speed = Math.abs(x[node] - last); done(); } last = x[node]; };
          setTimeout(done, 3000);
        });
        last ??= rest[node];
        const point = [rest[node - 2], rest[node - 1], last];
        say({ type: "grab", hand: 0, node: n, point });
        const from = performance.now();
        say({ type: "drag", hand: 0, point: [point[0], point[1], point[2] + 0.05] });
        await new Promise((done) => {
          onFrame = (x) => {
            if (x[node] - last > speed + 2e-5) done();
            speed = Math.max(speed, Math.abs(x[node] - last));
            last = x[node];
          };
          setTimeout(done, 3000);
        });
        waits.push(performance.now() - from);
        say({ type: "release", hand: 0 });
        if (!status.running) say({ type: "play" });
        await new Promise((done) => setTimeout(done, 400));
      }
      socket.close();
      waits.sort((a, b) => a - b);
      return { ...result, latency_ms: waits[waits.length >> 1] };
    });
    console.log(`${scene}: ${measured.fps.toFixed(1)} frames a second, ${measured.MBps.toFixed(1)} MB/s, ` +
      `${measured.rate.toFixed(2)}x real time (${measured.stepper}), ${measured.latency_ms.toFixed(0)} ms from the hand to the moved frame`);
    assert.ok(measured.fps > 0);
    await context.close();
    await server.stop();
  }
});
