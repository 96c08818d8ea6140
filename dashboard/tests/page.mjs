// A page in a real browser, watched for what it must not do.
import assert from "node:assert/strict";
import { mkdirSync, readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { join } from "node:path";
import { chromium } from "playwright-core";

const axe = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");
const pictures = process.env.SCREENSHOTS ?? "screenshots";
mkdirSync(pictures, { recursive: true });

export const launch = () => chromium.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", args: ["--no-sandbox"] });

/** Waits until it is true in the page; playwright's own way is an eval(), which the page's policy forbids. */
export async function until(page, condition, argument) {
  const deadline = Date.now() + 300_000;
  while (!(await page.evaluate(condition, argument))) {
    if (Date.now() > deadline) throw new Error(`never came true: ${condition}`);
    await new Promise((resolve) => setTimeout(resolve, 40));
  }
}

/** With `expected`: what a test brings about on purpose may be complained of. */
export async function open(browser, url, { expected = /(?!)/, ...options } = {}) {
  const context = await browser.newContext({ viewport: { width: 1440, height: 1000 }, reducedMotion: "reduce", ...options });
  const page = await context.newPage();
  page.setDefaultTimeout(300_000);
  const complaints = [];
  const host = new URL(url).host;
  page.on("console", (message) => {
    if (["error", "warning"].includes(message.type()) && !expected.test(message.text())) complaints.push(`console: ${message.text()}`);
  });
  page.on("pageerror", (error) => complaints.push(`thrown: ${error.message}`));
  page.on("request", (request) => {
    const to = new URL(request.url());
    if (!["data:", "blob:"].includes(to.protocol) && to.host !== host) complaints.push(`a request to another host: ${request.url()}`);
  });
  await page.goto(url);
  return Object.assign(page, {
    until: (condition, argument) => until(page, condition, argument),
    async look(name) {
      await page.screenshot({ path: join(pictures, `${name}.png`) });
    },
    /** Nothing serious for those who do not see, or use no mouse. */
    async accessible(where) {
      if (!(await page.evaluate(() => "axe" in window))) await page.evaluate(axe);
      const { violations } = await page.evaluate(() => window.axe.run(document, { resultTypes: ["violations"] }));
      const serious = violations.filter((v) => ["serious", "critical"].includes(v.impact)).map((v) => `${v.id}: ${v.nodes.map((n) => `${n.html} ${n.any[0]?.message ?? ""}`).slice(0, 3).join(" | ")}`);
      assert.deepEqual(serious, [], where);
    },
    /** No names of the service's own making: people read words. What is a command or a file's text is left out. */
    async plain(where) {
      const text = await page.evaluate(() => {
        const left_out = [...document.querySelectorAll("pre, code, textarea, .paper")];
        for (const one of left_out) one.dataset.unread = one.style.visibility;
        for (const one of left_out) one.style.visibility = "hidden";
        const seen = document.body.innerText;
        for (const one of left_out) one.style.visibility = one.dataset.unread;
        return seen;
      });
      const raw = text.match(/\b(\w+_\w+|[0-9a-f]{16,}|\w+-class)\b/g) ?? [];
      assert.deepEqual([...new Set(raw)], [], where);
    },
    async done() {
      assert.deepEqual(complaints, []);
      await context.close();
    },
    async verdict() {
      await page.waitForSelector("[data-verdict]");
      return page.getAttribute("[data-verdict]", "data-verdict");
    },
    /** Where a place of the map is on the screen. */
    async pixel(x_m, y_m) {
      const box = await page.locator(".map").boundingBox();
      await until(page, () => location.hash.includes("view="));
      const [cx, cy, resolution] = new URLSearchParams(page.url().split("#")[1]).get("view").split(",").map(Number);
      return { x: box.x + box.width / 2 + (x_m - cx) / resolution, y: box.y + box.height / 2 - (y_m - cy) / resolution };
    },
  });
}
