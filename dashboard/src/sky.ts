// Sun and Earth over the ground through the sol that the slider is in, as the service says it.
import { get, ServiceError } from "./api/client";
import type { components } from "./api/types";
import { sentence } from "./format";
import { store, type Place, type State } from "./state";
import { report } from "./work";

export type Moment = components["schemas"]["PlaceSky"]["moments"][number];

/** Equally far apart, by the time. */
export interface Sol {
  key: string; // of the place that it is asked for
  place: Place;
  moments: Moment[];
  from_ms: number;
  to_ms: number;
  refused: string; // why there is none
}

const apart_ms = 150;
const rad = Math.PI / 180;

type Vector = [number, number, number];
const towards = ({ azimuth_deg, elevation_deg }: Moment["sun"]): Vector => {
  const level = Math.cos(elevation_deg * rad);
  return [level * Math.sin(azimuth_deg * rad), level * Math.cos(azimuth_deg * rad), Math.sin(elevation_deg * rad)];
};
function between(a: Moment["sun"], b: Moment["sun"], share: number): Moment["sun"] {
  const [u, v] = [towards(a), towards(b)];
  const [x, y, z] = u.map((value, i) => value * (1 - share) + v[i]! * share) as Vector;
  return { azimuth_deg: ((Math.atan2(x, y) / rad) + 360) % 360, elevation_deg: Math.atan2(z, Math.hypot(x, y)) / rad };
}

/** Between the two moments around a time. */
export function momentAt({ moments, from_ms, to_ms }: Sol, at_ms: number): Moment {
  const at = Math.min(Math.max((at_ms - from_ms) / (to_ms - from_ms), 0), 1) * (moments.length - 1);
  const k = Math.min(Math.floor(at), moments.length - 2);
  const [a, b, share] = [moments[k]!, moments[k + 1]!, at - k];
  const mix = (p: number, q: number) => p + (q - p) * share;
  // The clock's hours go on over midnight.
  const clock = (p: number, q: number) => mix(p, q < p - 12 ? q + 24 : q > p + 12 ? q - 24 : q);
  const sun = between(a.sun, b.sun, share);
  const horizon_deg = mix(a.horizon_deg, b.horizon_deg);
  return { ...a, at: new Date(at_ms).toISOString(), true_solar_h: clock(a.true_solar_h, b.true_solar_h), mean_solar_h: clock(a.mean_solar_h, b.mean_solar_h), sun, earth: between(a.earth, b.earth, share), horizon_deg, lit: sun.elevation_deg > horizon_deg };
}

/** The sky is that over the start, or over the middle of the terrain. */
function placeOf({ drawn, terrain }: State): Place {
  const e = terrain!.terrain!.extent!;
  const { start } = drawn;
  const lies = start && start.x_m >= e.west_m! && start.x_m <= e.east_m! && start.y_m >= e.south_m! && start.y_m <= e.north_m!;
  return lies ? start : { x_m: (e.west_m! + e.east_m!) / 2, y_m: (e.south_m! + e.north_m!) / 2 };
}

let timer = 0;
let asked: AbortController | null = null;

/** Asks for the sol in which the slider is, where that is not the one that is there. */
export function askSky(state: State): void {
  const { terrain, day, sol } = state;
  if (!terrain?.terrain) return;
  if (sol && !sol.key.startsWith(`${terrain.terrain.name}/`)) return store.set({ sol: null }); // and asks again
  if (day.shows === "") return;
  const place = placeOf(state);
  const key = `${terrain.terrain.name}/${place.x_m},${place.y_m}`;
  if (sol?.key === key && (sol.refused || (day.at_ms >= sol.from_ms && day.at_ms <= sol.to_ms))) return;
  clearTimeout(timer);
  timer = window.setTimeout(() => {
    asked?.abort();
    asked = new AbortController();
    const at = new Date(day.at_ms).toISOString();
    get<components["schemas"]["PlaceSky"]>(`v1/terrains/${encodeURIComponent(terrain.terrain!.name!)}/sky?place=${place.x_m},${place.y_m}&from=${at}`, asked.signal)
      .then(({ moments }) => store.set({ sol: { key, place, moments, from_ms: Date.parse(moments[0]!.at), to_ms: Date.parse(moments.at(-1)!.at), refused: "" } }))
      .catch((error: unknown) => {
        if (error instanceof ServiceError && error.status === 422) store.set({ sol: { key, place, moments: [], from_ms: 0, to_ms: 0, refused: `${sentence(error.problem.detail ?? "")}.` } });
        else report(error);
      });
  }, apart_ms);
}

const winds = ["north", "north-east", "east", "south-east", "south", "south-west", "west", "north-west"];
export const windOf = (azimuth_deg: number): string => winds[Math.round(azimuth_deg / 45) % 8]!;

/** 13.4 is "13:24". */
export function clockText(hours: number): string {
  const minutes = Math.round(60 * (hours + 24)) % 1440;
  return `${String(Math.floor(minutes / 60)).padStart(2, "0")}:${String(minutes % 60).padStart(2, "0")}`;
}

/** "2016-03-22 04:33 UTC". */
export const utcText = (at: number | string): string => `${new Date(at).toISOString().slice(0, 16).replace("T", " ")} UTC`;
