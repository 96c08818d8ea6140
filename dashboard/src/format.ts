// Numbers as people read them, always with their unit.
import type { Body } from "./map/body";

export function number(value: number | null | undefined, digits = 3): string {
  if (value === null || value === undefined || !Number.isFinite(value)) return "–";
  if (value !== 0 && Math.abs(value) < 1e-5) return value.toExponential(1);
  return String(Number(value.toPrecision(digits)));
}

/** A share in percent, as the service writes it in its reasons. */
export function share(value: number | null | undefined): string {
  if (value === null || value === undefined) return "–";
  const percent = 100 * value;
  if (percent > 0 && percent < 0.05) return `${number(percent, 2)} %`;
  return `${evenly(percent, percent > 0 && percent < 10 ? 1 : 0)} %`;
}

/** Halves to the even neighbour, as the service's own words have them. */
function evenly(value: number, decimals: number): string {
  const scaled = value * 10 ** decimals;
  const below = Math.floor(scaled);
  const tie = Math.abs(scaled - below - 0.5) < 1e-9;
  return ((tie ? below + (below % 2) : Math.round(scaled)) / 10 ** decimals).toFixed(decimals);
}

export function metres(value: number | null | undefined): string {
  return value === null || value === undefined ? "–" : `${value.toFixed(Math.abs(value) < 10 ? 2 : 1)} m`;
}

export function duration(seconds: number | null | undefined): string {
  if (seconds === null || seconds === undefined) return "–";
  if (seconds < 90) return `${seconds.toFixed(0)} s`;
  const minutes = Math.round(seconds / 60);
  return minutes < 90 ? `${minutes} min` : `${Math.floor(minutes / 60)} h ${minutes % 60} min`;
}

/** The first letter of a sentence. */
export const sentence = (text: string): string => text.slice(0, 1).toUpperCase() + text.slice(1);

export function words(name: string): string {
  return name.replaceAll("_", " ");
}

/** "msl-class" and the like, as people write it. */
export const roverWords = (name: string): string => words(name).replace(/-/g, " ").replace(/^(msl|mer|fido|m2020)\b/, (short) => short.toUpperCase()).replace(/^[a-z]/, (first) => first.toUpperCase());

/** "lf" is the left front wheel; wheels of other names keep them. */
export function wheelWords(name: string): string {
  const [, side, row] = /^([lr])([fmr])$/.exec(name) ?? [];
  return side && row ? `${{ l: "left", r: "right" }[side]} ${{ f: "front", m: "middle", r: "rear" }[row]} wheel` : `wheel ${words(name)}`;
}

/** A name without the unit at its end, which is said beside it. */
export const bareName = (name: string, unit: string | undefined): string => (unit && unit !== "1" ? name.replace(/_(deg|m|c|a|w|n|nm|kpa|pa|k|s|m_s|w_k|1_k|mm|cm|kg|hz|rad)$/i, "") : name);

/** "8142579.73, -276648.74", "137.37 E, 4.67 S" and the like; nothing where it is no place. */
export function readPlace(text: string, body?: Body | null): { x_m: number; y_m: number } | null {
  const degrees = [...text.matchAll(/(-?\d+(?:\.\d+)?)\s*°?\s*([EWNS])\b/gi)].map(([, value, letter]) => ({ value: Number(value) * (/[WS]/i.test(letter!) ? -1 : 1), east: /[EW]/i.test(letter!) }));
  if (degrees.length === 2 && degrees[0]!.east !== degrees[1]!.east) {
    const [east, north] = degrees[0]!.east ? degrees : [...degrees].reverse();
    const place = body?.fromDegrees(east!.value, north!.value);
    return place ? { x_m: Math.round(place[0] * 100) / 100, y_m: Math.round(place[1] * 100) / 100 } : null;
  }
  const numbers = text.trim().split(/[\s,;]+/).map(Number);
  if (numbers.length !== 2 || numbers.some((n) => !Number.isFinite(n)) || text.trim() === "") return null;
  return { x_m: numbers[0]!, y_m: numbers[1]! };
}

export function writePlace(place: { x_m: number; y_m: number } | null): string {
  return place ? `${place.x_m.toFixed(2)}, ${place.y_m.toFixed(2)}` : "";
}
