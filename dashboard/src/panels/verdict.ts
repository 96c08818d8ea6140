// The verdict with its reasons, the rules that decide, the routes beside each other.
import { hasEnded } from "../api/client";
import { button, fill, h } from "../dom";
import { duration, metres, number, roverWords, sentence, share, wheelWords, words } from "../format";
import type { TerrainMap } from "../map/terrain_map";
import { isAboutRoutes, surprises, verdictWords, type Result, type Route, type Rule } from "../result";
import { store } from "../state";
import { causeWords } from "../why";
import { adviceView, reasonText } from "./advice";
import { exportsView } from "./exports";
import { limitSliders } from "./limits";
import { windowsView } from "./windows";

function rulesTable(route: Route, map: TerrainMap): HTMLElement {
  const row = (rule: Rule) => {
    const { from_m, to_m } = rule;
    return h(
      "tr",
      { class: from_m !== null ? "trips" : "" },
      h("th", { scope: "row" }, sentence(rule.words)),
      h("td", {}, `${number(rule.limit)}${unit(rule.unit)}`),
      h("td", {}, nearest(rule)),
      h("td", {}, share(rule.trips.value), from_m !== null && h("small", {}, ` first in ${share(rule.halts)}`)),
      h("td", {}, from_m === null ? "–" : button(`${from_m.toFixed(1)} to ${to_m?.toFixed(1)} m`, () => {
        map.showStretch(from_m, to_m ?? from_m);
        store.set({ hover_m: from_m });
      }, { class: "link", title: "Show on the map" })),
      h("td", {}, [rule.cause && causeWords(rule.cause), rule.wheel && wheelWords(rule.wheel)].filter(Boolean).join(", ") || "–"),
    );
  };
  return h(
    "div",
    { class: "wide", tabindex: 0, role: "region", "aria-label": "Rules" },
    h(
      "table",
      {},
      h("thead", {}, h("tr", {}, ["Rule", "Limit", "Nearest value", "Trips in", "Where", "Cause"].map((t) => h("th", { scope: "col" }, t)))),
      h("tbody", {}, route.outcomes.rules.map(row)),
    ),
  );
}

export const nearest = ({ value }: Rule): string => `${number(value.p50)} (${number(value.p05)} to ${number(value.p95)})`;

export const unit = (u: string): string => (u === "1" || u === "" ? "" : ` ${u}`);

export const figures: [string, (r: Route) => number | null | undefined, (v: number | null | undefined) => string][] = [
  ["Cost that ranks, h of driving", (r) => r.figures.cost, (v) => number(v, 4)],
  ["Length", (r) => r.figures.length_m, metres],
  ["Time under way", (r) => r.figures.duration_s, duration],
  ["Energy, Wh", (r) => r.figures.energy_wh, (v) => number(v)],
  ["Mean slip, ratio", (r) => r.figures.mean_slip, (v) => number(v)],
  ["Mean slip, 95 % of the draws below", (r) => r.figures.mean_slip_p95, (v) => number(v)],
  ["Halts, % of the draws", (r) => r.outcomes.stop.value, share],
  ["Held by the ground, % of the draws", (r) => r.outcomes.immobilised.value, share],
  ["Embedded, % of the draws", (r) => r.outcomes.embedding.value, share],
  ["On unknown ground", (r) => r.figures.unknown_length_m, metres],
  ["Steepest tilt, deg", (r) => r.figures.max_tilt_deg?.value, (v) => number(v)],
];

/** Routes beside each other; differences to the chosen one stand below the figures. */
function comparison(result: Result, other: Result | null): HTMLElement {
  const { route: chosen, compared } = store.state;
  const columns: { route: Route; title: string; index: number | null }[] = result.routes.map((route, index) => ({ route, title: route.title, index }));
  if (other?.routes[0]) columns.push({ route: other.routes[0], title: `Kept: ${other.routes[0].title}`, index: null });
  const reference = result.routes[chosen];
  const head = columns.map(({ route, title, index }) =>
    h(
      "th",
      { scope: "col", class: index === chosen ? "chosen" : "" },
      index === null ? h("span", {}, title) : button(title, () => store.set({ route: index, compared: compared === index ? null : compared }), { class: "link", "aria-pressed": String(index === chosen), "data-route": index }),
      h("span", { class: `badge ${route.verdict}` }, verdictWords[route.verdict]),
      index !== null && index !== chosen && h("label", { class: "compare" }, h("input", { type: "checkbox", checked: compared === index, onchange: () => store.set({ compared: compared === index ? null : index }) }), "compare"),
    ),
  );
  const ranked = figures.filter(([, value]) => columns.some(({ route }) => value(route) !== undefined)); // a check ranks nothing
  const body = ranked.map(([name, value, write]) =>
    h(
      "tr",
      {},
      h("th", { scope: "row" }, name),
      columns.map(({ route, index }) => {
        const [here, there] = [value(route), reference && value(reference)];
        const differs = index !== chosen && typeof here === "number" && typeof there === "number" && here !== there;
        return h("td", { class: index === chosen ? "chosen" : "" }, write(here), differs && h("small", {}, ` ${here > there ? "+" : "−"}${write(Math.abs(here - there))}`));
      }),
    ),
  );
  return h("div", { class: "wide", tabindex: 0, role: "region", "aria-label": "Routes beside each other" }, h("table", { class: "compare-table" }, h("thead", {}, h("tr", {}, h("td", {}), head)), h("tbody", {}, body)), costTerms(reference));
}

/** What the cost that ranks is made of. */
function costTerms(route: Route | undefined): HTMLElement | null {
  const terms = (route?.figures.cost_shares ?? []).filter((term) => term.cost);
  if (!route || terms.length === 0) return null;
  return h("p", { class: "hint", "data-cost": true }, `The routes are ranked by their cost, in hours of driving (mean of the draws). ${route.title}: ${terms.map((term) => `${words(term.name ?? "")} ${number(term.cost, 2)}`).join(" + ")} = ${number(route.figures.cost, 4)}.`);
}

/** What the drive has met so far against what had been predicted before it was measured. */
function driven(result: Result): HTMLElement {
  const wrong = result.driven.filter(surprises).length;
  return h(
    "div",
    { class: "driven" },
    h("h3", {}, "Driven so far: slip measured against predicted"),
    h("p", {}, wrong === 0 ? "All stretches lie in what 90 % of the draws had predicted." : `${wrong} of ${result.driven.length} stretches lie outside what 90 % of the draws had predicted: squares on the map.`),
    h("div", { class: "wide short", tabindex: 0, role: "region", "aria-label": "Stretches driven" },
      h("table", {}, h("thead", {}, h("tr", {}, ["By odometry", "Measured", "Predicted: median (5 to 95 %)"].map((t) => h("th", { scope: "col" }, t)))),
        h("tbody", {}, result.driven.map((s) =>
          h("tr", { class: surprises(s) ? "trips" : "" }, h("th", { scope: "row" }, `${number(s.from_m)} to ${number(s.to_m)} m`), h("td", {}, number(s.slip), surprises(s) ? " outside" : ""),
            h("td", {}, `${number(s.predicted_slip.p50)} (${number(s.predicted_slip.p05)} to ${number(s.predicted_slip.p95)})`)))))),
  );
}

const shortId = (text: string): string => (/^[0-9a-f]{32}$/.test(text) ? "another" : words(text));

/** What was asked differently of two answers. */
function askedDifferently(result: Result, other: Result): HTMLElement | null {
  const left_out = new Set(["start", "goal", "format"]);
  const flat = (value: unknown, prefix = ""): [string, string][] =>
    value !== null && typeof value === "object" && !Array.isArray(value) ? Object.entries(value).flatMap(([k, v]) => flat(v, prefix ? `${prefix}, ${words(k)}` : words(k))) : [[prefix, Array.isArray(value) ? (value.length === 0 ? "none" : typeof value[0] === "string" ? value.join(", ") : `${value.length}`) : shortId(String(value))]];
  const [here, there] = [result, other].map((r) => new Map(flat(Object.fromEntries(Object.entries({ ...r.request, terrain: r.terrain }).filter(([k]) => !left_out.has(k))))));
  const differ = [...new Set([...here!.keys(), ...there!.keys()])].filter((k) => here!.get(k) !== there!.get(k));
  return h("p", { class: "hint", "data-differences": true }, differ.length === 0 ? "Both were asked alike." : `Asked differently: ${differ.map((k) => `${k} ${here!.get(k) ?? "–"} (kept: ${there!.get(k) ?? "–"})`).join("; ")}.`);
}

/** Of a long drive, its segments with a verdict each. */
function segments(route: Route, map: TerrainMap): HTMLElement | null {
  const list = route.outcomes.segments ?? [];
  if (list.length === 0) return null;
  return h("div", { class: "wide short", tabindex: 0, role: "region", "aria-label": "Segments" },
    h("h3", {}, "Segment by segment"),
    h("table", {}, h("thead", {}, h("tr", {}, ["Segment", "Verdict", "Halts in", "Held by the ground in", "Embedded in", "Reached in"].map((t) => h("th", { scope: "col" }, t)))),
      h("tbody", {}, list.map((s) => h("tr", {}, h("th", { scope: "row" }, button(`${s.from_m.toFixed(0)} to ${s.to_m.toFixed(0)} m`, () => map.showStretch(s.from_m, s.to_m), { class: "link" })), h("td", {}, h("span", { class: `badge ${s.verdict}` }, verdictWords[s.verdict])), [s.stop.value, s.immobilised.value, s.embedding.value, s.reached].map((v) => h("td", {}, share(v))))))));
}

/** The probability that decides, beside the verdict. */
const stopText = ({ outcomes: { stop } }: Route): string => `Halts in ${share(stop.value)} of the draws (${share(stop.low)} to ${share(stop.high)})`;

/** Why there are not as many routes as were asked for. */
const fewer = ({ fewer: reasons }: Result): HTMLElement | null =>
  reasons.length > 0 ? h("div", {}, h("p", {}, "There are fewer routes than were asked for:"), h("ul", {}, reasons.map((why) => h("li", {}, reasonText(why))))) : null;

export function verdictPanel(target: HTMLElement, map: TerrainMap, print: () => void): void {
  // While another question is asked, what stands here answers the one before.
  store.on(["job", "stale"], ({ job, stale }) => {
    target.classList.toggle("of-before", stale !== "" || (job !== null && isAboutRoutes(job.kind) && !hasEnded(job)));
    target.dataset.stale = stale;
  });
  const sliders = limitSliders();
  store.on(["result", "route", "compared", "other", "tab"], ({ result, other, tab }) => {
    // A plan's verdict does not stand beside the form of a check.
    if (!result || tab === "drives" || (tab === "plan" && result.kind !== "plan") || (tab === "check" && result.kind === "plan")) {
      fill(target);
      return;
    }
    const route = result.routes[store.state.route];
    fill(
      target,
      !route && h("div", { class: "banner no_go" }, "NO ROUTE"),
      !route && fewer(result),
      route && [
        h("div", { class: `banner ${route.verdict}`, "data-verdict": route.verdict }, verdictWords[route.verdict], h("small", {}, `${route.title}, ${roverWords(result.rover)}`), route.outcomes.draws > 0 && h("small", { "data-stop": true }, stopText(route))),
        ...adviceView(result, route, map),
        ...windowsView(route),
        sliders,
        result.driven.length > 0 && driven(result),
        comparison(result, other),
        fewer(result),
        other && other !== result ? askedDifferently(result, other) : null,
        segments(route, map),
        h("h3", {}, "Rules"),
        h("p", { class: "hint" }, "The value that comes nearest to the limit: median of the draws of the ground (5 to 95 %). A rule trips wherever its limit is passed on the way; the first to trip halts the drive."),
        route.outcomes.draws > 0 ? rulesTable(route, map) : h("p", {}, "There were no draws of the ground to judge by."),
        route.notes.length > 0 && h("details", {}, h("summary", {}, "How the plan ranked it"), h("ul", {}, route.notes.map((note) => h("li", {}, note)))),
        exportsView(result, print),
        h("details", {}, h("summary", {}, "Where it comes from"), h("dl", {}, provenance(result).flatMap(([k, v]) => [h("dt", {}, k), h("dd", {}, v)]))),
      ],
    );
  });
}

export function provenance(result: Result): [string, string][] {
  const p = result.provenance;
  return [
    ["Asked", `${result.created.slice(0, 16).replace("T", " ")} UTC`],
    ["Slipway", p.slipway ?? "–"],
    ["Terrain", store.state.terrain?.terrain?.title ?? words(result.terrain)],
    ["Seed", String(p.seed ?? "–")],
    ["Soils", `${words(p.legend ?? "–")}: ${p.soil_assumption ?? ""}`],
  ];
}

