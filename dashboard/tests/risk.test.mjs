// Maps of risk, work that is followed by events, what is taken along, and how a stranger gets a GO.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { after, before, test } from "node:test";
import { launch, open } from "./page.mjs";
import { proxy, serve } from "./service.mjs";

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
const mapColour = (p, { x, y }) =>
  p.evaluate(([px, py]) => {
    const seen = [];
    for (const canvas of document.querySelectorAll(".map canvas")) {
      const box = canvas.getBoundingClientRect();
      const [r, g, b, a] = canvas.getContext("2d").getImageData(((px - box.x) * canvas.width) / box.width, ((py - box.y) * canvas.height) / box.height, 1, 1).data;
      if (a > 0) seen.push([r, g, b]);
    }
    return seen;
  }, [x, y]);

test("slip and verdict are layers over the ground, and the unknown never looks safe", async () => {
  // What is read back from the canvas here is the test's own doing.
  const p = await page("start=8142640,-276640&goal=8142675,-276650&layers=slope:0,soil:0,unknown:0", { expected: /readback/ });
  await p.waitForSelector(".map canvas");
  await p.click("[data-risks] summary");
  await p.check('[data-risk="slip_worst"]');
  await p.waitForSelector('[data-risk-legend="slip_worst"]:has-text("unknown ground")');
  await pause(500);
  await p.fill('[aria-label="Opacity of slip, worst heading"]', "1");
  await pause(500);
  await p.look("23_slip_map");
  await p.accessible("risk layers");
  // Mapped ground has the colour of a class; unknown ground is black and white, whatever lies around it.
  const palette = ["#2c7bb6", "#abd9e9", "#fdae61", "#d7191c", "#67001f"];
  const hex = ([r, g, b]) => `#${[r, g, b].map((v) => v.toString(16).padStart(2, "0")).join("")}`;
  const known = await p.pixel(8142580.5, -276620.5);
  assert.ok((await mapColour(p, known)).some((c) => palette.includes(hex(c))), "a class' colour on mapped ground");
  for (const [x, y] of [[8142450.5, -276500.5], [8142600.5, -276520.5]]) {
    const at = await p.pixel(x, y);
    for (const shift of [0, 3, 6]) for (const [r, g, b] of await mapColour(p, { x: at.x + shift, y: at.y })) assert.ok(Math.abs(r - g) < 12 && Math.abs(g - b) < 12, `unknown ground has the colour ${hex([r, g, b])}`);
    await p.mouse.move(at.x, at.y);
    await p.waitForSelector('.map-readout:has-text("slip, worst heading: unknown")');
  }
  await p.mouse.move(known.x, known.y);
  await p.until(() => /slip, worst heading: 0\.\d/.test(document.querySelector(".map-readout").textContent));

  // Classes and colours are the reader's; the swipe shows the layer on one side alone.
  await p.click("text=Colours and classes");
  await p.selectOption("#palette", "cividis");
  await p.until(() => getComputedStyle(document.querySelector('[data-risk-legend="slip_worst"] .swatch')).backgroundColor === "rgb(254, 232, 56)");
  await p.fill('[data-bound="slip-0"]', "0.05");
  await p.keyboard.press("Tab");
  await p.waitForSelector('[data-risk-legend="slip_worst"]:has-text("below 0.05")');
  await p.fill('[aria-label^="Swipe"]', "0.3");
  await pause(500);
  const right = await p.pixel(8142700.5, -276700.5);
  assert.ok(!(await mapColour(p, right)).some((c) => ["#fee838", "#bcae6c", "#7d7c78", "#414d6b", "#00224e"].includes(hex(c))), "nothing to the right of the swipe");
  await p.look("24_swipe_cividis");
  await p.fill('[aria-label^="Swipe"]', "1");
  const tiff = p.waitForEvent("download");
  await p.click('[data-geotiff="slip_worst"]');
  assert.equal(readFileSync(await (await tiff).path()).subarray(0, 4).toString("latin1"), "II*\0");

  // The plan's own rules: what the form has is what the map is of; a map of before says so.
  await p.uncheck('[data-risk="slip_worst"]');
  await p.selectOption("#plan-rules", "slip_70");
  const [asked] = await Promise.all([p.waitForRequest((r) => r.method() === "POST" && r.url().endsWith("/v1/maps")), p.check('[data-risk="verdict"]')]);
  assert.equal(asked.postDataJSON().limits.max_slip, 0.7);
  await p.waitForSelector('[data-risk-legend="verdict"]:has-text("UNKNOWN")');
  await p.selectOption("#plan-rules", "every_5_m");
  await p.waitForSelector('[aria-label="Make verdict anew"]');
  await p.check('[data-risk="reachable"]');
  await p.waitForSelector('[data-risk-legend="reachable"]:has-text("only by a way over unknown ground")');
  await pause(500);
  await p.look("25_verdict_and_reach");
  // A link shows them again.
  await p.until(() => location.hash.includes("risk=verdict"));
  const link = p.url();
  await p.goto("about:blank");
  await p.goto(link);
  await p.waitForSelector('[data-risk-legend="reachable"]');
  await p.done();
});

/** Requests that the page makes of the API. */
const counted = (p) => {
  const asked = [];
  p.on("request", (r) => r.url().includes("/v1/") && !r.url().includes("/tiles/") && asked.push(r.url().replace(/.*\/v1/, "")));
  return asked;
};

test("work is followed by its events, and by asking where these do not come through", async (t) => {
  const p = await page("start=8142640,-276640&goal=8142675,-276650&routes=4");
  await p.waitForSelector(".terrain select");
  await p.until(() => !document.querySelector('[data-do="plan"]').disabled);
  const asked = counted(p);
  await p.evaluate(() => {
    window.best = "";
    new MutationObserver(() => (window.best = document.querySelector("[data-best]")?.textContent ?? window.best)).observe(document.querySelector(".work"), { subtree: true, childList: true });
  });
  await p.click('[data-do="plan"]');
  await p.waitForSelector("[data-best]");
  await p.look("26_best_so_far");
  await p.verdict();
  assert.match(await p.evaluate(() => window.best), /Best so far.*\d m, cost/);
  assert.equal(asked.filter((u) => u.endsWith("/events")).length, 1);
  assert.ok(asked.filter((u) => /^\/jobs\/[0-9a-f]+$/.test(u)).length <= 2, asked.join());
  // Nothing is asked for while nothing happens.
  asked.length = 0;
  await pause(2100);
  assert.ok(asked.length <= 1, asked.join());
  await p.click("#tab-jobs");
  asked.length = 0;
  await pause(2100);
  assert.ok(asked.length <= 1, asked.join());
  await p.done();

  // A proxy that keeps events back.
  const deaf = await proxy(service.port, "/behind", { swallows: /\/events$/ });
  t.after(() => deaf.stop());
  const q = await open(browser, `${deaf.url}/dashboard/#terrain=gale&start=8142640,-276640&goal=8142675,-276650&routes=1`);
  await q.waitForSelector(".terrain select");
  await q.until(() => !document.querySelector('[data-do="plan"]').disabled);
  await q.click('[data-do="plan"]');
  await q.verdict();
  await q.done();
});

test("a stranger finds out why a drive is no GO, and does what is advised", async () => {
  // Whoever names no terrain gets one on which a drive can be a GO.
  const p = await open(browser, `${service.url}/dashboard/#start=8142579.7,-276648.7&goal=8142560,-276672&routes=2`);
  // Each kind of advice, whatever this ground gives.
  const nearer = { x_m: 8142585, y_m: -276646 };
  await p.route(/\/result$/, async (route) => {
    const answer = await (await route.fetch()).json();
    const [first] = answer.routes.features;
    first.properties.decision.advice = [
      { kind: "shorter_drive", words: "end the drive at 6.0 m", at_m: 6, ...nearer },
      { kind: "other_route", words: "take route 2, which is a GO", route: 2 },
      { kind: "scout_drive", words: "drive 5 m onto the ground at 10 m", at_m: 10, ...nearer },
    ];
    await route.fulfill({ json: answer });
  });
  await p.waitForSelector(".terrain select");
  await p.until(() => document.querySelector(".terrain select").value === "gale");
  await p.until(() => !document.querySelector('[data-do="plan"]').disabled);
  await p.click('[data-do="plan"]');
  const verdict = await p.verdict();
  assert.notEqual(verdict, "go");
  const answer = await (await p.request.get(`${service.url}/v1/jobs/${new URLSearchParams(p.url().split("#")[1]).get("job")}/result`)).json();
  const { decision, outcomes, mean_slip } = answer.routes.features[0].properties;
  assert.equal(decision.verdict, verdict);
  assert.equal(await p.locator("[data-reasons] li").count(), decision.reasons.length, "every reason is told once");
  assert.equal(await p.locator("[data-reasons] .badge").count(), decision.rules.filter((r) => r.verdict !== "go").length);
  // The shares beside the verdict are those of the reason that has them in words.
  const halt = decision.reasons.join("\n").match(/a halt in (\S+ %) of the draws \(90 % interval (\S+ %) to (\S+ %)\)/);
  // Near a bar the reason has a digit more.
  const plain = (words) => (parseFloat(words) > 0 && parseFloat(words) < 10 ? `${parseFloat(words).toFixed(1)} %` : `${Math.round(parseFloat(words))} %`);
  if (halt) assert.equal(await p.textContent("[data-stop]"), `Halts in ${plain(halt[1])} of the draws (${plain(halt[2])} to ${plain(halt[3])})`);
  else assert.match(await p.textContent("[data-stop]"), /^Halts in \S+ % of the draws \(\S+ % to \S+ %\)$/);
  assert.ok(outcomes.stop.low <= outcomes.stop.value);
  assert.equal(await p.textContent('.compare-table tr:has(th:text-is("Mean slip, ratio")) td >> nth=0'), String(Number(mean_slip.toPrecision(3))), "the mean soils' figure, as the terminal has it");
  assert.deepEqual(await p.locator(".advice li button").allTextContents(), ["Make it the goal and plan again", "Look at it", "Show where"]);
  await p.look("27_why_no_go");
  await p.accessible("why it is no go");
  await p.click('.advice [data-do="scout"]');
  await p.until(() => / at 1\d\.\d m$/.test(document.querySelector(".readout").textContent));
  const [asked] = await Promise.all([p.waitForRequest((r) => r.method() === "POST" && r.url().endsWith("/v1/plans")), p.click('.advice [data-do="nearer-goal"]')]);
  assert.deepEqual(asked.postDataJSON().goal, nearer);
  await p.until((old) => !location.hash.includes(old) && !document.querySelector(".work .job"), answer.format && new URLSearchParams(p.url().split("#")[1]).get("job"));
  await p.look("28_after_one_change");
  await p.done();
});

test("an answer is taken along as files and as one page of paper", async () => {
  const p = await page("tab=check");
  await p.waitForSelector(".terrain select");
  await p.fill("#panel-check textarea >> nth=0", "8142579.7,-276648.7\n8142578,-276680");
  await p.click('[data-do="check"]');
  await p.verdict();
  const file = async (label) => {
    const download = p.waitForEvent("download");
    await p.click(`[data-export="${label}"]`);
    return readFileSync(await (await download).path());
  };
  assert.equal((await file("GeoPackage")).subarray(0, 15).toString(), "SQLite format 3");
  const line = (bytes) => JSON.parse(bytes).features.find((f) => f.geometry.type === "LineString").geometry.coordinates[0];
  assert.ok(line(await file("GeoJSON"))[0] > 8_000_000);
  assert.ok(Math.abs(line(await file("GeoJSON, degrees"))[0] - 137.37) < 0.1);
  const csv = (await file("CSV")).toString().trim().split("\n");
  assert.match(csv[0], /distance_m/);
  assert.equal(csv.length - 1, JSON.parse(await file("JSON")).routes.features[0].properties.stations.count);
  assert.match((await file("Picture")).toString(), /<svg/);

  await p.click('header button:text-is("Dark")');
  await p.evaluate(() => {
    window.print = () => (window.printed = true);
  });
  await p.click('[data-do="print"]');
  await p.until(() => window.printed);
  await p.emulateMedia({ media: "print" });
  await p.setViewportSize({ width: 760, height: 1080 });
  const text = await p.innerText(".paper");
  for (const words of ["NO-GO", "Marias Pass", "MSL class", "Slip over a stretch between checks", "Fingerprint"]) assert.ok(text.includes(words), words);
  assert.ok((await p.$$eval(".paper img", (images) => images.every((i) => i.naturalWidth > 100 && i.clientWidth > 100))), "every picture is there");
  await p.look("29_paper");
  const pdf = await p.pdf({ preferCSSPageSize: true });
  assert.equal((pdf.toString("latin1").match(/\/Type\s*\/Page\b/g) ?? []).length, 1, "one page");
  await p.done();
});
