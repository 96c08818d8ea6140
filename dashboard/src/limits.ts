// How a route stands to limits that were moved since it was asked for: told from the quantiles over the draws that its answer has.
import type { Limits } from "./api/client";
import type { Route, Stations } from "./result";

export interface Limit {
  key: keyof Limits & string;
  words: string;
  unit: string;
  lowest: number;
  highest: number;
  step: number;
  /** What of the stations the limit is of, and how its words go on where some of the draws pass it. */
  quantiles: { p05?: keyof Stations; p50?: keyof Stations; p95: keyof Stations };
  least?: boolean; // values below are beyond it
}

export const limits: Limit[] = [
  { key: "max_slip", words: "Slip at most", unit: "", lowest: 0.05, highest: 1, step: 0.01, quantiles: { p05: "slip_p05", p50: "slip_p50", p95: "slip_p95" } },
  { key: "max_tilt_deg", words: "Tilt at most", unit: "°", lowest: 1, highest: 45, step: 0.5, quantiles: { p05: "tilt_deg_p05", p95: "tilt_deg_p95" } },
  { key: "max_sinkage_m", words: "Sinkage at most", unit: "m", lowest: 0.005, highest: 0.3, step: 0.005, quantiles: { p95: "sinkage_m_p95" } },
  { key: "max_current_a", words: "Motor current at most", unit: "A", lowest: 0.5, highest: 20, step: 0.1, quantiles: { p95: "current_a_p95" } },
  { key: "min_clearance_m", words: "Clearance at least", unit: "m", lowest: 0, highest: 0.6, step: 0.01, quantiles: { p05: "clearance_m_p05", p95: "clearance_m_p95" }, least: true },
];

/** In how many of the draws a limit is passed, at least: the answer has three quantiles, and says no more. */
export const shareClasses = ["in at most 5 % of the draws", "in 5 % or more", "in 50 % or more", "in 95 % or more"];
/** Of the five colours of a palette. */
export const shareColours = [0, 2, 3, 4];

export interface Passed {
  limit: Limit;
  share: number; // index of shareClasses
  value: number; // that 5 % of the draws come to, or pass
}

/** Which limits some of the draws pass at a station, most draws first. */
export function passedAt({ stations }: Route, i: number, at: Limits): Passed[] {
  const value = (key: keyof Stations | undefined) => (key === undefined ? null : ((stations[key] as (number | null)[] | undefined)?.[i] ?? null));
  const found: Passed[] = [];
  for (const limit of limits) {
    const bar = at[limit.key];
    if (bar === undefined) continue;
    const { p05, p50, p95 } = limit.quantiles;
    // From the quantile that the fewest draws pass to the one that nearly all do.
    const ends = (limit.least ? [p05, p50, p95] : [p95, p50, p05]).map(value);
    const beyond = (v: number | null) => v !== null && (limit.least ? v < bar : Math.abs(v) > bar);
    const share = beyond(ends[2]!) ? 3 : beyond(ends[1]!) ? 2 : beyond(ends[0]!) ? 1 : 0;
    if (share > 0) found.push({ limit, share, value: ends[0]! });
  }
  return found.sort((a, b) => b.share - a.share);
}

/** The class of each station by the limit that most draws pass; null: unknown ground. */
export const limitClasses = (route: Route, at: Limits): (number | null)[] =>
  route.stations.distance_m.map((_, i) => (route.stations.on_unknown_ground[i] ? null : (passedAt(route, i, at)[0]?.share ?? 0)));
