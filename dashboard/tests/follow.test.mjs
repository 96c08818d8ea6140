// Recorded drives in a real browser: sent, diagnosed to the end, watched, and planned with what they showed.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { cpSync, mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { launch, open } from "./page.mjs";
import { serve } from "./service.mjs";

const data = `${process.env.SLIPWAY_SOURCE}/data`;
const plan = "terrain=gale&rover=mer-class&start=8142640,-276640&goal=8142655,-276650&routes=1";
let service;
let browser;
let folder;

before(async () => {
  folder = mkdtempSync(join(tmpdir(), "slipway-drives-"));
  browser = await launch();
  service = await serve();
});
after(async () => {
  await browser?.close();
  await service?.stop();
  rmSync(folder, { recursive: true, force: true });
});

/** Every sixth drive of a practice campaign, with the motors cold in some: enough to find what they lack, few enough to be quick. */
function smallCampaign() {
  const from = join(data, "gap-practice/p05");
  const campaign = JSON.parse(readFileSync(join(from, "campaign.json"), "utf8"));
  campaign.name = "cold_drives";
  campaign.drives = campaign.drives.filter((_, i) => i % 6 === 0);
  const into = join(folder, "cold_drives");
  mkdirSync(into, { recursive: true });
  for (const { file } of campaign.drives) cpSync(join(from, file), join(into, file));
  for (const { dem } of Object.values(campaign.terrains)) cpSync(join(from, dem), join(into, dem));
  writeFileSync(join(into, "campaign.json"), JSON.stringify(campaign));
  execFileSync("tar", ["-czf", join(folder, "drives.tgz"), "-C", folder, "cold_drives"]);
  return { archive: join(folder, "drives.tgz"), drives: campaign.drives };
}

test("drives are sent, diagnosed to the end, and the next plan is made with the corrected model", async () => {
  const { archive, drives } = smallCampaign();
  const p = await open(browser, `${service.url}/dashboard/#tab=drives&${plan}`);
  await p.click("text=Send drives of your own");
  await p.setInputFiles('[data-upload="campaign"]', archive);
  await p.click("text=Send the drives");
  await p.until(() => document.querySelector("#panel-drives select")?.value.startsWith("dc-"));
  await p.waitForSelector(`#panel-drives p:text("${drives.length} drives")`);
  // A drive that followed is appended: the campaign has one more.
  await p.click("text=Append a drive");
  await p.fill('[data-append="id"]', "D002");
  await p.selectOption('details:has-text("Append a drive") select >> nth=0', "tilt_00");
  await p.fill('[data-append="speed"]', "0.05");
  await p.fill('[data-append="duration"]', "60");
  await p.setInputFiles('[data-append="csv"]', join(data, "gap-practice/p05/D002.csv"));
  await p.click('[data-do="append"]');
  await p.waitForSelector(`#panel-drives p:text("${drives.length + 1} drives")`);
  await p.click('[data-do="diagnose"]');
  await p.waitForSelector('.work:has-text("diagnosis") progress');
  await p.look("15_drives_sent");
  await p.waitForSelector("[data-diagnosis]");
  assert.equal(await p.getAttribute("[data-diagnosis]", "data-diagnosis"), "effects");
  // A sentence comes first, not a table.
  assert.match(await p.textContent("[data-lead]"), /^The simulator leaves out .*temperature.* of the gap in .* closes on drives that no fit had seen\.$/);
  assert.ok(await p.evaluate(() => [...document.querySelectorAll(".diagnosis table")].every((table) => document.querySelector("[data-lead]").compareDocumentPosition(table) & Node.DOCUMENT_POSITION_FOLLOWING)));
  await p.plain("diagnosis");

  // The ladder: every channel from nominal to the floor, the currents' gap closed by the effect.
  const job = new URLSearchParams(p.url().split("#")[1]).get("job");
  const answer = await (await p.request.get(`${service.url}/v1/jobs/${job}/result`)).json();
  const rungs = await p.$$eval(".ladder [data-rung]", (rows) => rows.map((r) => r.dataset.rung));
  for (const rung of ["nominal", "retuned", "with_effects", "with_discrepancy", "noise_floor"]) assert.equal(rungs.filter((r) => r === rung).length, answer.gap.channels.length, rung);
  const effect = answer.effects[0].name;
  assert.equal(effect, "motor_temperature");
  const first = answer.marginals[0];
  assert.ok(first.probability > 0.8, `${first.probability}`);
  assert.match(await p.textContent('[aria-label="Effects and their probabilities"] tbody tr >> nth=0'), /^motor temperature(> 0\.99|0\.[89]\d)/);

  // Where: the windows on the map, and predicted against driven in the charts; each points at the other.
  const shown = await p.inputValue("#gap-ground");
  const windows = answer.where.windows.filter((w) => w.terrain === shown);
  assert.ok(windows.length > 0 && windows[0].values.length > 3);
  assert.ok((await p.locator(".charts canvas").count()) >= 5, "a chart of each channel");
  assert.match(await p.textContent(".scale-bar-inner"), /^[125]0* (cm|m)$/);
  assert.match(await p.textContent(".map-aim"), new RegExp(shown.replaceAll("_", " ")));
  await p.look("17_diagnosis");
  await p.accessible("diagnosis");
  const map = () => p.locator(".map").screenshot();
  const nominal = await map();
  await p.click('.chip[data-rung="with_effects"]');
  await p.waitForSelector('.chip[data-rung="with_effects"][aria-pressed="true"]');
  await new Promise((resolve) => setTimeout(resolve, 300));
  assert.notDeepEqual(await map(), nominal, "the map shows another model's gap");
  const chart = await p.locator(".u-over").first().boundingBox();
  await p.mouse.move(chart.x + chart.width / 3, chart.y + chart.height / 2);
  await p.until(() => /Drive \w+, .* deviations/.test(document.querySelector(".layers").textContent));
  await p.look("18_gap_with_effects");
  const before = await p.locator(".charts canvas").count();
  await p.selectOption("#gap-drive", windows[0].drive);
  await p.waitForSelector(`.charts:has-text("drive ${windows[0].drive}")`);
  assert.equal(await p.locator(".charts canvas").count(), before);
  await p.evaluate(() => document.querySelector(".replan").scrollIntoView());
  await p.look("19_replan");

  // The corrected model goes to the plan, with the ground that is the drives' own.
  await p.check('[data-ground="gale_smooth"]');
  await p.click('[data-do="replan"]');
  await p.waitForSelector(`#panel-plan [data-model="${job}"]`);
  const [request] = await Promise.all([p.waitForRequest((r) => r.method() === "POST" && r.url().endsWith("/v1/plans")), p.click('[data-do="plan"]')]);
  assert.deepEqual(request.postDataJSON().model, { diagnosis: job, ground: ["gale_smooth"] });
  await p.verdict();
  const corrected = p.url();
  assert.match(await p.textContent(".verdict .banner"), /MER class cold drives/, "the corrected rover drives");
  await p.look("20_planned_with_the_model");
  await p.click('[data-do="keep"]');
  await p.click('[data-do="no-model"]');
  await p.click('[data-do="plan"]');
  await p.waitForSelector('[data-differences]:has-text("model")');
  await p.waitForSelector('th:has-text("Kept")');
  await p.evaluate(() => document.querySelector("[data-differences]").scrollIntoView({ block: "center" }));
  await p.look("21_with_and_without");
  await p.accessible("two plans");

  // A link to the plan has the model in it.
  await p.goto("about:blank");
  await p.goto(corrected);
  await p.verdict();
  await p.waitForSelector(`#panel-plan [data-model="${job}"]`);
  assert.equal(await p.inputValue("#plan-rover"), "mer-class");
  await p.done();
});

test("a watch raises its alarm, says since when, and diagnoses what has changed", async () => {
  const p = await open(browser, `${service.url}/dashboard/#tab=drives&terrain=gale`);
  await p.waitForSelector('[data-do="diagnose"]');
  // The drives that the test before this one has sent.
  const sent = await p.$eval("#panel-drives select", (s) => [...s.options].map((o) => o.value).filter((v) => v.startsWith("dc-")).at(-1));
  const ask = async (diagnose) => {
    await p.selectOption("#panel-drives select >> nth=0", sent);
    await p.click("text=Watch these drives for a change");
    await p.selectOption("#panel-drives details select", "p01");
    if (!diagnose) await p.uncheck('[data-watch="diagnose"]');
    const [request] = await Promise.all([p.waitForRequest((r) => r.method() === "POST" && r.url().endsWith("/v1/watches")), p.click('[data-do="watch"]')]);
    assert.deepEqual(request.postDataJSON(), { campaign: sent, reference: "p01", ...(diagnose ? {} : { diagnose: false }) });
    const before = new URLSearchParams(p.url().split("#")[1]).get("job");
    await p.until((old) => document.querySelector("[data-alarm]") && new URLSearchParams(location.hash.slice(1)).get("job") !== old && !document.querySelector(".work progress"), before);
    return (await p.request.get(`${service.url}/v1/jobs/${new URLSearchParams(p.url().split("#")[1]).get("job")}/result`)).json();
  };
  const watch = await ask(false);
  assert.equal(await p.getAttribute("[data-alarm]", "data-alarm"), watch.alarm.drive);
  assert.match(await p.textContent("[data-alarm]"), new RegExp(`since ${watch.alarm.since}`));
  assert.equal(await p.locator('[aria-label="Evidence drive by drive"] tbody tr').count(), watch.drives.length);
  await p.waitForSelector(".wide-chart canvas");
  await p.waitForSelector('[data-do="diagnose-change"]');
  assert.equal(await p.locator("[data-diagnosis]").count(), 0);
  await p.look("22_watch");
  await p.accessible("watch");

  const diagnosed = await ask(true);
  await p.waitForSelector(`[data-diagnosis="${diagnosed.diagnosis.verdict}"]`);
  assert.equal(diagnosed.diagnosis.effects[0].name, "motor_temperature");
  assert.match(await p.textContent('[aria-label="Effects and their probabilities"] tbody tr >> nth=0'), /motor temperature/);
  assert.equal(await p.locator("[data-alarm]").count(), 1, "the alarm stands above its diagnosis");
  await p.waitForSelector(".wide-chart canvas");
  assert.ok((await p.locator(".charts canvas").count()) > 5, "the evidence, and every channel against its prediction");
  // From the keyboard: window after window, in the charts and on the map.
  await p.locator(".charts").focus();
  await p.keyboard.press("ArrowRight");
  await p.until(() => /^driven -?\d/.test(document.querySelector(".charts .readout").textContent));
  const first = await p.textContent(".layers");
  assert.match(first, /Drive \w+, .* deviations/);
  await p.keyboard.press("ArrowRight");
  await p.until((old) => document.querySelector(".layers").textContent !== old, first);
  await p.look("30_watch_with_its_diagnosis");
  await p.accessible("watch with its diagnosis");
  // The list of jobs opens it again.
  await p.goto("about:blank");
  await p.goto(`${service.url}/dashboard/#tab=jobs&terrain=gale`);
  await p.click('.jobs .job:has-text("watch") [data-do="open"] >> nth=0');
  await p.waitForSelector(`[data-alarm="${diagnosed.alarm.drive}"]`);
  await p.waitForSelector("[data-diagnosis]");
  await p.done();
});
