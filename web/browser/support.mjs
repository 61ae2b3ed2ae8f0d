// A sinew view and a headless Chromium for the tests of the page.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { existsSync, mkdirSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { chromium } from "playwright-core";

export const root = join(dirname(fileURLToPath(import.meta.url)), "..", "..");
const sinew = process.env.SINEW_BIN ?? join(root, "build/release/sinew");
export const pictures = process.env.SINEW_PICTURES ?? join(root, "build/web");
mkdirSync(pictures, { recursive: true });

const browsers = [process.env.SINEW_CHROMIUM, "/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"];

/** Starts sinew view and gives its address; `stop` ends it by Ctrl-C and gives the exit code. Without
 * a scene (null) it begins with the gallery. */
export async function serve(scene, { port = 0, host, env = {} } = {}) {
  const child = spawn(sinew, ["view", ...(scene ? [join(root, scene)] : []), "--port", String(port), ...(host ? ["--host", host] : [])], { cwd: root, env: { ...process.env, ...env }, stdio: ["ignore", "pipe", "inherit"] });
  const url = await new Promise((found, failed) => {
    let text = "";
    child.stdout.on("data", (part) => {
      text += part;
      if (text.includes("\n")) found(text.split("\n")[0]);
    });
    child.on("error", failed);
    child.on("exit", (code) => failed(new Error(`sinew view ended with ${code}`)));
  });
  const ended = new Promise((done) => child.on("exit", done));
  return {
    url,
    port: Number(new URL(url).port),
    pid: child.pid,
    stop: async () => {
      child.kill("SIGINT");
      return ended;
    },
  };
}

export async function launch() {
  const executablePath = browsers.find((path) => path && existsSync(path));
  if (!executablePath) throw new Error("no Chromium here: ./dev setup browser, or name one by SINEW_CHROMIUM");
  return chromium.launch({
    executablePath,
    args: ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist"],
  });
}

/** Opens the address in a page, lets `body` test it, and closes it whatever comes. Nothing may be
 * fetched from elsewhere or complained of on the console. Drawn in half as many pixels a length as
 * the page has, unless options say otherwise: the processor draws them. */
export async function visit(browser, url, { width = 900, height = 600, ...options }, body) {
  const context = await browser.newContext({ viewport: { width, height }, deviceScaleFactor: 0.5, ...options });
  try {
    const page = await context.newPage();
    const faults = [];
    page.on("console", (m) => ["error", "warning"].includes(m.type()) && faults.push(m.text()));
    page.on("pageerror", (e) => faults.push(String(e)));
    page.on("request", (r) => r.url().startsWith(new URL(url).origin) || /^(data|blob):/.test(r.url()) || faults.push(`fetched ${r.url()}`));
    await page.goto(url, { timeout: 60_000, waitUntil: "commit" });
    await until(page, () => window.sinew?.state.frame > 0, null, 120);
    await body(page, faults);
    assert.deepEqual(faults, []);
  } finally {
    await context.close();
  }
}

/** Waits until the function is true in the page. (Playwright's own way needs eval, which the page's
 * policy forbids.) */
export async function until(page, condition, argument, seconds = 60) {
  const end = Date.now() + 1000 * seconds;
  while (Date.now() < end) {
    if (await page.evaluate(condition, argument)) return;
    await page.waitForTimeout(50);
  }
  throw new Error(`not so after ${seconds} s: ${condition}`);
}

export const state = (page, key) => page.evaluate((k) => window.sinew.state[k], key);
export const picture = (page, name) => page.screenshot({ path: join(pictures, `${name}.png`) });

/** The surface node that is nearest to the viewer around a place in the window (shares of its
 * size), and its place. */
export const nodeInFront = (page, across = 0.4, down = 0.5) =>
  page.evaluate(([right, below]) => {
    const { positions, camera, onPage } = window.sinew.state;
    let best = 0, least = Infinity;
    for (let n = 0; n < positions.length / 3; ++n) {
      const [x, y] = onPage(n);
      const d = Math.hypot(...camera.map((c, i) => c - positions[3 * n + i]));
      const score = d * (1 + Math.hypot(x / innerWidth - right, y / innerHeight - below));
      if (score < least) [best, least] = [n, score];
    }
    return { node: best, at: onPage(best) };
  }, [across, down]);
