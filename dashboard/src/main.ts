// Puts the page together.
import { get, hasEnded, ServiceError, type Terrain, type TerrainDocument } from "./api/client";
import { takeFirst, terrainAddress } from "./api/first";
import { button, fill, h, select } from "./dom";
import { keyboard } from "./keyboard";
import { TerrainMap } from "./map/terrain_map";
import { checkPanel } from "./panels/check";
import { daySign } from "./panels/day";
import { drivesPanel } from "./panels/drives";
import { jobView } from "./panels/job_view";
import { jobsPanel } from "./panels/jobs";
import { layersPanel } from "./panels/layers";
import { mapVerdict } from "./panels/map_verdict";
import { planPanel } from "./panels/plan";
import { staleness } from "./panels/request";
import { takesUploads, terrainUpload } from "./panels/uploads";
import { verdictPanel } from "./panels/verdict";
import { isAboutRoutes } from "./result";
import { readLink, writeLink, type Link } from "./permalink";
import { reportPage } from "./report";
import { reopenRiskMap } from "./map/risk_map";
import { loading, problemView } from "./problem";
import { ProfileCharts } from "./profile/charts";
import { leanView } from "./map/lean";
import { readout } from "./map/readout";
import { help, signIn, theme } from "./session";
import { firstTool, store, type Drawn, type Place, type Ring, type Tab, type Tool } from "./state";
import { reopen } from "./work";

const link: Link = readLink(location.hash);
const tabs: [Tab, string][] = [["plan", "Plan"], ["check", "Check"], ["jobs", "Jobs"], ["drives", "Drives"]];

const terrainChoice = h("span", { class: "terrain" });
const terrainMore = h("span");
const tabList = h("div", { role: "tablist", "aria-label": "What to do" });
const note = h("div", { class: "note" });
const mapElement = h("div", { class: "map", tabindex: 0, role: "application", "aria-label": "Map of the terrain; arrows move it, plus and minus zoom" });
const readoutLine = h("div", { class: "map-readout", role: "status", "aria-live": "off" });
const aim = h("div", { class: "map-aim", role: "status" });
const layerBox = h("div", { class: "layers" });
const profile = h("div", { class: "profile" });
const onMap = h("div", { class: "map-verdict", role: "status", "aria-live": "polite" });
const ofDay = h("div", { class: "map-sun", "data-sun-sign": true });
const lean = h("div", { class: "map-lean off" });
const frame = h("div", { class: "map-frame" }, mapElement, h("div", { class: "map-top" }, aim, onMap, ofDay), lean, readoutLine);
const stage = h("div", { class: "stage bare" }, h("div", { class: "map-box" }, frame, layerBox), profile);
let wasEmpty = true;
const panels = Object.fromEntries(tabs.map(([tab]) => [tab, h("div", { class: "panel", id: `panel-${tab}`, role: "tabpanel", "aria-labelledby": `tab-${tab}` })])) as unknown as Record<Tab, HTMLElement>;
const work = h("div", { class: "work" });
const verdict = h("div", { class: "verdict" });

const side = h("div", { class: "side" }, note, ...Object.values(panels), work, verdict);

const ownTerrain = terrainUpload((name) => {
  link.terrain = name;
  void load();
});
const redraw = () => charts.draw(store.state);
const session = signIn(() => void load());
const keyHelp = help();
document.body.append(
  h("header", {}, h("h1", {}, "Slipway"), tabList, terrainChoice, terrainMore, h("span", { class: "spring" }), session.button, theme(redraw), keyHelp.button),
  h("main", {}, side, stage),
);

// First, so that all that is drawn knows it.
store.on(["result", "drawn", "options", "terrain", "rules", "typed"], (state) => store.set({ stale: staleness(state) }));
const controls = () => [...frame.querySelectorAll<HTMLElement>(".ol-zoom, .scale-bar, .map-top > *, .map-lean, .map-readout"), layerBox];
const map = new TerrainMap(mapElement, (coordinate) => readout(readoutLine, map, coordinate), controls);
const charts = new ProfileCharts(profile);
// Each is made when it is first looked at.
const makePanel: Record<Tab, ((target: HTMLElement) => void) | null> = { plan: (target) => planPanel(target, map), check: (target) => checkPanel(target, map), jobs: jobsPanel, drives: drivesPanel };
jobView(work);
const print = reportPage(map, redraw);
verdictPanel(verdict, map, () => void print());
layersPanel(layerBox, map);
mapVerdict(onMap);
daySign(ofDay);
leanView(lean);
keyboard(map, mapElement, charts, keyHelp.open);

function openTab(tab: Tab): void {
  store.set({ tab, tool: firstTool({ ...store.state, tab }) });
}
for (const [tab, words] of tabs) {
  const press = h("button", { type: "button", role: "tab", id: `tab-${tab}`, "aria-controls": `panel-${tab}`, onclick: () => openTab(tab) }, words);
  press.addEventListener("keydown", (event) => {
    const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
    if (!step) return;
    const next = tabs[(tabs.findIndex(([t]) => t === tab) + step + tabs.length) % tabs.length]![0];
    openTab(next);
    document.getElementById(`tab-${next}`)?.focus();
  });
  tabList.append(press);
}
store.on(["stale", "job", "result"], ({ stale, job }) => profile.classList.toggle("of-before", stale === "all" || (job !== null && isAboutRoutes(job.kind) && !hasEnded(job))));
store.on(["tab"], ({ tab }) => {
  makePanel[tab]?.(panels[tab]);
  makePanel[tab] = null;
  for (const [name] of tabs) {
    panels[name].hidden = name !== tab;
    const press = document.getElementById(`tab-${name}`)!;
    press.setAttribute("aria-selected", String(name === tab));
    press.tabIndex = name === tab ? 0 : -1;
  }
});
// What the next click on the map does.
const aims: Partial<Record<Tool, string>> = {
  start: "Click where the drive starts",
  goal: "Click where it is to go",
  waypoint: "Click the places to pass, in their order",
  keep_out: "Click the corners of ground to keep out of; a double click ends",
  keep_in: "Click the corners of ground to stay in; a double click ends",
  corner: "Click the corners of the path",
};
store.on(["tool", "tab", "followed", "terrains"], ({ tool, tab, followed, terrains }) => {
  const bare = tab === "drives" && followed.diagnosis !== null && followed.terrain !== "" && !terrains.some((t) => t.name === followed.terrain);
  fill(aim, bare ? `Ground of the drives: ${followed.terrain.replaceAll("_", " ")}` : aims[tool], !bare && aims[tool] && !["start", "goal"].includes(tool) ? button("Done", () => (map.stopDrawing(), store.set({ tool: "look" })), { class: "quiet tiny", "data-do": "done", title: "Key Escape" }) : null);
});
// Without a profile the map has its room.
store.on(["result", "tab", "followed"], ({ result, tab, followed }) => {
  const empty = tab === "drives" ? !followed.diagnosis && !followed.watch && !result : !result;
  if (stage.classList.toggle("bare", empty) !== wasEmpty) map.map.updateSize();
  wasEmpty = empty;
});
let brought = "";
store.on(["result"], ({ result }) => {
  if (!result || result.job === brought) return;
  brought = result.job;
  // After a drag the page stays where it is.
  if (result.quiet) {
    map.map.once("postrender", () => map.keepInSight());
    return;
  }
  map.showRoutes();
  bringUp(verdict);
});
let answered = "";
store.on(["followed"], ({ followed }) => {
  const now = followed.watch?.job ?? followed.diagnosis?.job ?? "";
  if (now && now !== answered) bringUp(panels.drives.querySelector<HTMLElement>(".answers")!);
  answered = now;
});
/** An answer below a long form might not be seen. */
function bringUp(answer: HTMLElement): void {
  if (side.scrollHeight <= side.clientHeight) answer.scrollIntoView();
  else side.scrollTop += answer.getBoundingClientRect().top - side.getBoundingClientRect().top - 8;
}
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
store.on(["tab", "terrain", "drawn", "options", "layers", "routeColour", "result", "job", "route", "risk", "followed", "day"], keepLink);
map.map.on("moveend", keepLink);
window.addEventListener("hashchange", () => {
  if (location.hash.slice(1) !== writeLink(store.state, map.view)) location.reload();
});

// The drives' own ground, where the service has its map.
store.on(["followed"], ({ followed, terrains, terrain, tab }) => {
  if (tab === "drives" && followed.terrain && followed.terrain !== terrain?.terrain?.name && terrains.some((t) => t.name === followed.terrain)) void openTerrain(followed.terrain);
});

async function openTerrain(name: string, asked?: Promise<TerrainDocument>): Promise<void> {
  try {
    const terrain = await (asked ?? get<TerrainDocument>(terrainAddress(name)));
    const moved = store.state.terrain !== null && store.state.terrain.terrain?.name !== name;
    store.set({ terrain, result: null, other: null, hover_m: null, options: { ...store.state.options, legend: link.terrain === name ? store.state.options.legend : "" } });
    if (moved) leaveOutside(terrain.terrain!.extent!);
    store.set({ tool: firstTool(store.state) });
  } catch (error) {
    fill(note, problemView(error, () => void openTerrain(name)));
  }
}

/** What was drawn on another terrain and does not lie on this one goes; undo brings it back. */
function leaveOutside(e: NonNullable<Terrain["extent"]>): void {
  const lies = (x: number, y: number) => x >= e.west_m! && x <= e.east_m! && y >= e.south_m! && y <= e.north_m!;
  const place = (p: Place | null) => (p && lies(p.x_m, p.y_m) ? p : null);
  const { drawn } = store.state;
  const rings = (list: Ring[]) => list.filter((ring) => ring.some(([x, y]) => lies(x, y)));
  const left: Drawn = {
    start: place(drawn.start),
    goal: place(drawn.goal),
    waypoints: drawn.waypoints.filter(place),
    path: drawn.path.every(place) ? drawn.path : [],
    keep_out: rings(drawn.keep_out),
    keep_in: rings(drawn.keep_in),
  };
  if (JSON.stringify(left) !== JSON.stringify(drawn)) store.draw(left);
}

/** Whether a map names the soil of some of its ground: nothing can be called safe on a terrain without. */
const hasKnownSoil = (terrain: Terrain): boolean => (terrain.soil?.legend ?? []).some((entry) => entry.soil);

async function offerUploads(): Promise<void> {
  if (terrainMore.childElementCount === 0 && (await takesUploads())) fill(terrainMore, button("Add a terrain", ownTerrain.open, { class: "quiet", "data-do": "add-terrain" }));
}

async function load(): Promise<void> {
  fill(note, loading("Asking the service what there is"));
  const first = takeFirst(link.terrain);
  try {
    // A link's ground is shown before the lists are there. Of one that can't be read the error is told below, when it is asked for again.
    const linked = await first.terrain?.catch(() => null);
    if (linked && !store.state.terrain) {
      await openTerrain(link.terrain, Promise.resolve(linked));
      if (link.view) map.view = link.view;
    }
    const [{ terrains }, { rovers }, { rules }, { cost_terms }, { effects }] = await first.lists;
    const rover = rovers.find((r) => r.name === store.state.options.rover)?.name ?? rovers.find((r) => r.name === "msl-class")?.name ?? rovers[0]?.name ?? "";
    store.set({ terrains, rovers, rules, costTerms: cost_terms, effects, options: { ...store.state.options, rover } });
    fill(note);
    void offerUploads().catch((error: unknown) => fill(note, problemView(error)));
    if (terrains.length === 0) {
      fill(note, h("p", { class: "empty" }, "The service has no terrain yet. Add one, or import it with slipway terrain import."));
      return;
    }
    const wanted = (terrains.find((t) => t.name === link.terrain) ?? terrains.find(hasKnownSoil) ?? terrains[0]!).name!;
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
