// What is shown, in the address: a link to it shows it again, and a reload loses nothing.
import { riskTitles } from "./map/risk_map";
import type { RiskKind } from "./map/risk_types";
import { limits } from "./limits";
import { nothingDrawn, routeColours, store, type Day, type Drawn, type Model, type Options, type Place, type Ring, type State, type Tab } from "./state";

export interface Link {
  terrain: string;
  job: string;
  risk: { kind: RiskKind; opacity: number; job: string }[];
  view: [number, number, number] | null; // centre and metres per pixel
}

const places = (list: Place[]): string => list.map((p) => `${p.x_m.toFixed(2)},${p.y_m.toFixed(2)}`).join(";");
const rings = (list: Ring[]): string => list.map((ring) => ring.map(([x, y]) => `${x.toFixed(2)},${y.toFixed(2)}`).join(";")).join("|");

function readPlaces(text: string | null): Place[] {
  return (text ?? "")
    .split(";")
    .map((pair) => pair.split(",").map(Number))
    .filter((pair) => pair.length === 2 && pair.every(Number.isFinite))
    .map(([x_m, y_m]) => ({ x_m: x_m!, y_m: y_m! }));
}
const readRings = (text: string | null): Ring[] =>
  (text ?? "")
    .split("|")
    .map((ring) => readPlaces(ring).map((p): [number, number] => [p.x_m, p.y_m]))
    .filter((ring) => ring.length >= 3);

export function writeLink(state: State, view: Link["view"]): string {
  const q = new URLSearchParams();
  const put = (key: string, value: string | number | null | undefined) => {
    if (value !== null && value !== undefined && value !== "") q.set(key, String(value));
  };
  const { drawn, options } = state;
  put("tab", state.tab === "plan" ? "" : state.tab);
  put("terrain", state.terrain?.terrain?.name);
  put("rover", options.rover);
  put("rules", options.rules);
  put("legend", options.legend);
  put("start", drawn.start && places([drawn.start]));
  put("goal", drawn.goal && places([drawn.goal]));
  put("via", places(drawn.waypoints));
  put("path", places(drawn.path));
  put("out", rings(drawn.keep_out));
  put("in", rings(drawn.keep_in));
  put("limits", Object.entries(options.limits).map(([k, v]) => `${k}:${v}`).join(","));
  put("weights", Object.entries(options.weights).map(([k, v]) => `${k}:${v}`).join(","));
  put("routes", options.routes === 3 ? "" : options.routes);
  put("seed", options.seed === 1 ? "" : options.seed);
  const { model } = options;
  put("model", model && [model.diagnosis, model.rover, model.campaign, ...model.ground].join(","));
  put("effects", options.effects.map((e) => [e.on ? e.name : `-${e.name}`, ...Object.entries(e.parameters).map(([k, v]) => `${k}:${v}`)].join(",")).join(";"));
  put("failed", Object.entries(options.failedWheels).map(([k, v]) => `${k}:${v}`).join(","));
  put("confidence", options.confidence);
  put("unknown", options.unknownSoil);
  put("draws", options.draws);
  put("when", Object.entries(options.departure).map(([k, v]) => `${k}=${v}`).join(","));
  put("at", state.day.shows && new Date(state.day.at_ms).toISOString());
  put("sun", state.day.shows);
  put("risk", state.risk.filter((m) => m.document).map((m) => [m.kind, m.opacity, m.job].join(":")).join(","));
  put("layers", Object.entries(state.layers).map(([k, v]) => `${k}:${v}`).join(","));
  put("colour", state.routeColour === "risk" ? "" : state.routeColour);
  put("job", jobShown(state));
  put("route", state.route || "");
  put("view", view && view.map((v) => Number(v.toFixed(3))).join(","));
  return q.toString();
}

/** What a reader of the link is to see. */
function jobShown({ tab, followed, result, job }: State): string | undefined {
  const of_drives = followed.watch?.job ?? followed.diagnosis?.job;
  return tab === "drives" && of_drives ? of_drives : (result?.job ?? job?.id);
}

const isJob = (text: string | null | undefined): boolean => /^[0-9a-f]{32}$/.test(text ?? "");

function readModel(text: string | null): Model | null {
  const [diagnosis = "", rover = "", campaign = "", ...ground] = (text ?? "").split(",");
  return isJob(diagnosis) && rover ? { diagnosis, rover, campaign, ground } : null;
}

const readEffects = (text: string | null): Options["effects"] =>
  (text ?? "")
    .split(";")
    .filter(Boolean)
    .map((one) => {
      const [name = "", ...parameters] = one.split(",");
      return { name: name.replace(/^-/, ""), on: !name.startsWith("-"), parameters: Object.fromEntries(pairs(parameters.join(","))) };
    });

const pairs = (text: string | null): [string, number][] =>
  (text ?? "")
    .split(",")
    .map((pair) => pair.split(":"))
    .filter((pair) => pair.length === 2 && Number.isFinite(Number(pair[1])))
    .map(([k, v]) => [k!, Number(v)]);

export function readLink(hash: string): Link {
  const q = new URLSearchParams(hash.replace(/^#/, ""));
  const drawn: Drawn = {
    ...nothingDrawn,
    start: readPlaces(q.get("start"))[0] ?? null,
    goal: readPlaces(q.get("goal"))[0] ?? null,
    waypoints: readPlaces(q.get("via")),
    path: readPlaces(q.get("path")),
    keep_out: readRings(q.get("out")),
    keep_in: readRings(q.get("in")),
  };
  const options: Options = {
    rover: q.get("rover") ?? "",
    rules: q.get("rules") ?? "",
    legend: q.get("legend") ?? "",
    limits: Object.fromEntries(pairs(q.get("limits")).filter(([key]) => limits.some((limit) => limit.key === key))),
    weights: Object.fromEntries(pairs(q.get("weights"))),
    routes: Number(q.get("routes")) || 3,
    seed: Number(q.get("seed")) || 1,
    model: readModel(q.get("model")),
    effects: readEffects(q.get("effects")),
    failedWheels: Object.fromEntries((q.get("failed") ?? "").split(",").map((pair) => pair.split(":")).filter(([, how]) => ["locked", "free", "off"].includes(how ?? ""))),
    confidence: Number(q.get("confidence")) || null,
    unknownSoil: q.get("unknown") ?? "",
    draws: Number(q.get("draws")) || null,
    departure: Object.fromEntries((q.get("when") ?? "").split(",").map((pair) => pair.split("=")).filter((pair) => pair.length === 2)),
    startError: null, // as the sky
    sky: null, // too long for an address; that of the job comes with it
  };
  const tab = (["plan", "check", "jobs", "drives"] as Tab[]).find((t) => t === q.get("tab")) ?? "plan";
  const colour = routeColours.find((c) => c === q.get("colour")) ?? "risk";
  const layers = { ...store.state.layers, ...Object.fromEntries(pairs(q.get("layers")).filter(([k]) => k in store.state.layers)) };
  const at_ms = Date.parse(q.get("at") ?? "");
  const day: Day = { at_ms: Number.isFinite(at_ms) ? at_ms : store.state.day.at_ms, shows: (["shadow", "share"] as const).find((s) => s === q.get("sun")) ?? "" };
  store.set({ drawn, options, day, tab, layers, routeColour: colour, route: Number(q.get("route")) || 0 });
  const view = (q.get("view") ?? "").split(",").map(Number);
  return {
    terrain: q.get("terrain") ?? "",
    job: isJob(q.get("job")) ? q.get("job")! : "",
    risk: (q.get("risk") ?? "").split(",").map((one) => one.split(":")).filter(([kind, , job]) => kind! in riskTitles && isJob(job)).map(([kind, opacity, job]) => ({ kind: kind as RiskKind, opacity: Number(opacity) || 0.65, job: job! })),
    view: view.length === 3 && view.every(Number.isFinite) ? (view as [number, number, number]) : null,
  };
}
