// What is asked for, as the API takes it.
import { store, type State } from "../state";

/** Limits, checks and bars of the chosen set of rules: plans take them one by one, checks by the set's name. */
function rulesOf(state: State): Record<string, unknown> {
  const set = state.rules.find((r) => r.name === state.options.rules);
  return set ? { limits: set.limits, checks: set.checks, bars: set.bars } : {};
}

function shared(state: State): Record<string, unknown> {
  const { options, drawn } = state;
  return {
    terrain: state.terrain?.terrain?.name,
    rover: options.rover,
    ...(drawn.keep_out.length > 0 ? { keep_out: drawn.keep_out } : {}),
    ...(drawn.keep_in.length > 0 ? { keep_in: drawn.keep_in } : {}),
    ...(options.legend ? { legend: options.legend } : {}),
    ...(options.seed !== 1 ? { seed: options.seed } : {}),
  };
}

export function planRequest(state: State = store.state): Record<string, unknown> {
  const { options, drawn } = state;
  return {
    ...shared(state),
    ...(drawn.start ? { start: drawn.start } : {}),
    ...(drawn.goal ? { goal: drawn.goal } : {}),
    ...(drawn.waypoints.length > 0 ? { waypoints: drawn.waypoints } : {}),
    ...(Object.keys(options.weights).length > 0 ? { weights: options.weights } : {}),
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
    ...(state.options.rules ? { rules: state.options.rules } : {}),
  };
}
