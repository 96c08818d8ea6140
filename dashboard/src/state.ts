// What the page shows, in one place; parts of the page listen to the keys that they draw.
import type { CostTerm, Campaign, Diagnosis, Effect, Job, Limits, PlanRequest, Rover, RuleSet, Terrain, TerrainDocument, Watch } from "./api/client";
import type { RiskMap } from "./map/risk_types";
import type { Result } from "./result";
import type { Sol } from "./sky";

export interface Place {
  x_m: number;
  y_m: number;
}
export type Ring = [number, number][];

export type Tab = "plan" | "check" | "jobs" | "drives";
export type Tool = "look" | "start" | "goal" | "waypoint" | "keep_out" | "keep_in" | "corner";
export type RouteColour = "risk" | "slip" | "limits" | "plain";
export const routeColours: RouteColour[] = ["risk", "slip", "limits", "plain"];
export type LayerName = "slope" | "soil" | "unknown";

/** What is drawn on the map and asked for: what undo takes back. */
export interface Drawn {
  start: Place | null;
  goal: Place | null;
  waypoints: Place[];
  keep_out: Ring[];
  keep_in: Ring[];
  path: Place[]; // of a check
}

export interface Options {
  rover: string;
  rules: string; // "": the service's own limits
  legend: string; // "": the terrain's first
  limits: Limits; // those that were moved away from the rules'
  weights: Record<string, number>; // those that differ from the service's
  routes: number;
  seed: number;
  model: Model | null; // that a diagnosis has corrected
  effects: { name: string; on: boolean; parameters: Record<string, number> }[]; // that differ from the rover's own
  failedWheels: Record<string, "locked" | "free" | "off">;
  confidence: number | null; // that a mapped class is the soil that the legend gives; null: the terrain's own
  unknownSoil: string; // "": the belief about unknown ground
  draws: number | null; // of the ground; null: as many as the verdict needs
  departure: Departure; // what is asked of the day
  sky: SkyTable | null; // that the opened request brought
  startError: PlanRequest["start_error"] | null; // the same
}

/** Sun and Earth over the start, as a request has them: kept and sent again as they are, on the same terrain. */
export interface SkyTable {
  terrain: string;
  moments: NonNullable<NonNullable<PlanRequest["departure"]>["sky"]>;
}

/** Texts of the form, by the request's keys; times in UTC. Without "from" nothing is asked. */
export type Departure = Record<string, string>;

/** The time of day that the map shows. */
export interface Day {
  at_ms: number;
  shows: "" | "shadow" | "share";
}

export interface Model {
  diagnosis: string; // job
  campaign: string;
  rover: string; // in whose place the corrected one drives
  ground: string[]; // soils of the terrain that are the campaign's
}

/** What of the answer on the screen is not what the form asks: nothing, only the limits that it is judged by, or all of it. */
export type Stale = "" | "limits" | "all";

/** How a gap was left: by the model as it was, re-tuned, with the effects that were found. */
export type Rung = "nominal" | "retuned" | "with_effects";

/** Recorded drives and what they showed. */
export interface Followed {
  diagnosis: { job: string; document: Diagnosis } | null;
  watch: { job: string; document: Watch } | null;
  rung: Rung;
  terrain: string; // of the campaign, that is shown
  drive: string; // chosen; "": all
  window: number | null; // of the diagnosis, that the pointer is at
}
export const nothingFollowed: Followed = { diagnosis: null, watch: null, rung: "nominal", terrain: "", drive: "", window: null };

export interface State {
  tab: Tab;
  terrains: Terrain[];
  rovers: Rover[];
  rules: RuleSet[];
  costTerms: CostTerm[];
  effects: Effect[];
  campaigns: Campaign[];
  followed: Followed;
  terrain: TerrainDocument | null;
  drawn: Drawn;
  options: Options;
  tool: Tool;
  layers: Record<LayerName, number>; // opacity; 0: not shown
  swipe: number | null; // share of the map's width up to which the layers are shown
  routeColour: RouteColour;
  palette: string[]; // of the classes of risk and slip
  bounds: Record<"risk" | "slip", number[]>; // between the classes
  risk: RiskMap[]; // maps of risk that are shown or under way
  jobs: Job[] | null;
  job: Job | null; // that is followed
  result: Result | null;
  stale: Stale; // of the result
  typed: string; // commands and telemetry of the check's form
  other: Result | null; // kept beside it, for comparison
  route: number; // index of the chosen route of the result
  compared: number | null; // index of a second route of it
  hover_m: number | null; // place along the chosen route
  day: Day;
  sol: Sol | null; // the sky of the sol that it lies in
  error: unknown;
}

/** What a click on the map does where nobody has said it: it places what a plan lacks. */
export const firstTool = ({ tab, terrain, drawn }: State): Tool => (tab !== "plan" || !terrain ? "look" : !drawn.start ? "start" : !drawn.goal ? "goal" : "look");

export const nothingDrawn: Drawn = { start: null, goal: null, waypoints: [], keep_out: [], keep_in: [], path: [] };
/** Blue to dark red: apart by lightness and hue for colour-blind eyes too [ColorBrewer RdYlBu]. */
export const usualPalette = ["#2c7bb6", "#abd9e9", "#fdae61", "#d7191c", "#67001f"];
export const palettes: Record<string, string[]> = {
  "blue to red": usualPalette,
  viridis: ["#fde725", "#5ec962", "#21918c", "#3b528b", "#440154"],
  cividis: ["#fee838", "#bcae6c", "#7d7c78", "#414d6b", "#00224e"],
  "grey, for paper": ["#f2f2f2", "#c4c4c4", "#8c8c8c", "#525252", "#111111"],
};
export const usualBounds = { risk: [0.001, 0.01, 0.1, 0.5], slip: [0.1, 0.2, 0.4, 0.6] };

type Listener = (state: State) => void;

class Store {
  private listeners: { keys: (keyof State)[]; run: Listener }[] = [];
  private past: Drawn[] = [];
  state: State = {
    tab: "plan",
    terrains: [],
    rovers: [],
    rules: [],
    costTerms: [],
    effects: [],
    campaigns: [],
    followed: nothingFollowed,
    terrain: null,
    drawn: nothingDrawn,
    options: { rover: "", rules: "", legend: "", limits: {}, weights: {}, routes: 3, seed: 1, model: null, effects: [], failedWheels: {}, confidence: null, unknownSoil: "", draws: null, departure: {}, sky: null, startError: null },
    tool: "look",
    layers: { slope: 0, soil: 0, unknown: 0.6 },
    swipe: null,
    routeColour: "risk",
    palette: usualPalette,
    bounds: usualBounds,
    risk: [],
    jobs: null,
    job: null,
    result: null,
    stale: "",
    typed: "",
    other: null,
    route: 0,
    compared: null,
    hover_m: null,
    day: { at_ms: Date.now(), shows: "" },
    sol: null,
    error: null,
  };

  set(change: Partial<State>): void {
    const changed = (Object.keys(change) as (keyof State)[]).filter((key) => this.state[key] !== change[key]);
    if (changed.length === 0) return;
    this.state = { ...this.state, ...change };
    for (const listener of this.listeners) if (listener.keys.some((key) => changed.includes(key))) listener.run(this.state);
  }

  /** Runs now and whenever one of the keys has changed. */
  on(keys: (keyof State)[], run: Listener): void {
    this.listeners.push({ keys, run });
    run(this.state);
  }

  draw(change: Partial<Drawn>): void {
    this.remember();
    this.move(change);
  }

  /** What is drawn now is what undo brings back. */
  remember(): void {
    this.past.push(this.state.drawn);
    if (this.past.length > 200) this.past.shift();
  }

  /** A step of a drag: undo takes the drag back as one. */
  move(change: Partial<Drawn>): void {
    this.set({ drawn: { ...this.state.drawn, ...change } });
  }

  undo(): boolean {
    const before = this.past.pop();
    if (before) this.set({ drawn: before, tool: firstTool({ ...this.state, drawn: before }) });
    return before !== undefined;
  }

  follow(change: Partial<Followed>): void {
    this.set({ followed: { ...this.state.followed, ...change } });
  }

  option(change: Partial<Options>): void {
    this.set({ options: { ...this.state.options, ...change } });
  }
}

export const store = new Store();
