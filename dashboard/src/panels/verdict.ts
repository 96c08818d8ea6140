// The verdict with its reasons, the rules that decide, the routes beside each other.
import { button, fill, h } from "../dom";
import { duration, metres, number, share, words } from "../format";
import type { TerrainMap } from "../map/terrain_map";
import { surprises, verdictWords, type Result, type Route, type Rule } from "../result";
import { store } from "../state";
import { keep } from "../work";
import { token, address } from "../api/client";

const ruleWords: Record<string, string> = {
  slip_check: "slip at a check",
  tilt: "tilt",
  current: "current",
  sinkage: "sinkage",
  clearance: "clearance",
  immobilised: "no way forward",
  embedding: "embedding",
};

function rulesTable(route: Route, map: TerrainMap): HTMLElement {
  const row = (rule: Rule) => {
    const trips = rule.trips?.value ?? 0;
    const show = () => {
      if (rule.from_m === null) return;
      map.showStretch(rule.from_m, rule.to_m ?? rule.from_m);
      store.set({ hover_m: rule.from_m });
    };
    return h(
      "tr",
      { class: trips > 0 ? "trips" : "" },
      h("th", { scope: "row" }, ruleWords[rule.rule] ?? words(rule.rule)),
      h("td", {}, `${number(rule.limit)}${unit(rule.unit)}`),
      h("td", {}, rule.value ? `${number(rule.value.p50)} (${number(rule.value.p05)} to ${number(rule.value.p95)})` : "–"),
      h("td", {}, share(trips)),
      h("td", {}, rule.from_m === null || trips === 0 ? "–" : button(`${rule.from_m.toFixed(1)} to ${rule.to_m?.toFixed(1)} m`, show, { class: "link", title: "Show on the map" })),
      h("td", {}, [rule.cause && words(rule.cause), rule.wheel && `wheel ${rule.wheel}`].filter(Boolean).join(", ") || "–"),
    );
  };
  return h(
    "div",
    { class: "wide", tabindex: 0, role: "region", "aria-label": "Rules" },
    h(
      "table",
      {},
      h("thead", {}, h("tr", {}, ["Rule", "Limit", "Nearest value", "Trips in", "Where", "Cause"].map((t) => h("th", { scope: "col" }, t)))),
      h("tbody", {}, route.rules.map(row)),
    ),
  );
}

const unit = (u: string): string => (u === "1" || u === "" ? "" : ` ${u}`);

function change(route: Route): string[] {
  const advice: string[] = [];
  const worst = [...route.stretches].sort((a, b) => b.expected_stops + b.embedding - a.expected_stops - a.embedding)[0];
  if (worst && worst.expected_stops + worst.embedding > 0)
    advice.push(`Most is expected to go wrong from ${worst.from_m.toFixed(1)} to ${worst.to_m.toFixed(1)} m: a keep-out there, or another way, changes most.`);
  const tripping = route.rules.filter((r) => r.trips?.value > 0.05).sort((a, b) => b.trips.value - a.trips.value)[0];
  if (tripping) advice.push(`The rule that trips most is ${ruleWords[tripping.rule] ?? words(tripping.rule)}, in ${share(tripping.trips.value)} of the draws.`);
  const { unknown_length_m } = route.figures;
  if ((unknown_length_m ?? 0) > 0) advice.push(`${metres(unknown_length_m)} lie on ground that no map names: nothing there can be called safe before it has been seen.`);
  const checks = route.outcomes.recommended?.slip_checks_before_m ?? [];
  if (checks.length > 0) advice.push(`Checks of the slip belong before ${checks.slice(0, 6).map((m) => m.toFixed(1)).join(", ")}${checks.length > 6 ? " …" : ""} m.`);
  return advice;
}

const figures: [string, (r: Route) => number | null | undefined, (v: number | null | undefined) => string][] = [
  ["Length", (r) => r.figures.length_m, metres],
  ["Time under way", (r) => r.figures.duration_s, duration],
  ["Energy, Wh", (r) => r.figures.energy_wh, (v) => number(v)],
  ["Mean slip", (r) => r.figures.mean_slip_p50, (v) => number(v)],
  ["Slip, 95 %", (r) => r.figures.mean_slip_p95, (v) => number(v)],
  ["Stops expected", (r) => r.outcomes.expected_stops?.value ?? r.figures.expected_stops, (v) => number(v)],
  ["Embedding", (r) => r.outcomes.embedding?.value ?? r.figures.embedding?.value, share],
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
  const body = figures.map(([name, value, write]) =>
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
  return h("div", { class: "wide", tabindex: 0, role: "region", "aria-label": "Routes beside each other" }, h("table", { class: "compare-table" }, h("thead", {}, h("tr", {}, h("td", {}), head)), h("tbody", {}, body)));
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

function exports(result: Result): HTMLElement {
  const at = `v1/jobs/${result.job}/result`;
  const report = `v1/jobs/${result.job}/report`;
  return h(
    "div",
    { class: "row wrap" },
    button("GeoJSON", () => void keep(at, `${result.kind}.geojson`, "application/geo+json"), { class: "quiet" }),
    button("CSV", () => void keep(at, `${result.kind}.csv`, "text/csv"), { class: "quiet" }),
    button("JSON", () => void keep(at, `${result.kind}.json`), { class: "quiet" }),
    result.kind !== "prediction" && button("Picture", () => void keep(`v1/jobs/${result.job}/map`, `${result.kind}.svg`), { class: "quiet" }),
    result.kind === "check" && (token() ? button("Report", () => void keep(report, "check.html"), { class: "quiet" }) : h("a", { href: address(report), target: "_blank", rel: "noopener" }, "Report for the meeting")),
    button("Keep for comparison", () => store.set({ other: result }), { class: "quiet", "data-do": "keep" }),
    store.state.other && button("Forget the kept one", () => store.set({ other: null }), { class: "quiet" }),
  );
}

export function verdictPanel(target: HTMLElement, map: TerrainMap): void {
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
      result.fewer.length > 0 && h("ul", {}, result.fewer.map((why) => h("li", {}, why))),
      route && [
        h("div", { class: `banner ${route.verdict}`, "data-verdict": route.verdict }, verdictWords[route.verdict], h("small", {}, `${route.title}, ${words(result.rover)}`)),
        h("h3", {}, "Why"),
        h("ul", { class: "reasons" }, route.reasons.map((reason) => h("li", {}, reason))),
        h("h3", {}, "What would change it"),
        h("ul", {}, change(route).map((line) => h("li", {}, line))),
        result.driven.length > 0 && driven(result),
        comparison(result, other),
        h("h3", {}, "Rules"),
        h("p", { class: "hint" }, "The value that comes nearest to the limit: median of the draws of the ground (5 to 95 %)."),
        route.rules.length > 0 ? rulesTable(route, map) : h("p", {}, "There were no draws of the ground to judge by."),
        route.notes.length > 0 && h("details", {}, h("summary", {}, "How the plan ranked it"), h("ul", {}, route.notes.map((note) => h("li", {}, note)))),
        exports(result),
        h("details", {}, h("summary", {}, "Where it comes from"), h("dl", {}, provenance(result).flatMap(([k, v]) => [h("dt", {}, k), h("dd", {}, v)]))),
      ],
    );
  });
}

function provenance(result: Result): [string, string][] {
  const p = result.provenance;
  return [
    ["Job", `${result.kind} ${result.job}`],
    ["Asked", result.created],
    ["Slipway", p.slipway ?? "–"],
    ["Terrain", `${result.terrain}, fingerprint ${p.terrain_fingerprint ?? "–"}`],
    ["Seed", String(p.seed ?? "–")],
    ["Soils", `${words(p.legend ?? "–")}: ${p.soil_assumption ?? ""}`],
  ];
}

