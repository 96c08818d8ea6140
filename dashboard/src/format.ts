// Numbers as people read them, always with their unit.

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

/** "8142579.73, -276648.74" and the like; nothing where it is no place. */
export function readPlace(text: string): { x_m: number; y_m: number } | null {
  const numbers = text.trim().split(/[\s,;]+/).map(Number);
  if (numbers.length !== 2 || numbers.some((n) => !Number.isFinite(n)) || text.trim() === "") return null;
  return { x_m: numbers[0]!, y_m: numbers[1]! };
}

export function writePlace(place: { x_m: number; y_m: number } | null): string {
  return place ? `${place.x_m.toFixed(2)}, ${place.y_m.toFixed(2)}` : "";
}
