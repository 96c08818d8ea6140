// The answers of plans, predictions and checks, as the same thing: routes with a verdict, rules and stations.
import { get, type Job, type Limits, type Rover } from "./api/client";
import type { components } from "./api/types";
import type { Question } from "./panels/request";

type Schemas = components["schemas"];
type Column = (number | null)[];

export interface Stations {
  count: number;
  distance_m: number[];
  x_m: number[];
  y_m: number[];
  yaw_deg: number[];
  height_m: number[];
  pitch_deg: Column;
  roll_deg: Column;
  tilt_deg: Column;
  tilt_deg_p05: Column;
  tilt_deg_p95: Column;
  clearance_m: Column;
  clearance_m_p05: Column;
  clearance_m_p95: Column;
  slip: Column;
  slip_p05: Column;
  slip_p50: Column;
  slip_p95: Column;
  aside_m: Column;
  aside_m_p05: Column;
  aside_m_p95: Column;
  side_slip_deg: Column;
  sinkage_m_p95: Column;
  current_a_p95: Column;
  power_w: Column;
  risk: Column;
  expected_stops: Column;
  embedding: Column;
  elapsed_s: number[];
  soil: (string | null)[];
  on_unknown_ground: boolean[];
  wheels: Record<string, Record<string, Column>>;
  // Of the best departure, or of the nearest where none keeps the rules; absent where none was asked for.
  at_ms?: number[];
  charge_percent?: Column;
  charge_low_percent?: Column;
  motor_c?: Column; // where the air and the motor's thermal numbers are known
  motor_slow_c?: Column;
  in_w?: Column;
  out_w?: Column;
  sun_over_horizon_deg?: Column;
}

export type Rule = Schemas["RuleRisk"];
export type Verdict = Schemas["Verdict"];

export interface Route {
  title: string;
  verdict: Verdict;
  decision: Schemas["Decision"];
  figures: Schemas["DriveFigures"] & Partial<Pick<Schemas["RouteFigures"], "cost" | "cost_shares">>;
  stations: Stations;
  outcomes: Schemas["DriveOutcomes"];
  notes: string[]; // what made a plan rank it as it did
}

export interface DrivenStretch {
  from_m: number;
  to_m: number;
  x_m: number;
  y_m: number;
  slip: number;
  predicted_slip: { p05: number; p50: number; p95: number };
}
/** Measured where 90 % of the draws do not have it. */
export const surprises = (s: DrivenStretch): boolean => s.slip < s.predicted_slip.p05 || s.slip > s.predicted_slip.p95;

export interface Result {
  job: string;
  kind: string;
  created: string;
  rover: string;
  terrain: string;
  request: Record<string, unknown>;
  asked: Question; // what the form asked when this was its answer
  quiet: boolean; // asked by a drag: the page stays where it is
  limits: Limits & Record<string, number>;
  provenance: { soil_assumption?: string; legend?: string; slipway?: string; terrain_fingerprint?: string; seed?: number };
  fewer: string[];
  driven: DrivenStretch[]; // of a drive under way: what was measured against what had been predicted
  routes: Route[];
}

/** Values of another route at the distances of the first, so that both are on one axis. */
export function resampled(values: Column, from: number[], at: number[]): Column {
  let k = 0;
  return at.map((d) => {
    if (from.length === 0 || d > from.at(-1)! || d < from[0]!) return null;
    while (k + 2 < from.length && from[k + 1]! < d) ++k;
    const [a, b] = [values[k] ?? null, values[k + 1] ?? null];
    if (a === null || b === null) return null;
    const span = from[k + 1]! - from[k]!;
    return span > 0 ? a + ((b - a) * Math.max(0, d - from[k]!)) / span : b;
  });
}

/** The day along the drive, at the stations of the route. */
function dayColumns({ departures }: Schemas["Decision"], at_m: number[]): Partial<Stations> {
  const along = (departures?.best ?? departures?.nearest)?.stations ?? [];
  if (along.length < 2) return {};
  const from = along.map((s) => s.distance_m);
  const column = (value: (s: (typeof along)[number]) => number) => resampled(along.map(value), from, at_m);
  return {
    at_ms: column((s) => Date.parse(s.at)).map((at) => at ?? NaN),
    charge_percent: column((s) => s.charge_percent),
    charge_low_percent: column((s) => s.charge_low_percent),
    in_w: column((s) => s.in_w),
    out_w: column((s) => s.out_w),
    sun_over_horizon_deg: column((s) => s.sun_over_horizon_deg),
    ...(along[0]!.motor_c === undefined ? {} : { motor_c: column((s) => s.motor_c!), motor_slow_c: column((s) => s.motor_slow_c!) }),
  };
}

/* eslint-disable @typescript-eslint/no-explicit-any -- the documents' parts have no schemas of their own */
function routeOf(properties: any, document: any, title: string): Route {
  const decision: Schemas["Decision"] = properties.decision ?? document.decision;
  return {
    title,
    verdict: decision.verdict,
    decision,
    figures: properties.rank !== undefined ? properties : document.summary,
    stations: { ...properties.stations, ...dayColumns(decision, properties.stations.distance_m) },
    outcomes: properties.outcomes ?? document.outcomes,
    notes: properties.rank !== undefined ? properties.reasons : [],
  };
}

/** What a finished job answered, if it is about routes. */
export async function readResult(job: Job, asked: Question, quiet: boolean): Promise<Result> {
  const document: any = await get(`v1/jobs/${job.id}/result`);
  const features: any[] = document.routes?.features ?? [];
  return {
    job: job.id,
    kind: job.kind,
    created: job.created,
    rover: document.rover?.name ?? document.request?.rover ?? "",
    terrain: document.terrain?.name ?? document.request?.terrain ?? "",
    request: document.request ?? {},
    asked,
    quiet,
    limits: { ...document.request?.limits, ...document.request?.bars, ...document.request?.checks, ...document.request?.departure },
    provenance: document.provenance ?? {},
    fewer: document.fewer_because ?? [],
    driven: document.drive_so_far?.stretches ?? [],
    routes: features.map((feature) =>
      routeOf(feature.properties, document, feature.properties.rank ? `Route ${feature.properties.rank}` : "Path"),
    ),
  };
}
/* eslint-enable */

/** The rover that drove; a corrected one has the name of the one that it was made of before its own. */
export const roverOf = ({ rover }: { rover: string }, rovers: Rover[]): Rover | undefined => rovers.find((r) => r.name === rover) ?? rovers.find((r) => rover.startsWith(`${r.name}-`));

export const isAboutRoutes = (kind: string): boolean => ["plan", "prediction", "check"].includes(kind);

/** The station nearest to a place along the route. */
export function stationAt(stations: Stations, at_m: number): number {
  const d = stations.distance_m;
  let low = 0;
  let high = d.length - 1;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (d[middle]! <= at_m) low = middle;
    else high = middle;
  }
  return at_m - d[low]! <= d[high]! - at_m ? low : high;
}

/** The class of each station, 0 to 4, by the halts and embeddings on its stretch or by slip; null: unknown ground. */
export function classesOf(route: Route, by: "risk" | "slip", bounds: number[]): (number | null)[] {
  const { stations, outcomes: { stretches } } = route;
  const classOf = (value: number) => bounds.filter((bound) => value >= bound).length;
  let k = 0;
  return stations.distance_m.map((at, i) => {
    if (stations.on_unknown_ground[i]) return null;
    if (by === "slip") return classOf(Math.abs(stations.slip_p95[i] ?? stations.slip[i] ?? 1));
    while (k + 1 < stretches.length && at > stretches[k]!.to_m) ++k;
    const stretch = stretches[k];
    return stretch ? classOf(stretch.expected_stops + stretch.embedding) : classOf(stations.risk[i] ?? 1);
  });
}

export const classTitles = {
  risk: "Halts and embeddings on a stretch, share of the draws",
  slip: "Slip (95 % of the draws are below)",
  limits: "The limit that most draws pass at a place",
};

export const classLabels = (bounds: number[]): string[] => [`below ${bounds[0]}`, ...bounds.slice(1).map((b, i) => `${bounds[i]} to ${b}`), `above ${bounds.at(-1)}`];

/** The rules that trip somewhere in some of the draws, those that trip most first. */
export const tripsOf = (route: Route): Rule[] => route.outcomes.rules.filter((r) => r.from_m !== null).sort((a, b) => b.trips.value - a.trips.value);

export const verdictWords: Record<Verdict, string> = { go: "GO", no_go: "NO-GO", unknown: "UNKNOWN" };
/** Green, red and amber, apart by lightness too. */
export const verdictColours: Record<Verdict, string> = { go: "#66bd63", no_go: "#a50026", unknown: "#fdae61" };
