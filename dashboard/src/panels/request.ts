// What is asked for, as the API takes it.
import type { CheckRequest, Limits, MapRequest, PlanRequest } from "../api/client";
import type { RiskKind } from "../map/risk_types";
import { store, type Departure, type SkyTable, type Stale, type State } from "../state";
import { hasSky, skyTable } from "./departure";

/** The limits that the form asks for: the chosen rules', with those that were moved. */
function limitsOf(state: State): { limits?: Limits } {
  const limits = { ...state.rules.find((r) => r.name === state.options.rules)?.limits, ...state.options.limits };
  return Object.keys(limits).length > 0 ? { limits } : {};
}

/** Limits, checks and bars of the chosen set of rules: plans and maps take them one by one, checks by the set's name. */
function rulesOf(state: State): Pick<PlanRequest, "limits" | "checks" | "bars"> {
  const set = state.rules.find((r) => r.name === state.options.rules);
  return { ...(set?.checks ? { checks: set.checks } : {}), ...(set?.bars ? { bars: set.bars } : {}), ...limitsOf(state) };
}

/** What of the rover and of the belief differs from what the service takes by itself. */
function settings({ options }: State): Pick<PlanRequest, "effects" | "failed_wheels" | "confidence" | "unknown_soil" | "model"> {
  const { model } = options;
  return {
    ...(options.effects.length > 0 ? { effects: options.effects.map(({ name, on, parameters }) => ({ name, ...(Object.keys(parameters).length > 0 ? { parameters } : {}), ...(on ? {} : { on }) })) } : {}),
    ...(Object.keys(options.failedWheels).length > 0 ? { failed_wheels: options.failedWheels } : {}),
    ...(options.confidence !== null ? { confidence: options.confidence } : {}),
    ...(options.unknownSoil ? { unknown_soil: options.unknownSoil } : {}),
    ...(model ? { model: { diagnosis: model.diagnosis, ...(model.ground.length > 0 ? { ground: model.ground } : {}) } } : {}),
  };
}

function shared(state: State) {
  const { options, drawn } = state;
  return {
    terrain: state.terrain?.terrain?.name ?? "",
    rover: options.rover,
    ...(drawn.keep_out.length > 0 ? { keep_out: drawn.keep_out } : {}),
    ...(drawn.keep_in.length > 0 ? { keep_in: drawn.keep_in } : {}),
    ...(options.legend ? { legend: options.legend } : {}),
    ...settings(state),
    ...(options.seed !== 1 ? { seed: options.seed } : {}),
  };
}

const weights = ({ options }: State): Pick<PlanRequest, "weights"> => (Object.keys(options.weights).length > 0 ? { weights: options.weights } : {});

const draws = ({ options }: State): Pick<PlanRequest, "draws"> => (options.draws !== null ? { draws: options.draws } : {});

const air = ["coldest_c", "warmest_c"];

/** What is asked of the day. */
function departureOf(state: State): Pick<PlanRequest, "departure"> {
  const { from, to, arrive_by, ...numbers } = state.options.departure;
  if (!from || !hasSky(state)) return {};
  const table = skyTable(state);
  const given = (of_air: boolean) => Object.fromEntries(Object.entries(numbers).filter(([key]) => air.includes(key) === of_air).map(([key, value]) => [key, Number(value)]));
  const of_air = given(true) as NonNullable<NonNullable<PlanRequest["departure"]>["air"]>;
  return { departure: { from, ...(to ? { to } : {}), ...(arrive_by ? { arrive_by } : {}), ...given(false), ...(Object.keys(of_air).length > 0 ? { air: of_air } : {}), ...(table ? { sky: table.moments } : {}) } };
}

/** The same as the form has it. */
export function formOf(departure: PlanRequest["departure"]): Departure {
  const { air: of_air, sky: _, ...rest } = departure ?? {};
  return Object.fromEntries(Object.entries({ ...rest, ...of_air }).map(([key, value]) => [key, String(value).replace(/\.000Z$/, "Z")]));
}

/** The table of sun and Earth that a request brought, with the terrain that it is of. */
export function skyOf({ terrain, departure }: Pick<PlanRequest, "terrain" | "departure">): SkyTable | null {
  return departure?.sky ? { terrain, moments: departure.sky } : null;
}

/** Without a goal it is no request yet. */
export function planDraft(state: State = store.state): Omit<PlanRequest, "goal"> & Partial<Pick<PlanRequest, "goal">> {
  const { options, drawn } = state;
  return {
    ...shared(state),
    ...(drawn.start ? { start: drawn.start } : {}),
    ...(drawn.goal ? { goal: drawn.goal } : {}),
    ...(drawn.waypoints.length > 0 ? { waypoints: drawn.waypoints } : {}),
    ...weights(state),
    ...draws(state),
    ...(options.routes !== 3 ? { routes: options.routes } : {}),
    ...(options.startError ? { start_error: options.startError } : {}),
    ...departureOf(state),
    ...rulesOf(state),
  };
}

/** Null as long as start or goal is missing. */
export function planRequest(state: State = store.state): PlanRequest | null {
  const { start, goal } = state.drawn;
  return start && goal ? { ...planDraft(state), goal } : null;
}

export type Command = NonNullable<CheckRequest["commands"]>[number];
type DriveSoFar = NonNullable<CheckRequest["drive_so_far"]>;
export type Telemetry = NonNullable<DriveSoFar["rows"]>;

interface CheckParts {
  commands: { start?: { x_m: number; y_m: number; yaw_deg: number }; list: Command[] } | null;
  soFar: Telemetry;
}

export function checkRequest({ commands, soFar }: CheckParts, state: State = store.state): CheckRequest {
  const limits = state.options.limits;
  return {
    ...shared(state),
    ...(soFar.length > 0 ? { drive_so_far: { rows: soFar } } : {}),
    ...(commands ? { ...(commands.start ? { start: commands.start } : {}), commands: commands.list } : { path: state.drawn.path }),
    ...draws(state),
    ...departureOf(state),
    ...(state.options.rules ? { rules: state.options.rules } : {}),
    ...(Object.keys(limits).length > 0 ? { limits } : {}),
  };
}

/** What an answer of this kind depends on, in two parts: the limits alone, and all else. */
export interface Question {
  limits: string;
  rest: string;
}
export function question(kind: string, state: State = store.state): Question {
  const { limits, ...rest } = kind === "plan" ? planDraft(state) : checkRequest({ commands: null, soFar: [] }, state);
  return { limits: JSON.stringify(limits ?? {}), rest: JSON.stringify(kind === "plan" ? rest : [rest, state.typed]) };
}

/** Whether the answer on the screen is one to what the form asks now. */
export function staleness(state: State): Stale {
  const { result } = state;
  if (!result) return "";
  const now = question(result.kind, state);
  if (now.rest !== result.asked.rest) return "all";
  return now.limits === result.asked.limits ? "" : "limits";
}

export interface RiskSettings {
  heading_deg: number | null; // null: the worst
  distance_m: number;
  believe_unknown: boolean; // unknown ground by its belief, not left open
  budget_wh: number;
  view: number[]; // what the map shows: west, south, east, north
}

const max_cells = 4_194_304; // that the service makes in one map

/** The whole terrain where it is small enough; else what the map shows of it. */
function extentOf(state: State, view: number[]): Pick<MapRequest, "extent"> {
  const terrain = state.terrain?.terrain;
  const cells = (terrain?.rows ?? 0) * (terrain?.columns ?? 0);
  if (!terrain?.extent || cells <= max_cells) return {};
  const e = terrain.extent;
  const half = (cell: number | undefined) => 1000 * (cell ?? 1);
  const [x, y] = [(view[0]! + view[2]!) / 2, (view[1]! + view[3]!) / 2];
  const [dx, dy] = [Math.min((view[2]! - view[0]!) / 2, half(terrain.cell_x_m)), Math.min((view[3]! - view[1]!) / 2, half(terrain.cell_y_m))];
  return { extent: { west_m: Math.max(e.west_m!, x - dx), south_m: Math.max(e.south_m!, y - dy), east_m: Math.min(e.east_m!, x + dx), north_m: Math.min(e.north_m!, y + dy) } };
}

/** A map of risk with the rover, the rules, the zones and the belief of the form: the plan's own. */
export function riskRequest(kind: RiskKind, { heading_deg, distance_m, believe_unknown, budget_wh, view }: RiskSettings, state: State = store.state): MapRequest {
  const of_way = kind === "cost_to_go" || kind === "reachable";
  const of_drive = kind === "stop_risk" || kind === "embedding_risk" || kind === "verdict";
  const { keep_out, keep_in, ...rest } = shared(state);
  return {
    ...rest,
    kind,
    ...(of_way ? { ...(keep_out ? { keep_out } : {}), ...(keep_in ? { keep_in } : {}) } : {}),
    ...rulesOf(state),
    ...extentOf(state, view),
    ...(kind === "slip" ? { heading_deg: heading_deg ?? 0 } : of_drive && heading_deg !== null ? { heading_deg } : {}),
    ...(of_drive && distance_m !== 10 ? { distance_m } : {}),
    ...(believe_unknown && !of_way && kind !== "verdict" ? { unknown_ground: "belief" as const } : {}),
    ...(kind === "cost_to_go" ? { ...(state.drawn.goal ? { to: state.drawn.goal } : {}), ...weights(state) } : {}),
    ...(kind === "reachable" ? { ...(state.drawn.start ? { from: state.drawn.start } : {}), budget: { energy_j: budget_wh * 3600 } } : {}),
  };
}
