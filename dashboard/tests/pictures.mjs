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
await picture("terrain=gale&start=8142640,-276640&goal=8142655,-276645&at=2016-03-22T07:00:00Z&sun=shadow&when=from%3D2016-03-22T00:00:00Z,to%3D2016-03-23T00:00:00Z,charge_percent%3D60,min_charge_percent%3D40,min_sun_deg%3D10", "dashboard_day", async (p) => {
  await p.click('[data-do="plan"]');
  await p.verdict();
  // From as far as the next shadows are.
  await p.locator(".map").focus();
  for (let k = 0; k < 3; ++k) await p.keyboard.press("-").then(() => p.waitForTimeout(400));
  await p.locator(".strip").scrollIntoViewIfNeeded();
  await p.locator('.chart-box[aria-label^="Battery"]').scrollIntoViewIfNeeded();
});
await picture("terrain=gale&tab=drives", "dashboard_diagnosis", async (p) => {
  await p.selectOption("#panel-drives select >> nth=0", "p05");
  await p.click('[data-do="diagnose"]');
  await p.waitForSelector("[data-diagnosis]", { timeout: 600_000 });
});
await browser.close();
await service.stop();
