// What a person does with mouse, finger and keyboard, on a phone, a tablet, a laptop and a wide screen.
import assert from "node:assert/strict";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { launch, open } from "./page.mjs";
import { serve } from "./service.mjs";

const ground = "terrain=gale&rover=msl-class&routes=1&draws=32";
const start = { x_m: 8142640, y_m: -276640 }; // both on ground of known soil
const goal = { x_m: 8142655, y_m: -276645 };
const example = { start: { x_m: 8142566, y_m: -276711 }, goal: { x_m: 8142566, y_m: -276696 } };
const near = "view=8142648,-276643,0.1";
const placed = `start=${start.x_m},${start.y_m}&goal=${goal.x_m},${goal.y_m}`;
const screens = {
  phone: { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true },
  tablet: { viewport: { width: 820, height: 1180 }, hasTouch: true, isMobile: true },
  laptop: { viewport: { width: 1280, height: 800 } },
  wide: { viewport: { width: 1920, height: 1080 } },
};
let service;
let browser;
let answered; // the link to a plan that is there

before(async () => {
  browser = await launch();
  service = await serve();
  const response = await fetch(`${service.url}/v1/plans`, { method: "POST", headers: { "Content-Type": "application/json" }, body: JSON.stringify({ terrain: "gale", rover: "msl-class", start, goal, routes: 1, draws: 32 }) });
  const { id } = response.status === 200 ? { id: response.headers.get("location").split("/").at(-1) } : await response.json();
  answered = `${ground}&${placed}&job=${id}`;
});
after(async () => {
  await browser?.close();
  await service?.stop();
});

const page = (screen, hash, options = {}) => open(browser, `${service.url}/dashboard/#${hash}`, { ...screens[screen], ...options });
const pause = (ms) => new Promise((resolve) => setTimeout(resolve, ms));
const settled = (p) => p.until(() => document.querySelector("[data-on-map]")?.dataset.onMap && !document.querySelector(".work .job"));
const box = (p, selector) => p.evaluate((s) => document.querySelector(s).getBoundingClientRect().toJSON(), selector);
/** What the map's layers have at a place of the screen. */
const mapColours = (p, { x, y }) =>
  p.evaluate(([px, py]) => [...document.querySelectorAll(".map canvas")].map((canvas) => {
    const b = canvas.getBoundingClientRect();
    return `#${[...canvas.getContext("2d").getImageData(((px - b.x) * canvas.width) / b.width, ((py - b.y) * canvas.height) / b.height, 1, 1).data].slice(0, 3).map((v) => v.toString(16).padStart(2, "0")).join("")}`;
  }), [x, y]);
const mapPicture = async (p) => (await p.locator(".map").screenshot()).toString("base64");

/** What is asked for while a knob or a mark is dragged goes out at most every 150 ms. Of the whole drag, since a busy machine hands single messages on late. */
function assertPaced(times) {
  const longest = (times.at(-1) - times[0]) / 150 + 2;
  assert.ok(times.length <= longest, `${times.length} are asked for in ${times.at(-1) - times[0]} ms`);
}

async function settledAtTop(p) {
  await settled(p);
  await p.evaluate(() => window.scrollTo(0, 0));
  await pause(300);
}

/** Nothing runs out of the screen, the map has room, no mark lies under a control. */
async function wellLaid(p, screen) {
  const { width } = screens[screen].viewport;
  const map = await box(p, ".map");
  assert.ok(map.height > 250 && map.width > 300, `the map has ${map.width} by ${map.height}`);
  assert.ok((await p.evaluate(() => document.documentElement.scrollWidth)) <= width, "nothing is wider than the screen");
  const { start: s, goal: g } = Object.fromEntries(new URLSearchParams(p.url().split("#")[1]));
  for (const place of [s, g].filter(Boolean)) {
    const at = await p.pixel(...place.split(",").map(Number));
    assert.ok(at.x > map.x + 10 && at.x < map.right - 10 && at.y > map.y + 10 && at.y < map.bottom - 10, `${place} is in sight`);
    const over = await p.evaluate(([x, y]) => [...document.querySelectorAll(".ol-zoom, .scale-bar, .map-top > *, .map-readout, .map-lean, .layers")].filter((c) => {
      const b = c.getBoundingClientRect();
      return x > b.left - 11 && x < b.right + 11 && y > b.top - 11 && y < b.bottom + 11;
    }).map((c) => c.className), [at.x, at.y]);
    assert.deepEqual(over, [], `${place} lies under no control`);
  }
  if (width < 960 && (await p.locator(".chart").count()) > 0) assert.ok((await box(p, ".verdict .banner")).y < (await box(p, ".charts")).y, "the verdict comes before the charts");
}

test("1280, mouse: two clicks plan; a drag plans anew, pale at once, with little script a frame", async () => {
  const p = await page("laptop", `${ground}&${near}`);
  await p.waitForSelector(".terrain select");
  const asked = [];
  const sent = [];
  p.on("request", (r) => {
    if (r.method() === "POST" && r.url().endsWith("/v1/plans")) asked.push({ at: performance.now(), body: r.postDataJSON() });
    if (r.method() === "DELETE") sent.push(r.url());
  });
  const [from, to] = [await p.pixel(start.x_m, start.y_m), await p.pixel(goal.x_m, goal.y_m)];
  await p.mouse.click(from.x, from.y);
  await p.mouse.click(to.x, to.y);
  await settled(p);
  assert.equal(asked.length, 1, "the second click asks for the plan");
  assert.equal(await p.getAttribute("[data-on-map]", "data-on-map"), await p.verdict());
  await pause(300);
  await p.look("30_two_clicks");
  await wellLaid(p, "laptop");
  await p.plain("a plan");
  assert.match(await p.textContent('[data-degrees="plan-start"]'), /^137\.\d{5}° E, 4\.\d{5}° S$/);
  const job = new URLSearchParams(p.url().split("#")[1]).get("job");
  const answer = await (await p.request.get(`${service.url}/v1/jobs/${job}/result`)).json();
  const { cost, cost_shares } = answer.routes.features[0].properties;
  assert.equal(await p.textContent('.compare-table tr:has(th:has-text("Cost that ranks")) td >> nth=0'), String(Number(cost.toPrecision(4))));
  for (const { name, cost: part } of cost_shares) if (part) assert.ok((await p.textContent("[data-cost]")).includes(name.replaceAll("_", " ")), name);

  // The goal is dragged; what belongs to the place before is pale within two frames.
  await p.evaluate(() => {
    let moved = 0;
    window.pale_ms = null;
    addEventListener("pointermove", (e) => e.buttons && (moved ||= performance.now()), true);
    new MutationObserver(() => {
      if (moved && window.pale_ms === null && document.querySelector(".verdict.of-before") && document.querySelector(".profile.of-before")) window.pale_ms = performance.now() - moved;
    }).observe(document.body, { subtree: true, attributes: true, attributeFilter: ["class"] });
  });
  const g = await p.pixel(...(await p.inputValue("#plan-goal")).split(",").map(Number));
  asked.length = 0;
  const before = await p.inputValue("#plan-goal");
  await browser.startTracing(p, { categories: ["toplevel", "disabled-by-default-devtools.timeline", "devtools.timeline"] });
  await p.mouse.move(g.x, g.y);
  await p.mouse.down();
  for (let k = 1; k <= 60; ++k) {
    await p.mouse.move(g.x + k, g.y + k / 3);
    await pause(12);
    if (k === 30) await p.look("31_dragging");
  }
  assert.equal(await p.evaluate(() => document.querySelector("[data-on-map]")?.dataset.onMap ?? ""), "", "no verdict stands on the map as if it were this one's");
  await p.mouse.up();
  const { traceEvents: events } = JSON.parse((await browser.stopTracing()).toString());
  const named = events.filter((e) => e.name === "thread_name" && e.args.name === "CrRendererMain").map((e) => `${e.pid}/${e.tid}`);
  const scripts = events.filter((e) => e.ph === "X" && ["FunctionCall", "FireAnimationFrame", "EventDispatch", "TimerFire"].includes(e.name) && named.includes(`${e.pid}/${e.tid}`)).map((e) => (e.tdur ?? e.dur) / 1000).sort((a, b) => a - b);
  const q = (share) => scripts[Math.min(scripts.length - 1, Math.floor(share * scripts.length))];
  console.log(`dragging: ${scripts.length} pieces of script, median ${q(0.5).toFixed(1)} ms, 95 % ${q(0.95).toFixed(1)} ms, longest ${q(1).toFixed(1)} ms of the processor; pale after ${(await p.evaluate(() => window.pale_ms)).toFixed(0)} ms; ${asked.length} plans`);
  assert.ok(scripts.length > 60 && q(0.98) < 50, "frames of a drag take less than 50 ms of script");
  assert.ok((await p.evaluate(() => window.pale_ms)) < 400, "pale at once"); // by the clock of a machine that does other things too
  await settled(p);
  assert.ok(asked.length >= 2, "plans follow the drag");
  assertPaced(asked.map(({ at }) => at));
  assert.ok(sent.length >= asked.length - 2, "what nobody waits for any more is cancelled");
  const now = await p.inputValue("#plan-goal");
  assert.notEqual(now, before);
  await pause(400); // until the address has it
  const shown = await (await p.request.get(`${service.url}/v1/jobs/${new URLSearchParams(p.url().split("#")[1]).get("job")}/result`)).json();
  assert.equal(`${shown.request.goal.x_m.toFixed(2)}, ${shown.request.goal.y_m.toFixed(2)}`, now, "the answer is to where the goal is");
  assert.equal(await p.locator(".verdict.of-before").count(), 0);
  await p.look("32_after_the_drag");
  await p.locator(".map").focus();
  await p.keyboard.press("Control+z");
  await p.until((text) => document.querySelector("#plan-goal").value === text, before);
  await p.waitForSelector('.verdict.of-before[data-stale="all"]');
  await p.done();
});

test("1920, keyboard: places, cursor, why, limits; G stays G", async () => {
  const p = await page("wide", answered, { expected: /readback/ });
  await settled(p);
  await wellLaid(p, "wide");
  const empty = await mapPicture(p);
  await p.locator(".charts").focus();
  for (let k = 0; k < 3; ++k) await p.keyboard.press("Shift+ArrowRight");
  await p.until(() => /^\d+\.\d m: (level|nose|left|right)/.test(document.querySelector("[data-lean]")?.textContent ?? ""));
  await pause(200);
  assert.notEqual(await mapPicture(p), empty, "the rover stands on the map");
  await p.keyboard.press("y");
  await p.waitForSelector("[data-why]:visible");
  assert.match(await p.textContent("[data-why]"), /\d+ to \d+ m: .*(halt|embedded).*Slip .*tilt/);
  await p.look("33_rover_and_why");
  await p.keyboard.press("Escape");
  await p.until(() => !document.querySelector("[data-why]").offsetParent);

  // Limits recolour what is there, and ask for nothing.
  let asked = 0;
  p.on("request", (r) => r.method() === "POST" && ++asked);
  const job = new URLSearchParams(p.url().split("#")[1]).get("job");
  const { stations } = (await (await p.request.get(`${service.url}/v1/jobs/${job}/result`)).json()).routes.features[0].properties;
  const middle = Math.floor(stations.count / 2);
  const half_way = await p.pixel(stations.x_m[middle], stations.y_m[middle]);
  const some = "#fdae61"; // of the 95 % quantile of the sinkage alone the answer says no more
  assert.ok(!(await mapColours(p, half_way)).includes(some));
  await p.click("[data-limits] summary");
  await p.locator('[data-limit="max_sinkage_m"]').focus();
  await p.keyboard.press("Home");
  await p.waitForSelector('.chip[aria-pressed="true"]:text-is("limits")');
  await p.waitForSelector('.verdict.of-before[data-stale="limits"]');
  await p.until(() => document.querySelector(".legend")?.parentElement && [...document.querySelectorAll(".legend li")].some((li) => li.textContent.includes("95 % or more")));
  await pause(200);
  assert.ok((await mapColours(p, half_way)).includes(some), "the route has the colour of the moved limit");
  await p.look("34_limits");
  await p.accessible("limits");
  assert.equal(asked, 0, "no plan for a limit that is moved");
  await p.click('[data-do="limits-as-asked"]');
  await p.until(() => !document.querySelector(".verdict.of-before"));

  // By keyboard alone: G twice is still G, Enter puts the goal at the map's centre and plans.
  await p.locator(".map").focus();
  await p.keyboard.press("g");
  await p.keyboard.press("g");
  assert.equal(await p.getAttribute('[data-tool="goal"]', "aria-pressed"), "true");
  const [request] = await Promise.all([p.waitForRequest((r) => r.method() === "POST" && r.url().endsWith("/v1/plans")), p.keyboard.press("Enter")]);
  assert.ok(Math.abs(request.postDataJSON().goal.x_m - goal.x_m) < 60);
  await p.waitForSelector(".verdict.of-before");

  // The effects have a sentence each, places may be degrees, and nothing is a raw name.
  await p.click("text=Effects and failed wheels");
  const effects = (await (await p.request.get(`${service.url}/v1/effects`)).json()).effects;
  await p.waitForSelector("#panel-plan .effect .hint");
  const sentences = await p.locator("#panel-plan .effect .hint").allTextContents();
  assert.equal(sentences.length, effects.length);
  assert.ok(effects.length >= 23 && sentences.every((text) => /^[A-Z].{20,}\.$/.test(text)), sentences.join("\n"));
  await p.click("text=What a route costs");
  await p.plain("effects and costs");
  await p.fill("#plan-start", "137.37000 E, 4.66830 S");
  await p.keyboard.press("Tab");
  await p.until(() => document.querySelector('[data-degrees="plan-start"]').textContent.startsWith("137.37000° E, 4.66830° S"));
  await p.done();
});

test("1280, mouse: the time of day is dragged and the shadows move; a drive is planned for the sol on the map", async () => {
  const at = "2016-03-22T07:00:00.000Z";
  const p = await page("laptop", `${ground}&${placed}&at=${at}&sun=shadow&layers=slope:0,soil:0,unknown:0`, { expected: /readback/ });
  const shadow = () => p.evaluate(() => document.querySelector(".map").dataset.shadow ?? "");
  await p.waitForSelector(".map[data-shadow]");
  const sky = async (place, time) => (await (await p.request.get(`${service.url}/v1/terrains/gale/sky?place=${place}&from=${time}&to=${time}`)).json()).moments[0];
  const now = await sky(`${start.x_m},${start.y_m}`, at);
  const [azimuth, elevation] = (await shadow()).split(",").map(Number);
  assert.ok(Math.abs(azimuth - now.sun.azimuth_deg) < 0.1 && Math.abs(elevation - now.sun.elevation_deg) < 0.1, `${azimuth}, ${elevation}`);
  const clock = async () => (([hours, minutes]) => 60 * hours + minutes)((await p.textContent("[data-clock]")).split(":").map(Number));
  assert.ok(Math.abs((await clock()) - 60 * now.true_solar_h) <= 1, "local true solar time");

  // Ground behind a rise is dark, and the start is not: as the service has it, and with the picture off both are as they were.
  const dark = [8142546, -276483];
  assert.equal((await sky(dark, at)).lit, false);
  assert.equal(now.lit, true);
  const colours = async () => Promise.all([dark, [start.x_m + 6, start.y_m + 6]].map(async (place) => (await mapColours(p, await p.pixel(...place))).join()));
  await pause(200);
  const shaded = await colours();
  await p.look("42_shadow");
  await p.click('[data-shows=""]');
  await pause(200);
  const plain = await colours();
  assert.notEqual(plain[0], shaded[0]);
  assert.equal(plain[1], shaded[1]);
  await p.click('[data-shows="shadow"]');

  // The knob is dragged to the afternoon, then moved by a key.
  const asked = [];
  p.on("request", (r) => r.url().includes("shadow.png") && asked.push(performance.now()));
  const morning = await clock();
  const slider = await p.locator("[data-day]").boundingBox();
  const knob = slider.x + 8 + ((slider.width - 16) * morning) / 1440;
  await p.mouse.move(knob, slider.y + slider.height / 2);
  await p.mouse.down();
  for (let k = 1; k <= 20; ++k) await p.mouse.move(knob + (k * slider.width) / 50, slider.y + slider.height / 2).then(() => pause(20));
  await p.mouse.up();
  const dragged = await clock();
  assert.ok(dragged > morning + 480, `from ${morning} to ${dragged} min`);
  await p.until(([from]) => Math.abs(Number(document.querySelector(".map").dataset.shadow.split(",")[0]) - from) > 90, [azimuth]);
  assertPaced(asked);
  await p.keyboard.press("ArrowRight");
  assert.ok([4, 5, 6].includes((await clock()) - dragged));
  await p.until((text) => location.hash.includes("sun=shadow") && location.hash.includes("at=2016-03-22T") && !location.hash.includes(text), encodeURIComponent(at));

  // The share of the sol's daylight has the colours of its legend.
  await p.click('[data-shows="share"]');
  await p.until(() => document.querySelector(".map").dataset.shadow.includes(";"));
  const strip = `v1/terrains/gale/shadow.png?bounds=8142500,-276600,8142600,-276599&sun=`;
  const ends = await p.evaluate(async (addresses) => {
    const canvas = document.createElement("canvas").getContext("2d");
    return Promise.all(addresses.map(async (address) => {
      const image = await createImageBitmap(await (await fetch(address)).blob());
      canvas.clearRect(0, 0, 10, 10);
      canvas.drawImage(image, 0, 0);
      return [...canvas.getImageData(2, 0, 1, 1).data].slice(0, 3);
    }));
  }, ["0,-1;0,-2", "0,89;0,89"].map((suns) => `${service.url}/${strip}${suns}`));
  const legend = await p.$$eval(".day .swatch", (list) => list.map((s) => getComputedStyle(s).backgroundColor.match(/\d+/g).map(Number)));
  for (const [end, entry] of [[ends[0], legend[0]], [ends[1], legend.at(-1)]]) assert.ok(end.every((v, i) => Math.abs(v - entry[i]) <= 2), `${end} is drawn, ${entry} in the legend`);
  await p.look("43_sunlit_share");
  await p.accessible("time of day");

  // A plan for this sol: what is left empty is not asked; the answer's windows, its best departure, its charge.
  await p.click("#panel-plan [data-departure] summary");
  await p.click('#panel-plan [data-do="this-sol"]');
  for (const [key, value] of [["charge_percent", "60"], ["min_charge_percent", "40"], ["min_sun_deg", "10"]]) await p.fill(`#plan-${key}`, value);
  const [request] = await Promise.all([p.waitForRequest((r) => r.method() === "POST" && r.url().endsWith("/v1/plans")), p.click('[data-do="plan"]')]);
  const { from, to, ...rules } = request.postDataJSON().departure;
  assert.deepEqual(rules, { charge_percent: 60, min_charge_percent: 40, min_sun_deg: 10 });
  assert.ok(Math.abs(Date.parse(to) - Date.parse(from) - 88_775_000) < 180_000, `a sol from ${from} to ${to}`);
  await settled(p);
  await pause(300);
  const job = new URLSearchParams(p.url().split("#")[1]).get("job");
  const { departures } = (await (await p.request.get(`${service.url}/v1/jobs/${job}/result`)).json()).routes.features[0].properties.decision;
  assert.ok(departures.windows.length > 0);
  assert.equal(await p.locator(".windows li").count(), departures.windows.length);
  assert.equal(await p.locator(".strip-window").count(), departures.windows.length);
  assert.equal(await p.getAttribute("[data-departs]", "data-departs"), departures.best.departs);
  await p.plain("windows");
  await p.click('[data-do="show-departure"]');
  await p.until((text) => document.querySelector(".day-told").textContent.includes(text), departures.best.departs.slice(11, 16));
  await p.locator(".charts").focus();
  await p.keyboard.press("Shift+ArrowRight");
  await p.until(() => /\d\d:\d\d UTC/.test(document.querySelector("[data-lean]")?.textContent ?? ""));
  assert.match(await p.textContent('.chart-box[aria-label^="Battery"] .readout'), /^(59|60)(\.\d)? \/ (59|60)(\.\d)? at /);
  await p.look("44_windows");
  await p.done();
});

test("390, finger: an example is a GO, a stretch says why, a goal is dragged", async () => {
  const p = await page("phone", "terrain=gale&routes=1");
  await p.waitForSelector(".terrain select");
  await wellLaid(p, "phone");
  await p.look("35_phone_empty");
  await p.locator('[data-example^="A short drive"]').tap();
  assert.equal(await p.verdict(), "go");
  await settledAtTop(p);
  await wellLaid(p, "phone");
  await p.look("36_phone_go");
  await p.accessible("phone");
  await p.plain("phone");
  const on_route = await p.pixel(example.start.x_m, (example.start.y_m + example.goal.y_m) / 2);
  await p.touchscreen.tap(on_route.x, on_route.y);
  await p.waitForSelector("[data-why]:visible");
  await p.look("37_phone_why");
  await p.locator('[data-why] [aria-label="Close"]').tap();

  const finger = await p.context().newCDPSession(p);
  const touch = (type, at) => finger.send("Input.dispatchTouchEvent", { type, touchPoints: at ? [at] : [] });
  const g = await p.pixel(example.goal.x_m, example.goal.y_m);
  const [request] = await Promise.all([
    p.waitForRequest((r) => r.method() === "POST" && r.url().endsWith("/v1/plans")),
    (async () => {
      await touch("touchStart", g);
      for (let k = 1; k <= 10; ++k) await touch("touchMove", { x: g.x + 3 * k, y: g.y + k }).then(() => pause(20));
      await touch("touchEnd");
    })(),
  ]);
  assert.ok(request.postDataJSON().goal.x_m > example.goal.x_m);
  assert.equal(await p.evaluate(() => window.scrollY), 0, "the finger drags the goal, not the page");
  await p.waitForSelector(".verdict.of-before");
  await p.look("38_phone_dragged");
  await p.done();
});

test("820, finger: a path is checked, and a terrain with polygons is added", async (t) => {
  const p = await page("tablet", "terrain=gale&tab=check");
  await p.waitForSelector(".terrain select");
  await p.locator('[data-example^="A path onto"]').tap();
  assert.equal(await p.verdict(), "no_go");
  await settledAtTop(p);
  await wellLaid(p, "tablet");
  await p.look("39_tablet_no_go");
  await p.plain("a check");
  await p.fill("#panel-check textarea >> nth=0", "8142448,-276684\n8142455,-276684");
  await p.keyboard.press("Tab");
  await p.waitForSelector('.verdict.of-before[data-stale="all"]');

  const folder = mkdtempSync(join(tmpdir(), "slipway-polygons-"));
  t.after(() => rmSync(folder, { recursive: true, force: true }));
  const from = `${process.env.SLIPWAY_SOURCE}/data/terrains/lunar_south_pole_synthetic`;
  const units = JSON.parse(readFileSync(join(from, "soil_units.geojson"), "utf8"));
  const labels = [...new Set(units.features.map((f) => f.properties.unit))];
  for (const feature of units.features) feature.properties = { made_of: feature.properties.unit };
  writeFileSync(join(folder, "units.geojson"), JSON.stringify(units));
  writeFileSync(join(folder, "legend.csv"), `value,label,soil\n${labels.map((label, k) => `${k},${label},ding_2011`).join("\n")}\n`);
  await p.locator('[data-do="add-terrain"]').tap();
  await p.fill('[data-upload="name"]', "polygons");
  await p.setInputFiles('[data-upload="elevation"]', join(from, "elevation.tif"));
  await p.setInputFiles('[data-upload="soil"]', join(folder, "units.geojson"));
  await p.setInputFiles('[data-upload="legend"]', join(folder, "legend.csv"));
  await p.fill('[data-upload="property"]', "made_of");
  await p.selectOption('dialog[open] select', "map");
  await p.look("40_tablet_terrain");
  await p.accessible("a terrain with polygons");
  await p.locator('dialog[open] button:text-is("Send")').tap();
  await p.until(() => document.querySelector(".terrain select").value === "polygons");
  const made = (await (await p.request.get(`${service.url}/v1/terrains/polygons`)).json()).terrain.soil;
  assert.equal(made.source, "polygons");
  assert.deepEqual(made.legend.map((entry) => entry.label).sort(), labels.sort());
  await p.until(() => location.hash.includes("terrain=polygons"));
  await pause(500);
  await p.look("41_tablet_own_ground");
  // Its places are degrees of its own body too.
  const map = await box(p, ".map");
  await p.locator("#tab-plan").tap();
  await p.touchscreen.tap(map.x + map.width / 2, map.y + map.height / 2);
  await p.until(() => /° [EW], .*° [NS]$/.test(document.querySelector('[data-degrees="plan-start"]')?.textContent ?? ""));
  await p.done();
});
