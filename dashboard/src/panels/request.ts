// What is asked for, as the API takes it.
import type { RiskKind } from "../map/risk_types";
import { store, type State } from "../state";

/** Limits, checks and bars of the chosen set of rules: plans take them one by one, checks by the set's name. */
function rulesOf(state: State): Record<string, unknown> {
  const set = state.rules.find((r) => r.name === state.options.rules);
  return set ? { limits: set.limits, checks: set.checks, bars: set.bars } : {};
}

/** What of the rover and of the belief differs from what the service takes by itself. */
function settings({ options }: State): Record<string, unknown> {
  const { model } = options;
  return {
    ...(options.effects.length > 0 ? { effects: options.effects.map(({ name, on, parameters }) => ({ name, ...(Object.keys(parameters).length > 0 ? { parameters } : {}), ...(on ? {} : { on }) })) } : {}),
    ...(Object.keys(options.failedWheels).length > 0 ? { failed_wheels: options.failedWheels } : {}),
    ...(options.confidence !== null ? { confidence: options.confidence } : {}),
    ...(options.unknownSoil ? { unknown_soil: options.unknownSoil } : {}),
    ...(model ? { model: { diagnosis: model.diagnosis, ...(model.ground.length > 0 ? { ground: model.ground } : {}) } } : {}),
  };
}

function shared(state: State): Record<string, unknown> {
  const { options, drawn } = state;
  return {
    terrain: state.terrain?.terrain?.name,
    rover: options.rover,
    ...(drawn.keep_out.length > 0 ? { keep_out: drawn.keep_out } : {}),
    ...(drawn.keep_in.length > 0 ? { keep_in: drawn.keep_in } : {}),
    ...(options.legend ? { legend: options.legend } : {}),
    ...settings(state),
    ...(options.seed !== 1 ? { seed: options.seed } : {}),
  };
}

const weights = ({ options }: State): Record<string, unknown> => (Object.keys(options.weights).length > 0 ? { weights: options.weights } : {});

const draws = ({ options }: State): Record<string, unknown> => (options.draws !== null ? { draws: options.draws } : {});

export function planRequest(state: State = store.state): Record<string, unknown> {
  const { options, drawn } = state;
  return {
    ...shared(state),
    ...(drawn.start ? { start: drawn.start } : {}),
    ...(drawn.goal ? { goal: drawn.goal } : {}),
    ...(drawn.waypoints.length > 0 ? { waypoints: drawn.waypoints } : {}),
    ...weights(state),
    ...draws(state),
    ...(options.routes !== 3 ? { routes: options.routes } : {}),
    ...rulesOf(state),
  };
}

export type Command = Record<string, number>;

interface CheckParts {
  commands: { start?: { x_m: number; y_m: number; yaw_deg: number }; list: Command[] } | null;
  soFar: Record<string, unknown>[];
}

export function checkRequest({ commands, soFar }: CheckParts, state: State = store.state): Record<string, unknown> {
  return {
    ...shared(state),
    ...(soFar.length > 0 ? { drive_so_far: { rows: soFar } } : {}),
    ...(commands ? { ...(commands.start ? { start: commands.start } : {}), commands: commands.list } : { path: state.drawn.path }),
    ...draws(state),
    ...(state.options.rules ? { rules: state.options.rules } : {}),
  };
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
function extentOf(state: State, view: number[]): Record<string, unknown> {
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
export function riskRequest(kind: RiskKind, { heading_deg, distance_m, believe_unknown, budget_wh, view }: RiskSettings, state: State = store.state): Record<string, unknown> {
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
    ...(believe_unknown && !of_way && kind !== "verdict" ? { unknown_ground: "belief" } : {}),
    ...(kind === "cost_to_go" ? { to: state.drawn.goal, ...weights(state) } : {}),
    ...(kind === "reachable" ? { from: state.drawn.start, budget: { energy_j: budget_wh * 3600 } } : {}),
  };
}
