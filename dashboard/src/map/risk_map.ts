// Maps of risk that the service makes: asked for, followed, read, shown as layers over the relief.
import { ask, get, submit, type MapDocument } from "../api/client";
import { follow } from "../api/events";
import { store, type State } from "../state";
import { riskRequest, type RiskSettings } from "../panels/request";
import { verdictColours, verdictWords } from "../result";
import type { RiskKind, RiskMap } from "./risk_types";
import { readTiff } from "./tiff";

export const riskTitles: Record<RiskKind, string> = {
  verdict: "Verdict",
  slip_worst: "Slip, worst heading",
  slip_best: "Slip, best heading",
  slip: "Slip at a heading",
  stop_risk: "Risk of a stop",
  embedding_risk: "Risk of embedding",
  cost_to_go: "Cost to the goal",
  reachable: "Reach from the start",
};

const usualOpacity = 0.65;
const running = new Map<RiskKind, AbortController>();
// One after the other: a stream of events each would leave no connection for the map's tiles.
let queue: Promise<unknown> = Promise.resolve();

const change = (kind: RiskKind, what: Partial<RiskMap>) => store.set({ risk: store.state.risk.map((m) => (m.kind === kind ? { ...m, ...what } : m)) });

/** Asks for a map with what the form has now; an earlier one of its kind goes. */
export async function addRiskMap(kind: RiskKind, settings: RiskSettings): Promise<void> {
  const request = riskRequest(kind, settings);
  const opacity = store.state.risk.find((m) => m.kind === kind)?.opacity ?? usualOpacity;
  await make(kind, opacity, JSON.stringify(request), async () => (await submit("v1/maps", request)).id);
}

/** Shows a map that was made before: of a link. */
export async function reopenRiskMap(kind: RiskKind, opacity: number, job: string): Promise<void> {
  await make(kind, opacity, "", async () => job);
}

async function make(kind: RiskKind, opacity: number, request: string, job_of: () => Promise<string>): Promise<void> {
  removeRiskMap(kind);
  const mine = new AbortController();
  running.set(kind, mine);
  store.set({ risk: [...store.state.risk, { kind, job: "", opacity, request, progress: 0, document: null, raster: null }] });
  const work = queue.then(async () => {
    if (mine.signal.aborted) return;
    const job = await job_of();
    if (!mine.signal.aborted) change(kind, { job });
    const end = await follow(job, (seen) => change(kind, { progress: seen.progress }), mine.signal);
    const document = await get<MapDocument>(`v1/jobs/${job}/result`, mine.signal);
    if (end.state !== "successful") throw new Error(end.problem?.detail ?? "The map was not made.");
    const raster = await readTiff(await (await ask(`v1/jobs/${job}/map.tif`, { signal: mine.signal })).arrayBuffer(), document.nodata);
    if (!mine.signal.aborted) change(kind, { document, raster, progress: null, request: request || JSON.stringify(document.request) });
  });
  queue = work.catch(() => undefined);
  try {
    await work;
  } catch (error) {
    if (mine.signal.aborted) return;
    removeRiskMap(kind);
    store.set({ error });
  }
}

/** Takes a map away; one that is under way is cancelled. */
export function removeRiskMap(kind: RiskKind): void {
  running.get(kind)?.abort();
  running.delete(kind);
  const map = store.state.risk.find((m) => m.kind === kind);
  if (map?.job && map.progress !== null) ask(`v1/jobs/${map.job}`, { method: "DELETE" }).catch(() => undefined); // it may have ended meanwhile
  store.set({ risk: store.state.risk.filter((m) => m.kind !== kind) });
}

export const opacityOf = (kind: RiskKind, opacity: number): void => change(kind, { opacity });

export interface RiskClass {
  colour: string | null; // null: black and white
  label: string;
  hatched?: boolean;
}
/** The classes of a map with their colours, and which of them a value is in; -1: nothing is known there. */
export interface RiskClasses {
  classes: RiskClass[];
  classOf(value: number): number;
}

const numbered = (bounds: number[]): string[] => [`below ${bounds[0]}`, ...bounds.slice(1).map((b, i) => `${bounds[i]} to ${b}`), `above ${bounds.at(-1)}`];

export function riskClasses(document: MapDocument, state: State): RiskClasses {
  const { palette } = state;
  if (document.kind === "verdict" || document.kind === "reachable") {
    const of: Record<string, RiskClass> = {
      verdict1: { colour: verdictColours.go, label: verdictWords.go },
      verdict2: { colour: "#c7e9a0", label: `${verdictWords.go} in some headings only` },
      verdict3: { colour: verdictColours.unknown, label: verdictWords.unknown, hatched: true },
      verdict4: { colour: verdictColours.no_go, label: verdictWords.no_go },
      reachable1: { colour: palette[0]!, label: "within the budget" },
      reachable2: { colour: null, label: "only by a way over unknown ground", hatched: true },
      reachable3: { colour: palette[3]!, label: "out of reach" },
    };
    const classes = [1, 2, 3, 4].flatMap((v) => of[document.kind + v] ?? []);
    return { classes, classOf: (value) => (value >= 1 && value <= classes.length && !classes[value - 1]!.hatched ? value - 1 : -1) };
  }
  const bounds = document.kind === "cost_to_go" ? fifths(document) : state.bounds[document.kind.startsWith("slip") ? "slip" : "risk"];
  return {
    classes: numbered(bounds).map((label, k) => ({ colour: palette[k]!, label })),
    classOf: (value) => {
      if (value === document.nodata || !Number.isFinite(value)) return -1;
      const size = Math.abs(value);
      let k = 0;
      while (k < bounds.length && size >= bounds[k]!) ++k;
      return k;
    },
  };
}

function fifths({ statistics }: MapDocument): number[] {
  const [low, high] = [statistics.lowest ?? 0, statistics.highest ?? 1];
  return [1, 2, 3, 4].map((k) => Number((low + ((high - low) * k) / 5).toPrecision(2)));
}

/** The value at a place of the map; undefined off the map, null where nothing is known. */
export function valueAt(map: RiskMap, x_m: number, y_m: number): number | null | undefined {
  if (!map.document || !map.raster) return undefined;
  const e = map.document.extent;
  const { columns, rows, values } = map.raster;
  const column = Math.floor(((x_m - e.west_m) / (e.east_m - e.west_m)) * columns);
  const row = Math.floor(((e.north_m - y_m) / (e.north_m - e.south_m)) * rows);
  if (column < 0 || row < 0 || column >= columns || row >= rows) return undefined;
  const value = values[row * columns + column]!;
  return value === map.document.nodata ? null : value;
}
