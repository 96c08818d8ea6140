// What keeps a route from a GO, and what would change that: each with a button where the page can do it.
import { button, h } from "../dom";
import { metres, number, share, words } from "../format";
import type { TerrainMap } from "../map/terrain_map";
import { ruleWords, stationAt, verdictWords, type Result, type Route, type Stretch } from "../result";
import { store, type Ring } from "../state";
import { start } from "../work";
import { planRequest } from "./request";

export interface Advice {
  text: string;
  act?: { label: string; name: string; run: () => void };
}

const enough_draws = 1000;
const least_hope = 0.01; // of a GO: less is not worth a drive

/** What does not hold of what a GO needs. */
export function blocks(route: Route, limits: Record<string, number>): string[] {
  const { outcomes, figures } = route;
  const found: string[] = [];
  const { embedding, expected_stops: stops } = outcomes;
  if (embedding && embedding.high >= limits.max_embedding!)
    found.push(`${embedding.value > 0 ? `The rover is embedded in ${share(embedding.value)} of the draws of the ground, and up to ${share(embedding.high)} can't be excluded.` : `The rover is embedded in none of the ${outcomes.draws ?? ""} draws of the ground, which leaves up to ${share(embedding.high)} possible.`} A GO needs less than ${share(limits.max_embedding)}.`);
  if (stops && stops.high >= limits.max_expected_stops!) found.push(`${number(stops.value)} stops, where a rule halts the rover, are expected, and up to ${number(stops.high)} can't be excluded. A GO needs less than ${number(limits.max_expected_stops)}.`);
  if (figures.immobilised) found.push("On the mean soils the rover finds no way forward.");
  if ((figures.broken_limits ?? []).length > 0) found.push(`On the mean soils it is beyond a limit: ${figures.broken_limits!.join("; ")}.`);
  return found;
}

/** The worst stretches, as many as would have to be avoided for the bars to hold; nothing where even that would not do. */
export function toAvoid(route: Route, limits: Record<string, number>): Stretch[] {
  const { embedding, expected_stops: stops } = route.outcomes;
  if (!embedding || !stops || route.stretches.length === 0) return [];
  const over = (share_of: { value: number; high: number }, bar: number, taken: number) => share_of.high - taken * (share_of.value > 0 ? share_of.high / share_of.value : 1) >= bar;
  const worst = [...route.stretches].sort((a, b) => b.expected_stops / limits.max_expected_stops! + b.embedding / limits.max_embedding! - a.expected_stops / limits.max_expected_stops! - a.embedding / limits.max_embedding!);
  const taken: Stretch[] = [];
  const sum = (key: "expected_stops" | "embedding") => taken.reduce((s, t) => s + t[key], 0);
  while (taken.length < worst.length && (over(stops, limits.max_expected_stops!, sum("expected_stops")) || over(embedding, limits.max_embedding!, sum("embedding")))) taken.push(worst[taken.length]!);
  return taken.sort((a, b) => a.from_m - b.from_m);
}

const zone_m = 2.5; // on either side of the way

/** A zone around a stretch of a route: nothing where start or goal would lie in it. */
export function zoneAround(route: Route, stretch: Stretch): Ring | null {
  const { distance_m, x_m, y_m } = route.stations;
  const length = distance_m.at(-1) ?? 0;
  const free = 3 * zone_m; // of start and goal
  const corners: [number, number][] = [];
  distance_m.forEach((d, i) => {
    if (d < Math.max(stretch.from_m, free) || d > Math.min(stretch.to_m, length - free)) return;
    for (let k = 0; k < 8; ++k) corners.push([x_m[i]! + zone_m * Math.cos((k * Math.PI) / 4), y_m[i]! + zone_m * Math.sin((k * Math.PI) / 4)]);
  });
  const ring = hull(corners);
  const ends: [number, number][] = [[x_m[0]!, y_m[0]!], [x_m.at(-1)!, y_m.at(-1)!]];
  return ring.length >= 3 && !ends.some((end) => holds(ring, end)) ? ring.map(([x, y]) => [Math.round(x * 100) / 100, Math.round(y * 100) / 100]) : null;
}

/** The convex hull, counter-clockwise [Andrew 1979]. */
export function hull(points: [number, number][]): [number, number][] {
  const sorted = [...points].sort((a, b) => a[0] - b[0] || a[1] - b[1]);
  const turns = (o: [number, number], a: [number, number], b: [number, number]) => (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0]);
  const half = (list: [number, number][]) => {
    const side: [number, number][] = [];
    for (const p of list) {
      while (side.length >= 2 && turns(side.at(-2)!, side.at(-1)!, p) <= 0) side.pop();
      side.push(p);
    }
    return side.slice(0, -1);
  };
  return [...half(sorted), ...half(sorted.reverse())];
}

const holds = (ring: [number, number][], [x, y]: [number, number]): boolean => {
  let inside = false;
  for (let i = 0, j = ring.length - 1; i < ring.length; j = i++) {
    const [[xi, yi], [xj, yj]] = [ring[i]!, ring[j]!];
    if (yi > y !== yj > y && x < ((xj - xi) * (y - yi)) / (yj - yi) + xi) inside = !inside;
  }
  return inside;
};

const planAgain = () => void start("v1/plans", planRequest());

function avoiding(result: Result, route: Route): Advice[] {
  const stretches = toAvoid(route, result.limits);
  if (stretches.length === 0) return [];
  const joined: { from_m: number; to_m: number }[] = [];
  for (const { from_m, to_m } of stretches) {
    const last = joined.at(-1);
    if (last && from_m - last.to_m < 0.5) last.to_m = to_m;
    else joined.push({ from_m, to_m });
  }
  const places = joined.map((s) => `${s.from_m.toFixed(0)} to ${s.to_m.toFixed(0)} m`).join(", ");
  const all_along = stretches.reduce((sum, s) => sum + s.to_m - s.from_m, 0) > 0.6 * (route.figures.length_m ?? 0);
  if (all_along) return [{ text: `It goes wrong nearly all along, from ${places}: other ground is needed, by another start or goal, or by a way point far from this route.` }];
  const left = Math.max(0, (route.outcomes.expected_stops?.value ?? 0) - stretches.reduce((s, t) => s + t.expected_stops, 0));
  const rings = stretches.map((s) => zoneAround(route, s)).filter((r): r is Ring => r !== null);
  const text = `Most goes wrong from ${places}: a way without ${joined.length > 1 ? "these stretches" : "this stretch"} would have ${number(left, 2)} expected stops left.`;
  if (result.kind !== "plan" || rings.length === 0) return [{ text }];
  return [{ text, act: { label: "Keep out of it and plan again", name: "keep-out-and-plan", run: () => {
    store.draw({ keep_out: [...store.state.drawn.keep_out, ...rings] });
    planAgain();
  } } }];
}

const least_part_m = 4;

/** How far the bars hold: a drive to there, a look, and a plan from there. */
export function partThatHolds(route: Route, limits: Record<string, number>): number | null {
  const { embedding, expected_stops: stops } = route.outcomes;
  if (!embedding || !stops) return null;
  const margin = 0.8;
  // The interval of a part, as that of a count: as wide as the root of what is counted.
  const upper = (part: number, whole: { value: number; high: number }) => part + (whole.high - whole.value) * Math.sqrt(whole.value > 0 ? Math.min(1, part / whole.value) : 1);
  const { distance_m, expected_stops, embedding: embedded, on_unknown_ground: unknown } = route.stations;
  let [stops_so_far, embedded_so_far] = [0, 0];
  let holds = 0;
  for (let i = 0; i < distance_m.length; ++i) {
    stops_so_far += expected_stops[i] ?? 0;
    embedded_so_far += embedded[i] ?? 0;
    if (unknown[i] || upper(stops_so_far, stops) > margin * limits.max_expected_stops! || embedded_so_far > 0) break;
    holds = distance_m[i]!;
  }
  return holds >= least_part_m && holds < (distance_m.at(-1) ?? 0) ? holds : null;
}

function shorter(result: Result, route: Route): Advice[] {
  const holds = result.kind === "plan" ? partThatHolds(route, result.limits) : null;
  if (holds === null) return [];
  const at = stationAt(route.stations, holds);
  return [{ text: `The first ${holds.toFixed(0)} m are expected to hold: drive to there, look, and plan on from there.`, act: { label: "Make it the goal and plan again", name: "nearer-goal", run: () => {
    store.draw({ goal: { x_m: route.stations.x_m[at]!, y_m: route.stations.y_m[at]! }, waypoints: [] });
    planAgain();
  } } }];
}

function otherRoutes(result: Result, route: Route): Advice[] {
  const index = result.routes.findIndex((r) => r !== route && r.verdict === "go");
  return index < 0 ? [] : [{ text: `${result.routes[index]!.title} is a GO.`, act: { label: `Look at ${result.routes[index]!.title.toLowerCase()}`, name: "other-route", run: () => store.set({ route: index, compared: null }) } }];
}

/** The rule that trips most, and which limit it would hold in 95 % of the draws. */
function limits(result: Result, route: Route): Advice[] {
  const rule = route.rules.filter((r) => r.trips?.value > 0.05 && r.value && r.rule !== "embedding").sort((a, b) => b.trips.value - a.trips.value)[0];
  if (!rule) return [];
  const lower = rule.rule === "clearance";
  const needed = lower ? rule.value!.p05 : rule.value!.p95;
  const unit = rule.unit === "1" || rule.unit === "" ? "" : ` ${rule.unit}`;
  const key = { slip_check: "max_slip", tilt: "max_tilt_deg", current: "max_current_a", sinkage: "max_sinkage_m", clearance: "min_clearance_m" }[rule.rule];
  const set = store.state.rules.find((s) => key && s.name !== store.state.options.rules && !lower && Number((s.limits as Record<string, number>)[key]) >= Math.max(needed, rule.limit * 1.01));
  const text = `The rule on ${ruleWords[rule.rule] ?? words(rule.rule)} trips in ${share(rule.trips.value)} of the draws${rule.cause ? ` (cause: ${words(rule.cause)})` : ""}; ${(lower ? needed > 0 : needed < 1 || rule.unit !== "1") ? `with a limit of ${number(needed)}${unit} in place of ${number(rule.limit)}${unit} it would in 5 %` : "no limit would hold"}.`;
  return [{ text, ...(set && result.kind === "plan" ? { act: { label: `Plan with the rules ${words(set.name!)}`, name: "other-rules", run: () => {
    store.option({ rules: set.name! });
    planAgain();
  } } } : {}) }];
}

/** Nothing that starts or ends on unknown ground becomes a GO by going another way. */
function endsUnknown({ kind }: Result, { stations, verdict }: Route): Advice[] {
  const ends = [stations.on_unknown_ground[0] ? "start" : "", stations.on_unknown_ground.at(-1) ? "goal" : ""].filter(Boolean) as ("start" | "goal")[];
  if (verdict === "go" || ends.length === 0) return [];
  const text = `The ${ends.join(" and the ")} ${ends.length > 1 ? "lie" : "lies"} on unknown ground, hatched on the map: a GO needs ${ends.length > 1 ? "both" : "it"} on ground that the map names.`;
  return [{ text, ...(kind === "plan" ? { act: { label: `Click another ${ends[0]}`, name: "other-end", run: () => store.set({ tool: ends[0]! }) } } : {}) }];
}

function unsure(result: Result, route: Route): Advice[] {
  const found: Advice[] = [];
  const { embedding, expected_stops: stops, draws, scout } = route.outcomes;
  const wide = (s: { value: number; high: number } | undefined, bar: number | undefined) => s !== undefined && bar !== undefined && s.value < bar / 2 && s.high >= bar;
  if (route.verdict === "unknown" && (draws ?? enough_draws) < enough_draws && (wide(embedding, result.limits.max_embedding) || wide(stops, result.limits.max_expected_stops)))
    found.push({ text: `What is expected is well below the bar, but ${draws} draws of the ground leave it open: more draws narrow it.`, ...(result.kind === "plan" ? { act: { label: `Plan with ${enough_draws} draws`, name: "more-draws", run: () => {
      store.option({ draws: enough_draws });
      planAgain();
    } } } : {}) });
  if (scout && route.verdict !== "go" && scout.verdict_afterwards.go >= least_hope) {
    const ground = scout.soil ? words(scout.soil) : "unknown ground";
    found.push({ text: `A scout drive of 5 m onto the ${ground} at ${scout.from_m.toFixed(0)} m, with its slip measured, would make it a ${verdictWords.go} with probability ${share(scout.verdict_afterwards.go)}.`, act: { label: "Show where", name: "scout", run: () => store.set({ hover_m: scout.from_m }) } });
  }
  const { unknown_length_m } = route.figures;
  if ((unknown_length_m ?? 0) > 0) found.push({ text: `${metres(unknown_length_m)} lie on ground that no map names: nothing there can be called safe before it has been seen.`, ...(result.kind === "plan" ? { act: { label: "Plan round unknown ground", name: "round-unknown", run: () => {
    const term = store.state.costTerms.find((t) => t.name === "unknown")?.weight;
    store.option({ weights: { ...store.state.options.weights, unknown: Math.min(term?.highest ?? 1000, 50 * Math.max(1, store.state.options.weights.unknown ?? term?.initial ?? 2)) } });
    planAgain();
  } } } : {}) });
  return found;
}

export function adviceOf(result: Result, route: Route): Advice[] {
  const checks = route.outcomes.recommended?.slip_checks_before_m ?? [];
  const always: Advice[] = checks.length > 0 ? [{ text: `Checks of the slip belong before ${checks.slice(0, 6).map((m) => m.toFixed(1)).join(", ")}${checks.length > 6 ? " …" : ""} m.` }] : [];
  if (route.verdict === "go") {
    const { embedding, expected_stops: stops } = route.outcomes;
    const room = stops && embedding ? [{ text: `It stays a GO as long as fewer than ${number(result.limits.max_expected_stops)} stops (now at most ${number(stops.high)}) and less than ${share(result.limits.max_embedding)} embedding (now at most ${share(embedding.high)}) are expected.` }] : [];
    const worst = [...route.stretches].sort((a, b) => b.expected_stops + b.embedding - a.expected_stops - a.embedding)[0];
    const where: Advice[] = worst && worst.expected_stops + worst.embedding > 0 ? [{ text: `Most of what may go wrong lies from ${worst.from_m.toFixed(0)} to ${worst.to_m.toFixed(0)} m.` }] : [];
    return [...room, ...where, ...always];
  }
  return [...otherRoutes(result, route), ...endsUnknown(result, route), ...avoiding(result, route), ...shorter(result, route), ...limits(result, route), ...unsure(result, route), ...always];
}

export function adviceView(result: Result, route: Route, map: TerrainMap): HTMLElement[] {
  const against = route.verdict === "go" ? [] : blocks(route, result.limits);
  const advice = adviceOf(result, route);
  return [
    ...(against.length > 0 ? [h("h3", {}, "What keeps it from a GO"), h("ul", { class: "reasons", "data-blocks": true }, against.map((line) => h("li", {}, line)))] : []),
    h("h3", {}, route.verdict === "go" ? "How much room there is" : "What would change it"),
    h("ul", { class: "advice" }, advice.map(({ text, act }) => h("li", {}, text, act ? button(act.label, () => {
      act.run();
      if (act.name === "scout" && store.state.hover_m !== null) map.showStretch(store.state.hover_m, store.state.hover_m + 5);
    }, { "data-do": act.name }) : null))),
  ];
}
