// Random use for a long time, and what it does to the memory of server and page:
//   node browser/soak.mjs [--minutes N] [--seed N]
// Ends with exit code 1 where the second half needs over 10 % + 20 MB more than the first did.
import { readFileSync } from "node:fs";
import { pathToFileURL } from "node:url";
import { launch, nodeInFront, serve, state, until, visit } from "./support.mjs";

const HOME = "beam"; // memory is compared with this scene open
const SHARE = 0.1;
const SLACK_MB = 20;
// What the server gives back to the allocator shall go back to the system: what is left is in use.
const HONEST = { MALLOC_ARENA_MAX: "1", MALLOC_MMAP_THRESHOLD_: "65536", MALLOC_TRIM_THRESHOLD_: "65536" };
const LIMIT = 120; // [s] for anything that is waited for

/** Numbers from 0 to 1 that a seed repeats (mulberry32). */
function random(seed) {
  return () => {
    seed = (seed + 0x6d2b79f5) | 0;
    let t = Math.imul(seed ^ (seed >>> 15), 1 | seed);
    t = (t + Math.imul(t ^ (t >>> 7), 61 | t)) ^ t;
    return ((t ^ (t >>> 14)) >>> 0) / 4294967296;
  };
}

const focus = (page) => page.locator("#view").focus();
const press = async (page, key) => {
  await focus(page);
  await page.keyboard.press(key);
};

/** Opens a scene of the gallery as a user does. */
async function open(page, name) {
  const { opened } = await state(page, "scene");
  await press(page, "o");
  await until(page, () => document.querySelectorAll(".scene").length > 0, null, LIMIT);
  await page.locator(`.scene[data-name=${name}]`).click();
  await until(page, (n) => window.sinew.state.scene.opened > n && window.sinew.state.frame > 0, opened, LIMIT);
}

/** What is done, by name and how often. Each takes the page, a source of chance, and the rest. */
const deeds = {
  play: [6, ({ page }) => press(page, " ")],
  pull: [8, async ({ page, chance }) => {
    const { at } = await nodeInFront(page, 0.2 + 0.4 * chance(), 0.3 + 0.4 * chance());
    await page.mouse.move(...at);
    await page.mouse.down();
    await page.mouse.move(at[0] + 300 * (chance() - 0.5), at[1] + 300 * (chance() - 0.5), { steps: 8 });
    await page.waitForTimeout(400 * chance());
    await page.mouse.up();
  }],
  pin: [2, async ({ page }) => {
    const { at } = await nodeInFront(page);
    await page.mouse.click(...at, { modifiers: ["Shift"] });
  }],
  "let go": [1, ({ page }) => press(page, "Escape")],
  push: [4, async ({ page, chance }) => {
    await page.getByRole("button", { name: "Push with a ball" }).click();
    const { at } = await nodeInFront(page, 0.2 + 0.4 * chance(), 0.3 + 0.4 * chance());
    await page.mouse.move(...at);
    await page.mouse.down();
    await page.mouse.move(at[0] + 80 * (chance() - 0.5), at[1] + 80 * (chance() - 0.5), { steps: 4 });
    await page.waitForTimeout(600 * chance());
    await page.mouse.up();
    await page.getByRole("button", { name: "Pull", exact: true }).click();
  }],
  turn: [4, async ({ page, chance }) => {
    await page.mouse.move(300, 130);
    await page.mouse.down();
    await page.mouse.move(300 + 200 * (chance() - 0.5), 130 + 60 * (chance() - 0.5), { steps: 5 });
    await page.mouse.up();
    await page.mouse.wheel(0, 400 * (chance() - 0.5));
  }],
  home: [2, ({ page }) => press(page, "f")],
  colour: [4, ({ page }) => press(page, "c")],
  look: [4, ({ page, chance }) => press(page, "wungkl"[Math.floor(6 * chance())])],
  cut: [2, ({ page }) => press(page, "x")],
  young: [6, ({ page, chance }) => setYoung(page, chance())],
  compare: [2, async ({ page, chance }) => {
    const laws = await page.locator("#compare-law option").evaluateAll((all) => all.map((o) => o.value));
    await page.selectOption("#compare-law", laws[Math.floor(laws.length * chance())]);
  }],
  plots: [2, ({ page }) => press(page, "d")],
  reset: [2, ({ page }) => press(page, "r")],
  resize: [1, ({ page, chance }) => page.setViewportSize({ width: 900 + Math.floor(400 * chance()), height: 640 + Math.floor(160 * chance()) })],
  scene: [2, ({ page, chance, scenes }) => open(page, scenes[Math.floor(scenes.length * chance())])],
  // Not in the second half: a page that is loaded again has forgotten what it leaked.
  reload: [1, async ({ page, half }) => {
    if (half === 2) return;
    await page.reload({ waitUntil: "commit", timeout: 1000 * LIMIT });
    await until(page, () => window.sinew?.state.frame > 0 && window.sinew.state.controls, null, LIMIT);
  }],
  guest: [1, ({ browser, url }) => visit(browser, url, { width: 480, height: 320 }, (second) => until(second, () => window.sinew.state.frame > 2, null, LIMIT))],
};

const setYoung = (page, share) =>
  page.getByLabel("Young’s modulus").evaluate((slider, s) => {
    slider.value = String(s * Number(slider.max));
    slider.dispatchEvent(new Event("input"));
  }, share);

/** A scene at what takes most memory, so that the first half of the time knows it: two bodies, stiff. */
async function exert(page, name) {
  await open(page, name);
  await page.selectOption("#compare-law", "lloyd");
  await setYoung(page, 0.9);
  const from = await state(page, "time");
  await press(page, " ");
  await page.waitForTimeout(1000);
  await until(page, (t) => window.sinew.state.time > t || !window.sinew.state.status.running, from, LIMIT);
}

/** One of the deeds by their weights. */
function choose(chance) {
  const total = Object.values(deeds).reduce((sum, [weight]) => sum + weight, 0);
  let at = chance() * total;
  return Object.keys(deeds).find((name) => (at -= deeds[name][0]) < 0);
}

/** Puts everything back that costs memory, then measures it [MB]. */
async function measure(page, protocol, pid) {
  await press(page, "Escape");
  await page.selectOption("#compare-law", "");
  // What was pressed last may still be on its way to the server and back.
  for (const [key, is] of [["l", (s) => s.springs_shown], ["x", (s) => s.cut !== null]]) {
    for (let i = 0; i < 5 && is(await state(page, "scene")); ++i) {
      await press(page, key);
      await page.waitForTimeout(300);
    }
  }
  await open(page, HOME);
  await protocol.send("HeapProfiler.collectGarbage");
  const { metrics } = await protocol.send("Performance.getMetrics");
  const status = readFileSync(`/proc/${pid}/status`, "utf8");
  return {
    server: Number(/VmRSS:\s+(\d+) kB/.exec(status)[1]) / 1024,
    page: metrics.find((m) => m.name === "JSHeapUsedSize").value / 1024 / 1024,
  };
}

/** Whether the second half of the samples needs no more than it may. */
function judge(samples, what) {
  const middle = Math.ceil(samples.length / 2);
  const most = (part) => Math.max(...part.map((s) => s[what]));
  const [first, second] = [most(samples.slice(0, middle)), most(samples.slice(middle))];
  const fine = second <= (1 + SHARE) * first + SLACK_MB;
  return { fine, text: `${what}: at most ${first.toFixed(1)} MB in the first half, ${second.toFixed(1)} MB in the second${fine ? "" : ": too much"}` };
}

/** Uses the page for so long. Gives what was done, the samples, and whether memory stayed. */
export async function soak(browser, { seconds, every = 10, seed = 1, scenes, tell = () => {} }) {
  const server = await serve(`scenes/${HOME}.toml`, { env: HONEST });
  const chance = random(seed);
  const done = {};
  const samples = [];
  try {
    await visit(browser, server.url, { width: 1100, height: 720 }, async (page) => {
      const protocol = await page.context().newCDPSession(page);
      await protocol.send("Performance.enable");
      const rounds = [...(scenes ?? await page.evaluate(async () => (await (await fetch("/gallery.json")).json()).map((s) => s.name)))];
      for (const name of rounds) await exert(page, name);
      const began = Date.now();
      while (Date.now() < began + 1000 * seconds) {
        const until = Date.now() + 1000 * every;
        const half = Date.now() < began + 500 * seconds ? 1 : 2;
        while (Date.now() < until) {
          const deed = choose(chance);
          done[deed] = (done[deed] ?? 0) + 1;
          try {
            await deeds[deed][1]({ page, chance, browser, url: server.url, scenes: rounds, half });
          } catch (error) {
            throw new Error(`${deed} (seed ${seed}, after ${JSON.stringify(done)}): ${error.message}`);
          }
        }
        const sample = { after: (Date.now() - began) / 1000, ...(await measure(page, protocol, server.pid)) };
        samples.push(sample);
        tell(sample);
      }
    });
  } finally {
    await server.stop();
  }
  const verdicts = ["server", "page"].map((what) => judge(samples, what));
  return { done, samples, verdicts, fine: verdicts.every((v) => v.fine) };
}

async function main(words) {
  const option = (name, otherwise) => (words.includes(name) ? Number(words[words.indexOf(name) + 1]) : otherwise);
  const [minutes, seed] = [option("--minutes", 10), option("--seed", 1)];
  if (!(minutes > 0) || !Number.isInteger(seed)) {
    console.error("node browser/soak.mjs [--minutes N] [--seed N]");
    return 2;
  }
  const browser = await launch();
  try {
    console.log(`${minutes} minutes of random use, seed ${seed}\n  time [s]  server [MB]  page [MB]`);
    const row = ({ after, server, page }) => [after.toFixed(0).padStart(10), server.toFixed(1).padStart(12), page.toFixed(1).padStart(10)].join(" ");
    const { done, verdicts, fine } = await soak(browser, { seconds: 60 * minutes, seed, tell: (s) => console.log(row(s)) });
    console.log(Object.entries(done).map(([deed, times]) => `${deed} ${times}`).join(", "));
    for (const { text } of verdicts) console.log(text);
    return fine ? 0 : 1;
  } finally {
    await browser.close();
  }
}

if (import.meta.url === pathToFileURL(process.argv[1]).href) process.exitCode = await main(process.argv.slice(2));
