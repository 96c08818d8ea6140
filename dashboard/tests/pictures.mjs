// Makes the pictures of the dashboard that the documents show, anew:
//   SLIPWAY=build/check/server/slipway SLIPWAY_SOURCE=$PWD node dashboard/tests/pictures.mjs
import { join } from "node:path";

process.env.SCREENSHOTS = join(process.env.SLIPWAY_SOURCE, "docs/images");
const { launch, open } = await import("./page.mjs");
const { serve } = await import("./service.mjs");
const service = await serve();
const browser = await launch();
const picture = async (hash, name, run) => {
  const p = await open(browser, `${service.url}/dashboard/#${hash}`, { viewport: { width: 1440, height: 900 } });
  await p.waitForSelector(".terrain select");
  await run(p);
  await p.mouse.move(720, 5);
  await p.waitForTimeout(1500);
  await p.look(name);
  await p.done();
};

await picture("terrain=gale&start=8142635.32,-276686.33&goal=8142677.97,-276715.65", "dashboard", async (p) => {
  await p.click('[data-do="plan"]');
  await p.verdict();
});
await picture("terrain=gale&tab=drives", "dashboard_diagnosis", async (p) => {
  await p.selectOption("#panel-drives select >> nth=0", "p05");
  await p.click('[data-do="diagnose"]');
  await p.waitForSelector("[data-diagnosis]", { timeout: 600_000 });
});
await browser.close();
await service.stop();
