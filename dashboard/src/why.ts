// Why a place of a route has its colour: what happens there in the draws, which rules trip and why, how the ground is.
import { number, share, wheelWords, words } from "./format";
import { passedAt, shareClasses } from "./limits";
import { classesOf, stationAt, tripsOf, type Route } from "./result";
import type { State } from "./state";

const causes: Record<string, string> = { climb: "the climb", descent: "the descent", cross_slope: "the slope to the side", soil: "the soil", load: "the load on the wheels", rough_ground: "rough ground" };
export const causeWords = (cause: string): string => causes[cause] ?? words(cause);

export interface Why {
  head: string;
  lines: string[];
}

export function whyAt(route: Route, at_m: number, { bounds, result, options, stale }: State): Why {
  const { stations: s, outcomes } = route;
  const i = stationAt(s, at_m);
  const stretch = outcomes.stretches.find((one) => at_m >= one.from_m && at_m <= one.to_m);
  const lines: string[] = [];
  if (stale === "all") lines.push("This is of what was asked before.");
  if (stretch) lines.push(stretch.expected_stops + stretch.embedding > 0
    ? `${share(stretch.expected_stops)} of the draws halt here first${stretch.embedding > 0 ? `, ${share(stretch.embedding)} are embedded` : ""}.`
    : "No draw halts here.");
  for (const rule of tripsOf(route)) {
    if (at_m < rule.from_m! - 0.5 || at_m > (rule.to_m ?? rule.from_m!) + 0.5) continue;
    lines.push(`${rule.words}: past its limit of ${number(rule.limit)}${rule.unit === "1" ? "" : ` ${rule.unit}`} in ${share(rule.trips.value)} of the draws${rule.cause ? `, because of ${causeWords(rule.cause)}` : ""}${rule.wheel ? `, ${wheelWords(rule.wheel)}` : ""}.`);
  }
  const moved = { ...result?.limits, ...options.limits };
  for (const { limit, share: k } of passedAt(route, i, moved)) lines.push(`${limit.words} ${number(moved[limit.key])}${limit.unit && ` ${limit.unit}`}: passed at this place ${shareClasses[k]}.`);
  const slip = s.slip_p50[i] ?? s.slip[i];
  lines.push(`Slip ${number(slip, 2)} (${number(s.slip_p05[i], 2)} to ${number(s.slip_p95[i], 2)}), tilt ${number(s.tilt_deg[i], 2)}°, ${s.on_unknown_ground[i] ? "on ground that no map names" : `on ${words(s.soil[i] ?? "unknown ground")}`}.`);
  const k = classesOf(route, "risk", bounds.risk)[i];
  const colour = k === null || k === undefined ? "unknown ground, whatever was predicted" : k >= 3 ? "red: much goes wrong here" : k === 2 ? "some goes wrong here" : "little goes wrong here";
  return { head: stretch ? `${stretch.from_m.toFixed(0)} to ${stretch.to_m.toFixed(0)} m: ${colour}` : `At ${at_m.toFixed(0)} m: ${colour}`, lines };
}
