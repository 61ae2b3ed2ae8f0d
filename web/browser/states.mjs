// What the live view looks like in use: states that a test goes through, and that the pictures of
// the documentation show.
import { nodeInFront, state, until } from "./support.mjs";

const WIDE = { width: 1280, height: 760 };
const PHONE = { width: 390, height: 780, hasTouch: true, isMobile: true };

const runUntil = async (page, time) => {
  await page.locator("#view").focus(); // the space bar presses the button that has the focus
  await page.keyboard.press("Space");
  await until(page, (t) => window.sinew.state.time > t, time, 120);
};
const drawn = async (page, pictures = 2) => {
  const from = await state(page, "drawn");
  await until(page, (n) => window.sinew.state.drawn >= n, from + pictures, 120);
};
/** Presses on the tissue nearest to a place of the window, given in shares. */
const press = async (page, x, y) => {
  const { at } = await nodeInFront(page, x, y);
  await page.mouse.move(...at);
  await page.mouse.down();
  return at;
};

export const states = [
  {
    name: "pulled", scene: "scenes/liver.toml", size: WIDE, document: "view",
    async show(page) {
      await page.selectOption("#coloring", "stress");
      await runUntil(page, 1.2);
      const [x, y] = await press(page, 0.42, 0.5);
      await page.mouse.move(x + 60, y - 150, { steps: 8 });
      await until(page, () => / m?N$/.test(document.querySelector(".force")?.textContent ?? ""));
      const time = await state(page, "time");
      await until(page, (t) => window.sinew.state.time > t + 0.8, time, 120);
      await drawn(page);
    },
  },
  {
    name: "compared", scene: "scenes/liver.toml", size: WIDE, document: "view-2",
    async show(page) {
      await page.selectOption("#compare-law", "lloyd");
      await until(page, () => window.sinew.state.compared === "over");
      await page.getByText("Beside it", { exact: true }).click();
      await runUntil(page, 1.2);
      await until(page, () => window.sinew.state.compared === "beside" && window.sinew.state.status.distance?.largest > 1e-3);
      await drawn(page);
    },
  },
  {
    name: "cut", scene: "scenes/liver.toml", size: WIDE, document: "view-3",
    async show(page) {
      await page.keyboard.press("d");
      await page.getByRole("tab", { name: "Displacement" }).click();
      await page.selectOption("#coloring", "stress");
      await page.keyboard.press("x");
      await until(page, () => window.sinew.state.scene.cut !== null);
      await runUntil(page, 4); // the range of the colours has come down from the first swing
      await page.keyboard.press("Space");
      await until(page, () => !window.sinew.state.status.running && document.querySelector("#limit").textContent === "");
    },
  },
  {
    name: "incised", scene: "scenes/liver.toml", size: WIDE, document: "view-5",
    async show(page) {
      await page.getByRole("button", { name: "Cut with a scalpel" }).click();
      for (let i = 0; i < 6; ++i) await page.keyboard.press("]");
      await runUntil(page, 1.5);
      const at = await page.evaluate(() => {
        const { positions, onPage } = window.sinew.state;
        const middle = [0, 0];
        for (let n = 0; n < positions.length / 3; ++n)
          onPage(n).forEach((c, i) => (middle[i] += (3 * c) / positions.length));
        return middle;
      });
      await page.mouse.move(at[0] + 40, at[1] - 70);
      await page.mouse.down();
      await until(page, () => window.sinew.state.cutting);
      for (let k = 0; k <= 40; ++k) {
        await page.mouse.move(at[0] + 40 - 0.4 * k, at[1] - 70 + 4.5 * k);
        await page.waitForTimeout(40);
      }
      await page.mouse.up();
      await until(page, () => window.sinew.state.status.cut_area > 1e-3 && !window.sinew.state.cutting, null, 120);
      const time = await state(page, "time");
      await until(page, (t) => window.sinew.state.time > t + 1, time, 120);
      await drawn(page);
    },
  },
  {
    name: "poured", scene: "scenes/pour.toml", size: WIDE, document: "view-4",
    async show(page) {
      await page.selectOption("#coloring", "displacement");
      await page.keyboard.press("k");
      await runUntil(page, 1);
      await page.keyboard.press("Space");
      await until(page, () => !window.sinew.state.status.running && window.sinew.state.contacts > 0);
      await page.evaluate(() => window.sinew.look([0.3, 0.8, 1], 0.7));
      await drawn(page, 1);
    },
  },
  {
    name: "pushed", scene: "scenes/liver.toml", size: WIDE,
    async show(page) {
      await page.selectOption("#coloring", "displacement");
      await page.getByRole("button", { name: "Push with a ball" }).click();
      await runUntil(page, 1.6);
      await press(page, 0.36, 0.45);
      await until(page, () => window.sinew.state.status.ball?.contacts > 0);
      for (let i = 0; i < 4; ++i) await page.keyboard.press("]");
      await drawn(page, 4);
    },
  },
  {
    name: "scenes", scene: null, size: WIDE,
    async show(page) {
      await until(page, () => document.querySelectorAll(".scene").length > 8);
      await until(page, () => [...document.querySelectorAll(".scene img")].every((i) => i.complete || i.getBoundingClientRect().top > innerHeight));
    },
  },
  {
    name: "phone-plots", scene: "scenes/pull.toml", size: PHONE,
    async show(page) {
      await page.getByRole("button", { name: "Plots" }).tap();
      await page.getByRole("button", { name: "Run" }).tap();
      await until(page, () => window.sinew.state.time > 0.8, null, 120);
      await drawn(page);
    },
  },
];
