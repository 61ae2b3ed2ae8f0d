// Makes the pictures that are part of the project:
//   node browser/pictures.mjs scenes [NAME...]   scenes/pictures/NAME.jpg, for the gallery
//   node browser/pictures.mjs docs [NAME...]     docs/images/view*.jpg
// SINEW_BIN names the program; ./dev docs calls this.
import { mkdirSync, readdirSync, statSync } from "node:fs";
import { join } from "node:path";
import { states } from "./states.mjs";
import { launch, root, serve, state, until, visit } from "./support.mjs";

const CARD = { width: 480, height: 300, deviceScaleFactor: 2 };
const MOST_BYTES = 30_000; // of a card
const FRONT = [0.52, 0.3, 0.8];

// The moment, the side and the look of each scene: frames of 1/60 s, or single steps.
const cards = {
  beam: { frames: 13, from: [0.75, 0.25, 0.6], room: 1.1 },
  "cut-liver": { frames: 84, from: [0.35, 0.5, 1], room: 0.95, labels: false },
  drop: { frames: 24, from: [0.25, 0.3, 1], room: 1.05 },
  ligament: { frames: 60, from: [0.5, 0.12, 1], room: 1.02 },
  grasp: { frames: 78, from: [0.5, 0.4, 1], room: 0.95, labels: false },
  "liver-fine": { frames: 30, show: "w", room: 0.95 },
  liver: { frames: 16, show: "u", room: 0.95 },
  organs: { frames: 56, from: [0.25, 0.42, 1], room: 0.23, labels: false },
  palpate: { frames: 150, from: [0.35, 0.35, 1], room: 1.05, labels: false },
  pour: { frames: 50, color: "displacement", from: [0.3, 0.8, 1], room: 0.62, labels: false },
  press: { frames: 70, from: [0.35, 0.55, 1], room: 1.02 },
  pull: { frames: 58, color: "displacement", show: "u", from: [0.4, 0.25, 1] },
  resect: { frames: 42, from: [0.3, 0.25, 1], room: 0.95, labels: false },
  stack: { frames: 20, color: "stress", from: [0.6, 0.2, 1], room: 1.02 },
  "talk-bad-constants": { steps: 28, color: "stretch" },
  "talk-constants": { frames: 20, color: "displacement" },
  "talk-good-constants": { frames: 9, color: "displacement", show: "u" },
  "talk-tissue-limits": { frames: 30, color: "stretch" },
  "talk-tissue": { frames: 30, color: "stretch" },
  "tear-strip": { frames: 66, color: "stretch", from: [0.15, 0.25, 1], room: 1.02 },
  twist: { frames: 90, color: "stress" },
};

async function card(browser, name) {
  const { frames = 0, steps = 0, color, show = "", from = FRONT, room = 1.15, labels = true } = cards[name] ?? { frames: 30 };
  const server = await serve(`scenes/${name}.toml`);
  try {
    await visit(browser, `${server.url}#fine`, CARD, async (page) => {
      if (color) await page.evaluate((c) => {
        const select = document.querySelector("#coloring");
        select.value = c;
        select.dispatchEvent(new Event("change"));
      }, color);
      for (let i = 0; i < frames + steps; ++i) {
        const { step } = await state(page, "status");
        await page.keyboard.press(i < frames ? "Shift+S" : "s");
        await until(page, (n) => window.sinew.state.status.step > n, step, 120);
      }
      const { time } = await state(page, "status");
      await until(page, (t) => Math.abs(window.sinew.state.time - t) < 1e-9, time, 120);
      for (const key of show) await page.keyboard.press(key);
      await page.addStyleTag({ content: `#ui${labels ? "" : ", .force"} { visibility: hidden !important }` });
      const drawn = await page.evaluate(([direction, space]) => {
        window.sinew.look(direction, space);
        return window.sinew.state.drawn;
      }, [from, room]);
      await until(page, (n) => window.sinew.state.drawn > n, drawn, 120);
      const path = join(root, "scenes/pictures", `${name}.jpg`);
      for (const quality of [82, 74, 66]) {
        await page.screenshot({ path, type: "jpeg", quality, scale: "css" });
        if (statSync(path).size < MOST_BYTES) break;
      }
      console.log(`${path}: ${statSync(path).size} bytes, at ${time.toFixed(3)} s`);
    });
  } finally {
    await server.stop();
  }
}

async function document(browser, { name, scene, size, show, document: file }) {
  const server = await serve(scene);
  try {
    await visit(browser, `${server.url}#fine`, { ...size, deviceScaleFactor: 1 }, async (page) => {
      await show(page);
      const path = join(root, "docs/images", `${file}.jpg`);
      await page.screenshot({ path, type: "jpeg", quality: 84 });
      console.log(`${path}: ${name}, ${statSync(path).size} bytes`);
    });
  } finally {
    await server.stop();
  }
}

const [what, ...names] = process.argv.slice(2);
if (what !== "scenes" && what !== "docs") {
  console.error("which pictures? node browser/pictures.mjs scenes [NAME...] | docs [NAME...]");
  process.exit(2);
}
const browser = await launch();
try {
  if (what === "docs") {
    for (const s of states)
      if (s.document && (names.length === 0 || names.includes(s.name))) await document(browser, s);
  } else {
    mkdirSync(join(root, "scenes/pictures"), { recursive: true });
    const all = readdirSync(join(root, "scenes")).filter((f) => f.endsWith(".toml")).map((f) => f.slice(0, -5));
    for (const name of names.length > 0 ? names : all) await card(browser, name);
  }
} finally {
  await browser.close();
}
