// What an operator does, in a real browser against a running service.
import assert from "node:assert/strict";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { launch, open, until } from "./page.mjs";
import { proxy, serve, tokens } from "./service.mjs";

const start = { x_m: 8142640.0, y_m: -276640.0 };
const goal = { x_m: 8142675.0, y_m: -276650.0 };
const at = (place) => `${place.x_m},${place.y_m}`;
const planned = `start=${at(start)}&goal=${at(goal)}&routes=2`;
const slopes = "8142579.7,-276648.7\n8142578,-276680";
let service;
let browser;

before(async () => {
  browser = await launch();
  service = await serve();
});
after(async () => {
  await browser?.close();
  await service?.stop();
});

const page = (hash = "", options = {}) => open(browser, `${service.url}/dashboard/#terrain=gale&${hash}`, options);
const pause = (ms) => new Promise((resolve) => setTimeout(resolve, ms));
/** Pictures of the map differ where something was drawn on it. */
const mapPicture = async (p) => (await p.locator(".map").screenshot()).toString("base64");
const readouts = (p) => p.locator(".readout").allTextContents();

test("a drive is placed by clicks, planned, understood and cut off from a slope", async () => {
  const p = await page();
  await p.waitForSelector(".map canvas");
  await p.until(() => document.querySelector("#plan-hint")?.textContent.includes("start and a goal"));
  await p.look("01_empty");
  await p.accessible("empty");

  // Nobody has to press a button first: the next click is what the plan lacks.
  assert.equal(await p.getAttribute('[data-tool="start"]', "aria-pressed"), "true");
  assert.equal(await p.textContent(".map-aim"), "Click where the drive starts");
  assert.equal(await p.locator('header button:text-is("Sign in")').isVisible(), false, "a service without tokens asks nobody to sign in");
  const beyond = await p.pixel(8142400, -276700);
  await p.mouse.click(beyond.x, beyond.y);
  await p.until(() => document.querySelector(".map-readout").textContent === "beyond the map");
  assert.equal(await p.inputValue("#plan-start"), "", "nothing is placed beyond the map");
  await pause(320); // two clicks that follow fast are a double click
  const from = await p.pixel(start.x_m, start.y_m);
  await p.mouse.click(from.x, from.y);
  await p.until(() => document.querySelector("#plan-start").value !== "");
  const [x, y] = (await p.inputValue("#plan-start")).split(",").map(Number);
  assert.ok(Math.hypot(x - start.x_m, y - start.y_m) < 2, "the click is where the map says");
  assert.equal(await p.getAttribute('[data-tool="goal"]', "aria-pressed"), "true", "the goal is next");
  await p.keyboard.press("Escape");
  await p.fill("#plan-start", at(start));
  await p.fill("#plan-goal", at(goal));
  await p.keyboard.press("Tab");
  await p.click("text=What a route costs");
  await p.fill(".weights input >> nth=0", "2");
  await p.keyboard.press("Tab");
  await p.click("text=What a route costs");
  await p.click("text=The request as a command");
  const curl = await p.textContent("[data-curl]");
  assert.match(curl, /v1\/plans .*"routes":2/);
  assert.deepEqual(JSON.parse(/-d '(.*)'$/.exec(curl)[1]).goal, goal);
  await p.click("text=The request as a command");

  await p.evaluate(() => {
    window.stages = new Set();
    window.shares = new Set();
    new MutationObserver(() => {
      const stage = document.querySelector(".work [data-stage]")?.textContent;
      const share = document.querySelector(".work progress")?.value;
      if (stage) window.stages.add(stage);
      if (share !== undefined) window.shares.add(share);
    }).observe(document.querySelector(".work"), { subtree: true, childList: true });
  });
  await p.click('[data-do="plan"]');
  await p.waitForSelector(".work progress");
  await p.look("02_progress");
  const verdict = await p.verdict();
  assert.ok((await p.evaluate(() => window.stages.size)) >= 2, "stages were shown");
  assert.ok((await p.evaluate(() => window.shares.size)) >= 2, "the progress moved");
  assert.ok(["go", "no_go", "unknown"].includes(verdict));
  assert.ok((await p.locator(".reasons li").count()) > 0, "the verdict has reasons");
  assert.ok((await p.locator(".chart canvas").count()) >= 5);
  await pause(600);
  await p.look("03_routes");
  await p.accessible("routes");

  // From a chart to the map, and from the map to the charts.
  await p.mouse.move(700, 20);
  await pause(300);
  const untouched = await mapPicture(p);
  const chart = await p.locator(".u-over").first().boundingBox();
  await p.mouse.move(chart.x + chart.width / 2, chart.y + chart.height / 2);
  await p.until(() => [...document.querySelectorAll(".readout")].every((r) => / m$/.test(r.textContent)));
  const places = new Set((await readouts(p)).map((text) => / at (.*)$/.exec(text)[1]));
  assert.equal(places.size, 1, "all charts are at one place");
  assert.notEqual(await mapPicture(p), untouched, "the map shows the place");
  const answer = await (await p.request.get(`${service.url}/v1/jobs/${new URLSearchParams(p.url().split("#")[1]).get("job")}/result`)).json();
  const stations = answer.routes.features[0].properties.stations;
  const k = Math.floor(stations.count / 3);
  const onRoute = await p.pixel(stations.x_m[k], stations.y_m[k]);
  await p.mouse.move(onRoute.x, onRoute.y);
  await p.mouse.move(onRoute.x + 1, onRoute.y);
  await p.until(() => / m$/.test(document.querySelector(".readout").textContent));
  const told = Number(/ at ([\d.]+) m/.exec((await readouts(p))[0])[1]);
  assert.ok(Math.abs(told - stations.distance_m[k]) < 4, `the charts are at ${told} m, the pointer at ${stations.distance_m[k]} m`);
  await p.mouse.move(700, 20);

  // A second route beside the first, and the colours of slip with the slopes below.
  if ((await p.locator(".compare input").count()) > 0) {
    await p.check(".compare input >> nth=0");
    await p.waitForSelector("td small");
  }
  await p.click('.chip:text-is("slip")');
  await p.check("#layer-slope");
  await pause(600);
  await p.look("04_slip_and_slope");
  await p.click('.chip:text-is("risk")');
  await p.uncheck("#layer-slope");

  // A zone across the way, drawn by mouse.
  const middle = { x: (start.x_m + goal.x_m) / 2, y: (start.y_m + goal.y_m) / 2 };
  await p.click('[data-tool="keep_out"]:visible');
  const corners = [[-6, -5], [6, -5], [6, 5], [-6, 5]].map(([dx, dy]) => [middle.x + dx, middle.y + dy]);
  for (const [cx, cy] of corners.slice(0, 3)) {
    const c = await p.pixel(cx, cy);
    await p.mouse.click(c.x, c.y);
    await pause(320);
  }
  const last = await p.pixel(...corners[3]);
  await p.mouse.dblclick(last.x, last.y);
  await p.waitForSelector("text=keep out 1, 4 corners");
  await p.click('[data-do="plan"]');
  await p.until((old) => !location.hash.includes(old) && document.querySelector("[data-verdict]") && !document.querySelector(".work progress") , new URLSearchParams(p.url().split("#")[1]).get("job"));
  await p.until(() => !document.querySelector(".work .job"));
  await pause(500);
  await p.look("05_keep_out");
  const around = await (await p.request.get(`${service.url}/v1/jobs/${new URLSearchParams(p.url().split("#")[1]).get("job")}/result`)).json();
  assert.equal(around.request.keep_out.length, 1);
  for (const { properties } of around.routes.features)
    properties.stations.x_m.forEach((sx, i) => assert.ok(Math.abs(sx - middle.x) > 5 || Math.abs(properties.stations.y_m[i] - middle.y) > 4, "no route enters the zone"));
  await p.keyboard.press("Escape");
  await p.locator(".map").focus();
  await p.keyboard.press("Control+z");
  await p.waitForSelector("text=keep out 1, 4 corners", { state: "detached" });

  // A link to it shows it again.
  const link = p.url();
  await p.goto("about:blank");
  await p.goto(link);
  await p.verdict();
  assert.equal(await p.inputValue("#plan-goal"), `${goal.x_m.toFixed(2)}, ${goal.y_m.toFixed(2)}`);
  await p.done();
});

test("a path is checked and found NO-GO, with the rules and where", async () => {
  const p = await page("tab=check");
  await p.fill("#panel-check textarea >> nth=0", "8142579.7,-276648.7\nno place");
  await p.click('[data-do="check"]');
  await p.waitForSelector('.problem:has-text("Line 2 has no place")');
  await p.fill("#panel-check textarea >> nth=0", slopes);
  await p.click('[data-do="check"]');
  assert.equal(await p.verdict(), "no_go");
  assert.match(await p.textContent(".banner"), /^NO-GOPath, MSL classHalts in \d+ % of the draws \(\d+ % to \d+ %\)$/);
  assert.ok((await p.locator('[data-reasons="no_go"] .badge.no_go').count()) > 0, "what says no-go is marked so");
  assert.ok((await p.locator("tr.trips").count()) > 0);
  await p.locator('tr.trips button:text("m")').first().click();
  await p.until(() => / m$/.test(document.querySelector(".readout").textContent));
  await p.click('header button:text-is("Dark")');
  await pause(500);
  await p.look("06_check_no_go_dark");
  await p.accessible("check, dark");
  await p.click('header button:text-is("Light")');

  // Another way is a GO.
  await p.fill("#panel-check textarea >> nth=0", "8142579.7,-276648.7\n8142585,-276646");
  await p.click('[data-do="check"]');
  await p.waitForSelector('[data-verdict="go"]');
  await pause(400);
  await p.look("14_go");

  // One that starts on unknown ground can't become one by another way.
  await p.fill("#panel-check textarea >> nth=0", "8142582,-276581\n8142588,-276585");
  await p.click('[data-do="check"]');
  await p.waitForSelector('.reasons li:has-text("unmapped ground")');
  assert.notEqual(await p.verdict(), "go");

  // Commands, and a drive under way.
  await p.fill("#panel-check textarea >> nth=0", "drive=4 turn=30 drive=3");
  await p.fill("#check-start", "8142579.7,-276648.7");
  await p.click('[data-do="check"]');
  await p.click('#panel-check summary:has-text("The request as a command")');
  await p.until(() => document.querySelector("#panel-check pre")?.textContent.includes('"turn_deg":30'));
  await p.waitForSelector(".work .job", { state: "detached" });
  await p.click("text=A drive under way");
  await p.fill("#panel-check textarea >> nth=0", "8142600,-276645");
  await p.fill("#panel-check textarea >> nth=1", "driven_m,x_m,y_m,current_a\n0,8142640,-276640,\n2.4,8142638,-276640.3,6.1\n5,8142636,-276640.5,6.8\n");
  await p.click('[data-do="check"]');
  await p.waitForSelector('.driven:has-text("measured against predicted")');
  await pause(400);
  await p.look("07_driven_so_far");
  await p.done();
});

test("work is cancelled, listed and opened again", async () => {
  const p = await page(planned.replace("routes=2", "routes=8"));
  await p.until(() => document.querySelector('[data-do="plan"]')?.disabled === false && document.querySelector(".terrain select"));
  await p.click('[data-do="plan"]');
  await p.click('[data-do="cancel"]');
  await p.waitForSelector('.work .job.dismissed:has-text("cancelled")');
  await p.click("#tab-jobs");
  await p.waitForSelector(".jobs .badge.dismissed");
  await p.look("08_jobs");
  await p.accessible("jobs");
  await p.click('.jobs .job.successful [data-do="open"] >> nth=0');
  await p.verdict();
  await p.click("#tab-drives");
  await p.waitForSelector('[data-do="diagnose"]');
  await p.click('[data-do="diagnose"]');
  await p.waitForSelector('.work:has-text("diagnosis") progress');
  await p.look("09_drives");
  await p.accessible("drives");
  await p.click('[data-do="cancel"]');
  await p.waitForSelector(".work .job.dismissed");
  await p.done();
});

test("the sky that a request brought stays in the form and is sent again as it is", async () => {
  const sky = [0, 6, 12, 18].map((hour) => ({ at: new Date(Date.UTC(2027, 0, 10, hour)).toISOString(), sun_azimuth_deg: 3 * hour, sun_elevation_deg: 4.25, sun_distance_au: 0.9834 }));
  const asked = { terrain: "lunar_south_pole_synthetic", rover: "mer-class", start: { x_m: 8500, y_m: 12500 }, goal: { x_m: 8520, y_m: 12510 }, routes: 1, draws: 32, departure: { from: sky[0].at, to: sky[1].at, min_sun_deg: 1, sky } };
  const { id } = await (await fetch(`${service.url}/v1/plans`, { method: "POST", headers: { "Content-Type": "application/json" }, body: JSON.stringify(asked) })).json();
  const p = await open(browser, `${service.url}/dashboard/#terrain=${asked.terrain}&rover=${asked.rover}&job=${id}`);
  await p.verdict();
  await p.click("#panel-plan [data-departure] summary");
  assert.match(await p.textContent("[data-sky-table]"), /^Sun and Earth come from the table of the request that was opened, which is sent again as it is\. $/);
  await p.fill("#plan-min_sun_deg", "2");
  const [request] = await Promise.all([p.waitForRequest((r) => r.method() === "POST" && r.url().endsWith("/v1/plans")), p.click('[data-do="plan"]')]);
  const { departure } = request.postDataJSON();
  assert.equal(departure.min_sun_deg, 2);
  assert.deepEqual(departure.sky, sky);
  await p.verdict();
  await p.done();
});

test("a map of one's own is sent", async (t) => {
  const folder = mkdtempSync(join(tmpdir(), "slipway-sent-"));
  t.after(() => rmSync(folder, { recursive: true, force: true }));
  const data = `${process.env.SLIPWAY_SOURCE}/data`;
  writeFileSync(join(folder, "no map.tif"), "this is no map");
  const p = await page(planned);
  await p.waitForSelector('[data-do="add-terrain"]');

  await p.click('[data-do="add-terrain"]');
  await p.fill('[data-upload="name"]', "own");
  await p.setInputFiles('[data-upload="elevation"]', join(folder, "no map.tif"));
  await p.accessible("a terrain of one's own");
  await p.click('dialog[open] button:text-is("Send")');
  await p.waitForSelector(".work .problem");
  await p.look("16_no_map");
  await p.click('[data-do="add-terrain"]');
  await p.setInputFiles('[data-upload="elevation"]', `${data}/terrains/gale/elevation.tif`);
  await p.click('dialog[open] button:text-is("Send")');
  await p.until(() => document.querySelector(".terrain select").value === "own");
  await p.until(() => location.hash.includes("terrain=own"));
  const placed = `${start.x_m.toFixed(2)}, ${start.y_m.toFixed(2)}`;
  assert.equal(await p.inputValue("#plan-start"), placed, "the same ground keeps what was placed on it");
  // On other ground it would lie beyond the map; undo brings it back.
  await p.selectOption(".terrain select", "ames_yard");
  await p.waitForSelector("[data-no-soils]");
  await p.until(() => document.querySelector("#plan-start").value === "");
  assert.equal(await p.textContent(".map-aim"), "Click where the drive starts");
  await p.locator(".map").focus();
  await p.keyboard.press("Control+z");
  await p.until((text) => document.querySelector("#plan-start").value === text, placed);
  await p.done();
});

test("what the service refuses is shown with every fault, and a service that is gone is said so", async (t) => {
  const own = await serve();
  t.after(() => own.stop());
  const p = await open(browser, `${own.url}/dashboard/#terrain=gale&start=1,2&goal=3,4`, { expected: /Failed to load resource|ERR_/ });
  await p.until(() => document.querySelector(".terrain select"));
  await p.click('[data-do="plan"]');
  await p.waitForSelector(".work .problem");
  for (const place of ["Start", "Goal"]) assert.ok((await p.textContent(".work .problem")).includes(place), place);
  await p.look("10_faults");
  await p.accessible("faults");
  await own.stop();
  await p.click('[data-do="plan"]');
  await p.waitForSelector('.work .problem:has-text("can\'t be reached")');
  await p.evaluate(() => window.dispatchEvent(new Event("offline")));
  await p.waitForSelector('.note .problem:has-text("No network")');
  await p.look("11_gone");
  await p.done();
});

test("a service with tokens is signed in to, under a proxy's path", async (t) => {
  const { file, token } = tokens();
  const own = await serve("--tokens", file);
  t.after(() => own.stop());
  const before = await proxy(own.port, "/rover/slipway");
  t.after(() => before.stop());
  const p = await open(browser, `${before.url}/dashboard/#terrain=gale`, { expected: /401/ });
  await p.waitForSelector("dialog[open]");
  await p.look("12_sign_in");
  await p.accessible("sign in");
  await p.fill("dialog[open] input", "0123");
  await p.keyboard.press("Enter");
  await p.waitForSelector('.note .problem:has-text("401")');
  await p.waitForSelector("dialog[open]");
  await p.fill("dialog[open] input", token);
  const tile = p.waitForResponse((r) => r.url().includes("/tiles/hillshade/") && r.status() === 200);
  await p.keyboard.press("Enter");
  await tile;
  await p.waitForSelector(".terrain select");
  assert.equal(await p.evaluate(() => Object.values(localStorage).join()), "", "the token is not kept beyond the tab");
  assert.ok(before.paths.every((path) => path.startsWith("/rover/slipway/")), before.paths.join());
  await p.done();
});

const metresOf = (text) => {
  const [value, unit] = text.split(" ");
  return Number(value) * { cm: 0.01, m: 1, km: 1000 }[unit];
};
for (const [body, radius_m] of [["Mars", 3396190], ["Moon", 1737400]]) {
  test(`the scale bar is true on ${body}`, async () => {
    const context = await browser.newContext({ viewport: { width: 1440, height: 1000 } });
    const p = await context.newPage();
    // The same ground, on another sphere.
    await p.route(/\/v1\/terrains(\/gale)?$/, async (route) => {
      const answer = await route.fetch();
      await route.fulfill({ response: answer, body: (await answer.text()).replaceAll("3396190", String(radius_m)).replaceAll('"body":"Mars"', `"body":"${body}"`) });
    });
    await p.goto(`${service.url}/dashboard/#terrain=gale`);
    await until(p, () => location.hash.includes("view=") && document.querySelector(".scale-bar-inner")?.textContent);
    const [, y, resolution] = new URLSearchParams(p.url().split("#")[1]).get("view").split(",").map(Number);
    const bar = p.locator(".scale-bar-inner");
    const told_m = metresOf(await bar.textContent());
    const width_px = await bar.evaluate((element) => parseFloat(element.style.width));
    // Equidistant cylindrical: true to the north, narrower to the east by the cosine of the latitude.
    const latitude = y / radius_m;
    const true_m = width_px * resolution * ((1 + Math.cos(latitude)) / 2);
    assert.ok(Math.abs(told_m / true_m - 1) < 0.01, `${told_m} m on the bar, ${true_m} m on the ground`);
    await p.screenshot({ path: `${process.env.SCREENSHOTS ?? "screenshots"}/13_scale_${body}.png` });
    // From all of the ground to a wheel's width: a round length each time, and a metre is "1 m".
    await p.locator(".map").focus();
    for (let zoom = 0; zoom < 8 && body === "Mars"; ++zoom) {
      const text = await bar.textContent();
      assert.match(text, /^(1|2|5)0* (cm|m|km)$/);
      const px = parseFloat(await bar.evaluate((element) => element.style.width));
      assert.ok(px > 55 && px <= 150, `${text} is ${px} px wide`);
      await p.keyboard.press("+");
      await pause(350); // the map glides there
    }
    if (body === "Mars") assert.equal(await bar.textContent(), "1 m");
    await context.close();
  });
}
