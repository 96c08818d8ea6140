// How fast the dashboard is in a real browser, on a terrain of 16,384 cells a side: prints figures and their targets, and ends with 1
// where one is missed. Run by hand, on a machine that does nothing else:
//   SLIPWAY=build/check/server/slipway FRACTAL_MAP=build/check/bench/fractal_map SLIPWAY_SOURCE=$PWD node dashboard/tests/speed.mjs [FOLDER]
// FOLDER keeps the terrain for the next run.
import { execFileSync } from "node:child_process";
import { cpSync, existsSync, mkdirSync, mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { launch } from "./page.mjs";
import { serve, slipway } from "./service.mjs";

const side = Number(process.env.SPEED_SIDE ?? 16384);
const folder = process.argv[2] ?? mkdtempSync(join(tmpdir(), "slipway-speed-"));
const data = join(folder, "data");
const rows = [];
const row = (what, value, unit, most) => rows.push({ what, value, unit, most, holds: most === undefined || value <= most });
const quantile = (values, q) => [...values].sort((a, b) => a - b)[Math.min(values.length - 1, Math.floor(q * values.length))];
const pause = (ms) => new Promise((resolve) => setTimeout(resolve, ms));

if (!existsSync(join(data, "terrains/large"))) {
  mkdirSync(join(data, "terrains"), { recursive: true });
  for (const name of ["rovers", "soils", "rules", "beliefs"]) cpSync(join(process.env.SLIPWAY_SOURCE, "data", name), join(data, name), { recursive: true });
  cpSync(join(process.env.SLIPWAY_SOURCE, "data/terrains/gale"), join(data, "terrains/gale"), { recursive: true });
  const map = join(folder, "large.tif");
  execFileSync(process.env.FRACTAL_MAP, [map, String(side), "1", "1", "8"], { stdio: "inherit" });
  // About the pole, so that a metre of the map is one of the ground.
  const moon = "+proj=stere +lat_0=-90 +lon_0=0 +k=1 +x_0=508192 +y_0=3991808 +R=1737400 +units=m +no_defs";
  execFileSync(slipway, ["terrain", "import", map, "--name", "large", "--crs", moon, "--gravity", "1.62", "--data", data], { stdio: "inherit" });
  rmSync(map);
}
const service = await serve("--data", data);
const browser = await launch();

/** The longest task of the page's main thread while something is done: by the clock, and of the processor, which other work does not lengthen. */
async function longestTask(page, run) {
  await browser.startTracing(page, { categories: ["toplevel", "disabled-by-default-devtools.timeline", "devtools.timeline"] });
  await run();
  await pause(300);
  const { traceEvents: events } = JSON.parse((await browser.stopTracing()).toString());
  const named = events.filter((e) => e.name === "thread_name" && e.args.name === "CrRendererMain").map((e) => `${e.pid}/${e.tid}`);
  const tasks = events.filter((e) => e.ph === "X" && /RunTask$/.test(e.name) && named.includes(`${e.pid}/${e.tid}`));
  return { clock: Math.max(0, ...tasks.map((t) => t.dur / 1000)), processor: Math.max(0, ...tasks.map((t) => (t.tdur ?? t.dur) / 1000)) };
}

async function firstView(terrain, what) {
  const times = [];
  const page_ms = [];
  const served = service.cpu_s();
  for (let run = 0; run < 5; ++run) {
    const context = await browser.newContext({ viewport: { width: 1440, height: 1000 } });
    const p = await context.newPage();
    const session = await context.newCDPSession(p);
    await session.send("Performance.enable", { timeDomain: "threadTicks" });
    const began = performance.now();
    const tiles = [];
    p.on("requestfinished", (r) => r.url().includes("/tiles/hillshade/") && tiles.push(performance.now()));
    await p.goto(`${service.url}/dashboard/#terrain=${terrain}`);
    for (let quiet = 0; quiet < 8; ) {
      const before = tiles.length;
      await pause(50);
      quiet = tiles.length > 0 && tiles.length === before ? quiet + 1 : 0;
    }
    times.push(tiles.at(-1) - began);
    const { metrics } = await session.send("Performance.getMetrics");
    page_ms.push(1000 * metrics.find((m) => m.name === "TaskDuration").value);
    await context.close();
  }
  row(`${what}, median of 5`, quantile(times, 0.5), "ms", 1000);
  row("   its processor time: the page's main thread", quantile(page_ms, 0.5), "ms");
  row("   its processor time: the service", (1000 * (service.cpu_s() - served)) / 5, "ms");
}

await firstView("gale", "first view of a terrain (page, its catalogue, all tiles in sight)");
await firstView("large", `first view of ${side} cells a side`);

const context = await browser.newContext({ viewport: { width: 1440, height: 1000 } });
const p = await context.newPage();
const tiles = [];
p.on("requestfinished", (r) => {
  if (!r.url().includes("/tiles/")) return;
  const t = r.timing();
  tiles.push(t.responseEnd - t.requestStart);
});
await p.goto(`${service.url}/dashboard/#terrain=large&layers=slope:0.6,soil:0,unknown:0.6`);
await p.waitForSelector(".map canvas");
await pause(1500);
const box = await p.locator(".map").boundingBox();
const middle = { x: box.x + box.width / 2, y: box.y + box.height / 2 };
const before = { tiles: tiles.length, cpu_s: service.cpu_s() };
const panned = await longestTask(p, async () => {
  for (let zoom = 0; zoom < 5; ++zoom) {
    await p.mouse.move(middle.x, middle.y);
    await p.mouse.wheel(0, -400);
    await pause(400);
    for (let drag = 0; drag < 4; ++drag) {
      await p.mouse.move(middle.x - 200, middle.y - 100);
      await p.mouse.down();
      for (let k = 0; k < 25; ++k) await p.mouse.move(middle.x - 200 + 16 * k * (drag % 2 ? -1 : 1), middle.y - 100 + 8 * k, { steps: 1 });
      await p.mouse.up();
      await pause(150);
    }
  }
});
row(`longest main-thread task while panning and zooming ${side} cells a side with two layers, processor`, panned.processor, "ms", 50);
row("the same by the clock", panned.clock, "ms");
row(`a tile, 99 % of ${tiles.length}`, quantile(tiles, 0.99), "ms", 100);
row("a tile, median", quantile(tiles, 0.5), "ms");
row("a tile, processor time of the service", (1000 * (service.cpu_s() - before.cpu_s)) / Math.max(1, tiles.length - before.tiles), "ms");

// A route of a thousand stations under the pointer.
const { extent } = (await (await p.request.get(`${service.url}/v1/terrains/large`)).json()).terrain;
const centre = { x: (extent.west_m + extent.east_m) / 2, y: (extent.south_m + extent.north_m) / 2 };
const path = Array.from({ length: 21 }, (_, i) => `${(centre.x + i * 25).toFixed(1)},${(centre.y + 60 * Math.sin(i / 2)).toFixed(1)}`).join(";");
await p.goto("about:blank");
await p.goto(`${service.url}/dashboard/#terrain=large&tab=check&path=${path}`);
await p.waitForSelector(".terrain select");
const stations_of = async () => {
  const job = new URLSearchParams(p.url().split("#")[1]).get("job");
  return (await (await p.request.get(`${service.url}/v1/jobs/${job}/result`)).json()).routes.features[0].properties.stations.count;
};
await p.click('[data-do="check"]');
await p.waitForSelector("[data-verdict]", { timeout: 300_000 });
await pause(1500);
const stations = await stations_of();
const chart = await p.locator(".u-over").first().boundingBox();
const hovered = await longestTask(p, async () => {
  for (let k = 0; k < 200; ++k) await p.mouse.move(chart.x + (chart.width * k) / 200, chart.y + 40);
  for (let k = 0; k < 200; ++k) await p.mouse.move(box.x + (box.width * k) / 200, middle.y + 30 * Math.sin(k / 10));
});
row(`longest main-thread task while the pointer runs over ${stations} stations, charts and map, processor`, hovered.processor, "ms", 50);
row("the same by the clock", hovered.clock, "ms");

for (const tab of ["plan", "jobs"]) {
  await p.click(`#tab-${tab}`);
  await p.mouse.move(5, 5);
  await pause(1500);
  let asked = 0;
  const count = () => ++asked;
  p.on("request", count);
  await pause(10_000);
  p.off("request", count);
  row(`requests while nothing happens, ${tab}`, asked / 10, "a second", 1);
}
await browser.close();
await service.stop();
if (!process.argv[2]) rmSync(folder, { recursive: true, force: true });
for (const { what, value, unit, most, holds } of rows) console.log(`${holds ? "      " : "MISSED"}  ${value.toFixed(value < 10 ? 2 : 0).padStart(8)} ${unit.padEnd(8)} ${most === undefined ? "" : `at most ${most}`.padEnd(13)} ${what}`);
process.exit(rows.every((r) => r.holds) ? 0 : 1);
