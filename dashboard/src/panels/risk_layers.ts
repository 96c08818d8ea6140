// Maps of risk of the ground, as layers: which are shown, how strongly, of what they were made, and what their colours mean.
import { button, field, fill, h, swatch } from "../dom";
import { number } from "../format";
import { addRiskMap, opacityOf, removeRiskMap, riskClasses, riskTitles } from "../map/risk_map";
import type { RiskKind, RiskMap } from "../map/risk_types";
import type { TerrainMap } from "../map/terrain_map";
import { store, type State } from "../state";
import { keep } from "../work";
import { riskRequest, type RiskSettings } from "./request";

const kinds = Object.keys(riskTitles) as RiskKind[];
const ofWay: Partial<Record<RiskKind, "goal" | "start">> = { cost_to_go: "goal", reachable: "start" };

export function riskLayers(target: HTMLElement, legends: HTMLElement, map: TerrainMap): void {
  const heading = h("input", { type: "number", min: -360, max: 360, step: "any", placeholder: "worst", id: "risk-heading" });
  const distance = h("input", { type: "number", min: 1, max: 10000, step: "any", value: 10, id: "risk-distance" });
  const budget = h("input", { type: "number", min: 0.1, step: "any", value: 15, id: "risk-budget" });
  const believe = h("input", { type: "checkbox", id: "risk-believe" });
  const settings = (): RiskSettings => ({
    heading_deg: heading.value.trim() === "" ? null : Number(heading.value),
    distance_m: Number(distance.value) || 10,
    believe_unknown: believe.checked,
    budget_wh: Number(budget.value) || 15,
    view: map.extent(),
  });
  const rows = kinds.map((kind) => riskRow(kind, settings));
  const note = h("p", { class: "hint" });
  fill(target,
    rows.map((row) => row.element), note,
    h("details", {}, h("summary", {}, "What they are of"),
      h("div", { class: "columns" }, field("Heading, deg from east", heading), field("Drive, m", distance)),
      h("div", { class: "columns" }, field("Budget of reach, Wh", budget), h("label", { class: "check" }, believe, "unknown ground by its belief"))));
  store.on(["risk", "options", "drawn", "terrain"], (state) => {
    const outdated = state.risk.some((m) => isOutdated(m, state, settings()));
    note.textContent = outdated ? "Rover, rules, zones or belief have changed since: ↻ makes the map anew." : "";
    for (const row of rows) row.show(state);
  });
  store.on(["risk", "palette", "bounds"], (state) => fill(legends, state.risk.filter((m) => m.document).map((m) => riskLegend(m, state))));
  // A map of another terrain lies elsewhere.
  let terrain = store.state.terrain?.terrain?.name;
  store.on(["terrain"], (state) => {
    const now = state.terrain?.terrain?.name;
    if (terrain && now !== terrain) for (const m of state.risk) removeRiskMap(m.kind);
    terrain = now;
  });
}

/** Whether the form would ask for another map by now. What the map shows does not count. */
function isOutdated(map: RiskMap, state: State, settings: RiskSettings): boolean {
  if (!map.document || map.request === JSON.stringify(map.document.request)) return false;
  const { extent: _, ...now } = riskRequest(map.kind, settings, state) as { extent?: unknown };
  const { extent: __, ...then } = JSON.parse(map.request) as { extent?: unknown };
  return JSON.stringify(now) !== JSON.stringify(then);
}

function riskRow(kind: RiskKind, settings: () => RiskSettings): { element: HTMLElement; show: (state: State) => void } {
  const box = h("input", { type: "checkbox", id: `risk-${kind}`, "data-risk": kind, onchange: () => (box.checked ? void addRiskMap(kind, settings()) : removeRiskMap(kind)) });
  const range = h("input", { type: "range", min: 0.05, max: 1, step: 0.05, "aria-label": `Opacity of ${riskTitles[kind].toLowerCase()}`, oninput: () => opacityOf(kind, Number(range.value)) });
  const progress = h("progress", { max: 1, "aria-label": `${riskTitles[kind]} is being made` });
  const again = button("↻", () => void addRiskMap(kind, settings()), { class: "quiet tiny", "aria-label": `Make ${riskTitles[kind].toLowerCase()} anew`, title: "Make it anew" });
  const file = button("⤓", () => {
    const job = store.state.risk.find((m) => m.kind === kind)?.job;
    if (job) void keep(`v1/jobs/${job}/map.tif`, `${kind}.tif`);
  }, { class: "quiet tiny", "aria-label": `${riskTitles[kind]} as a GeoTIFF`, title: "Keep as a GeoTIFF", "data-geotiff": kind });
  const element = h("div", { class: "layer" }, h("label", {}, box, riskTitles[kind]), h("span", { class: "layer-more" }, range, progress, again, file));
  return {
    element,
    show: (state) => {
      const map = state.risk.find((m) => m.kind === kind);
      const missing = ofWay[kind] && !state.drawn[ofWay[kind]!];
      box.checked = map !== undefined;
      box.disabled = !map && !!missing;
      element.title = missing ? `Set a ${ofWay[kind]} first` : "";
      const there = map?.document != null;
      range.hidden = again.hidden = file.hidden = !there;
      progress.hidden = map === undefined || there;
      if (map?.progress != null) progress.value = map.progress;
      if (map) range.value = String(map.opacity);
      again.hidden ||= !map || !isOutdated(map, state, settings());
    },
  };
}

function riskLegend(map: RiskMap, state: State): HTMLElement {
  const document = map.document!;
  const { classes } = riskClasses(document, state);
  const unknown = document.classes ? "no elevation" : "unknown ground, or no elevation";
  const { lowest, highest } = document.statistics;
  const asked = document.request;
  return h("div", { "data-risk-legend": map.kind },
    h("p", { class: "hint" }, `${riskTitles[map.kind]}${document.unit && document.unit !== "1" ? `, ${document.unit}` : ""}: ${asked.rover}${asked.heading_deg !== undefined ? `, heading ${number(asked.heading_deg)}°` : ""}${asked.distance_m !== undefined ? `, ${number(asked.distance_m)} m` : ""}${lowest !== undefined && !document.classes ? `; ${number(lowest)} to ${number(highest)}` : ""}`),
    h("ul", { class: "legend" }, classes.map((c) => h("li", {}, swatch(c.colour, c.hatched ? "hatched" : ""), c.label)), classes.some((c) => c.hatched) ? null : h("li", {}, swatch(null), unknown)));
}
