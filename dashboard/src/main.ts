// Puts the page together.
import "ol/ol.css";
import "uplot/dist/uPlot.min.css";
import "./styles/page.css";
import { get, ServiceError, type CostTerm, type Effect, type Rover, type RuleSet, type Terrain, type TerrainDocument } from "./api/client";
import { button, fill, h, select } from "./dom";
import { keyboard } from "./keyboard";
import { TerrainMap } from "./map/terrain_map";
import { checkPanel } from "./panels/check";
import { drivesPanel } from "./panels/drives";
import { jobView } from "./panels/job_view";
import { jobsPanel } from "./panels/jobs";
import { layersPanel } from "./panels/layers";
import { planPanel } from "./panels/plan";
import { takesUploads, terrainUpload } from "./panels/uploads";
import { verdictPanel } from "./panels/verdict";
import { readLink, writeLink, type Link } from "./permalink";
import { reportPage } from "./report";
import { reopenRiskMap } from "./map/risk_map";
import { loading, problemView } from "./problem";
import { ProfileCharts } from "./profile/charts";
import { readout } from "./map/readout";
import { help, signIn, theme } from "./session";
import { store, type Tab } from "./state";
import { reopen } from "./work";

const link: Link = readLink(location.hash);
const tabs: [Tab, string][] = [["plan", "Plan"], ["check", "Check"], ["jobs", "Jobs"], ["drives", "Drives"]];

const terrainChoice = h("span", { class: "terrain" });
const terrainMore = h("span");
const tabList = h("div", { role: "tablist", "aria-label": "What to do" });
const note = h("div", { class: "note" });
const mapElement = h("div", { class: "map", tabindex: 0, role: "application", "aria-label": "Map of the terrain; arrows move it, plus and minus zoom" });
const readoutLine = h("div", { class: "map-readout", role: "status", "aria-live": "off" });
const layerBox = h("div", { class: "layers" });
const profile = h("div", { class: "profile" });
const panels = Object.fromEntries(tabs.map(([tab]) => [tab, h("div", { class: "panel", id: `panel-${tab}`, role: "tabpanel", "aria-labelledby": `tab-${tab}` })])) as unknown as Record<Tab, HTMLElement>;
const work = h("div", { class: "work" });
const verdict = h("div", { class: "verdict" });

const ownTerrain = terrainUpload((name) => {
  link.terrain = name;
  void load();
});
const redraw = () => charts.draw(store.state);
const session = signIn(() => void load());
const keyHelp = help();
document.body.append(
  h("header", {}, h("h1", {}, "Slipway"), tabList, terrainChoice, terrainMore, h("span", { class: "spring" }), session.button, theme(redraw), keyHelp.button),
  h("main", {}, h("div", { class: "side" }, note, ...Object.values(panels), work, verdict), h("div", { class: "stage" }, h("div", { class: "map-box" }, mapElement, layerBox, readoutLine), profile)),
);

const map = new TerrainMap(mapElement, (coordinate) => readout(readoutLine, map, coordinate));
const charts = new ProfileCharts(profile);
planPanel(panels.plan);
checkPanel(panels.check, map);
jobsPanel(panels.jobs);
drivesPanel(panels.drives);
jobView(work);
const print = reportPage(map, redraw);
verdictPanel(verdict, map, () => void print());
layersPanel(layerBox, map);
keyboard(map, mapElement, charts, keyHelp.open);

for (const [tab, words] of tabs) {
  const press = h("button", { type: "button", role: "tab", id: `tab-${tab}`, "aria-controls": `panel-${tab}`, onclick: () => store.set({ tab, tool: "look" }) }, words);
  press.addEventListener("keydown", (event) => {
    const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
    if (!step) return;
    const next = tabs[(tabs.findIndex(([t]) => t === tab) + step + tabs.length) % tabs.length]![0];
    store.set({ tab: next, tool: "look" });
    document.getElementById(`tab-${next}`)?.focus();
  });
  tabList.append(press);
}
store.on(["tab"], ({ tab }) => {
  for (const [name] of tabs) {
    panels[name].hidden = name !== tab;
    const press = document.getElementById(`tab-${name}`)!;
    press.setAttribute("aria-selected", String(name === tab));
    press.tabIndex = name === tab ? 0 : -1;
  }
});
store.on(["result"], ({ result }) => {
  if (result) map.showRoutes();
});
store.on(["terrains", "terrain"], ({ terrains, terrain }) => {
  if (terrains.length === 0) return;
  const choice = select(terrains.map((t) => ({ value: t.name!, text: t.title ?? t.name! })), terrain?.terrain?.name ?? "", (name) => void openTerrain(name));
  choice.setAttribute("aria-label", "Terrain");
  fill(terrainChoice, choice);
});

let linkTimer = 0;
function keepLink(): void {
  clearTimeout(linkTimer);
  linkTimer = window.setTimeout(() => {
    if (store.state.terrain) history.replaceState(null, "", `#${writeLink(store.state, map.view)}`);
  }, 200);
}
store.on(["tab", "terrain", "drawn", "options", "layers", "routeColour", "result", "job", "route", "risk", "followed"], keepLink);
map.map.on("moveend", keepLink);
window.addEventListener("hashchange", () => {
  if (location.hash.slice(1) !== writeLink(store.state, map.view)) location.reload();
});

// The drives' own ground, where the service has its map.
store.on(["followed"], ({ followed, terrains, terrain, tab }) => {
  if (tab === "drives" && followed.terrain && followed.terrain !== terrain?.terrain?.name && terrains.some((t) => t.name === followed.terrain)) void openTerrain(followed.terrain);
});

async function openTerrain(name: string): Promise<void> {
  try {
    const terrain = await get<TerrainDocument>(`v1/terrains/${encodeURIComponent(name)}`);
    store.set({ terrain, result: null, other: null, hover_m: null, options: { ...store.state.options, legend: link.terrain === name ? store.state.options.legend : "" } });
  } catch (error) {
    fill(note, problemView(error, () => void openTerrain(name)));
  }
}

async function load(): Promise<void> {
  fill(note, loading("Asking the service what there is"));
  try {
    const [{ terrains }, { rovers }, { rules }, { cost_terms }, { effects }] = await Promise.all([
      get<{ terrains: Terrain[] }>("v1/terrains"),
      get<{ rovers: Rover[] }>("v1/rovers"),
      get<{ rules: RuleSet[] }>("v1/rules"),
      get<{ cost_terms: CostTerm[] }>("v1/planners"),
      get<{ effects: Effect[] }>("v1/effects"),
    ]);
    const rover = rovers.find((r) => r.name === store.state.options.rover)?.name ?? rovers.find((r) => r.name === "msl-class")?.name ?? rovers[0]?.name ?? "";
    store.set({ terrains, rovers, rules, costTerms: cost_terms, effects, options: { ...store.state.options, rover } });
    fill(note);
    if (terrainMore.childElementCount === 0 && (await takesUploads())) fill(terrainMore, button("Add a terrain", ownTerrain.open, { class: "quiet", "data-do": "add-terrain" }));
    if (terrains.length === 0) {
      fill(note, h("p", { class: "empty" }, "The service has no terrain yet. Add one, or import it with slipway terrain import."));
      return;
    }
    const wanted = terrains.find((t) => t.name === link.terrain)?.name ?? terrains[0]!.name!;
    if (store.state.terrain?.terrain?.name !== wanted) await openTerrain(wanted);
    if (link.view) map.view = link.view;
    if (link.job) await reopen(link.job);
    if (link.job && link.view) map.view = link.view;
    for (const { kind, opacity, job } of link.risk) void reopenRiskMap(kind, opacity, job);
    link.job = "";
    link.risk = [];
    link.view = null;
  } catch (error) {
    fill(note, problemView(error, () => void load()));
    if (error instanceof ServiceError && error.status === 401) session.open();
  }
}

window.addEventListener("offline", () => fill(note, h("div", { class: "problem", role: "alert" }, h("strong", {}, "No network"), h("p", {}, "What is shown stays; new work needs the service."), button("Try again", () => void load()))));
window.addEventListener("online", () => void load());
void load();
