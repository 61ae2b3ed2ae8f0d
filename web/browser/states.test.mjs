// The states that the documentation shows; each leaves its picture.
import { after, before, test } from "node:test";
import { launch, picture, serve, visit } from "./support.mjs";
import { states } from "./states.mjs";

let browser;
before(async () => {
  browser = await launch();
});
after(() => browser?.close());

for (const { name, scene, size, show } of states) {
  test(`the page as it is when ${name}`, async () => {
    const server = await serve(scene);
    try {
      await visit(browser, server.url, { ...size, deviceScaleFactor: 1 }, async (page) => {
        await show(page);
        await picture(page, name);
      });
    } finally {
      await server.stop();
    }
  });
}
