// Paths and command sequences out of texts: CSV, GeoJSON, and the words of `slipway check --command`.
import type { Body } from "../map/body";
import type { Place } from "../state";
import type { Command, Telemetry } from "./request";

export interface ReadPath {
  path?: Place[];
  commands?: Command[];
}

/** Throws an Error that says what is wrong and in which line. */
export function readPathText(text: string, body: Body | null): ReadPath {
  const trimmed = text.trim();
  if (trimmed === "") throw new Error("There is nothing to read: give two corners or more, or a command.");
  if (trimmed.startsWith("{") || trimmed.startsWith("[")) return readJson(trimmed, body);
  if (/^(drive|turn|arc)\s*=/i.test(trimmed)) return { commands: readCommands(trimmed) };
  return { path: readCsv(trimmed) };
}

function readCommands(text: string): Command[] {
  return text.split(/\s+/).map((word): Command => {
    const [name, value = ""] = word.split("=");
    const numbers = value.split(",").map(Number);
    if (value !== "" && numbers.every(Number.isFinite)) {
      if (name === "drive" && numbers.length === 1) return { drive_m: numbers[0]! };
      if (name === "turn" && numbers.length === 1) return { turn_deg: numbers[0]! };
      if (name === "arc" && numbers.length === 2) return { arc_m: numbers[0]!, radius_m: numbers[1]! };
    }
    throw new Error(`"${word}" is no command: drive=METRES, turn=DEGREES or arc=METRES,RADIUS.`);
  });
}

function readCsv(text: string): Place[] {
  const lines = text.split(/\r?\n/).filter((line) => line.trim() !== "" && !line.startsWith("#"));
  const head = lines[0]!.split(/[,;\t]/).map((cell) => cell.trim().toLowerCase());
  const named = head.some((cell) => Number.isNaN(Number(cell)));
  const x = named ? head.findIndex((cell) => ["x_m", "x", "easting", "easting_m"].includes(cell)) : 0;
  const y = named ? head.findIndex((cell) => ["y_m", "y", "northing", "northing_m"].includes(cell)) : 1;
  if (x < 0 || y < 0) throw new Error("The first line names no columns x_m and y_m.");
  return lines.slice(named ? 1 : 0).map((line, i) => {
    const cells = line.trim().split(/\s*[,;\t]\s*|\s+/).map(Number);
    if (!Number.isFinite(cells[x]) || !Number.isFinite(cells[y])) throw new Error(`Line ${i + (named ? 2 : 1)} has no place: "${line}".`);
    return { x_m: cells[x]!, y_m: cells[y]! };
  });
}

/** Telemetry so far, by the columns of `slipway check --drive-so-far`: WHEEL_current_a is the current of that wheel. */
export function readTelemetry(text: string): Telemetry {
  const lines = text.trim().split(/\r?\n/).filter((line) => line.trim() !== "" && !line.startsWith("#"));
  const head = (lines[0] ?? "").split(",").map((cell) => cell.trim());
  for (const needed of ["driven_m", "x_m", "y_m"]) if (!head.includes(needed)) throw new Error(`The first line of the telemetry names no column ${needed}.`);
  return lines.slice(1).map((line, i) => {
    const row: Record<string, unknown> = {};
    const wheels: Record<string, number> = {};
    line.split(",").forEach((cell, k) => {
      if (cell.trim() === "") return;
      const [name, value] = [head[k] ?? "", Number(cell)];
      if (!Number.isFinite(value)) throw new Error(`Line ${i + 2} of the telemetry: ${name || "a cell too many"} = "${cell.trim()}" is no number.`);
      if (name !== "current_a" && name.endsWith("_current_a")) wheels[name.slice(0, -"_current_a".length)] = value;
      else row[name] = value;
    });
    return (Object.keys(wheels).length > 0 ? { ...row, currents_a: wheels } : row) as Telemetry[number];
  });
}

/* eslint-disable @typescript-eslint/no-explicit-any */
function readJson(text: string, body: Body | null): ReadPath {
  let document: any;
  try {
    document = JSON.parse(text);
  } catch (error) {
    throw new Error(`This is no JSON: ${(error as Error).message}`);
  }
  if (Array.isArray(document)) {
    if (document.every((one) => typeof one?.x_m === "number")) return { path: document.map(({ x_m, y_m }) => ({ x_m, y_m })) };
    return { commands: document };
  }
  if (Array.isArray(document.path)) return { path: document.path };
  if (Array.isArray(document.commands)) return { commands: document.commands };
  const line = lineOf(document);
  if (!line) throw new Error("There is no LineString in this GeoJSON.");
  // RFC 7946 says degrees; this service's own GeoJSON says with crs_name that its places are metres.
  const inDegrees = document.crs_name === undefined && line.every(([x, y]) => Math.abs(x!) <= 360 && Math.abs(y!) <= 90);
  return {
    path: line.map(([x, y]) => {
      const place = inDegrees ? body?.fromDegrees(x!, y!) : [x!, y!];
      if (!place) throw new Error("Degrees can't be brought onto this terrain's map: give metres.");
      return { x_m: Math.round(place[0]! * 1000) / 1000, y_m: Math.round(place[1]! * 1000) / 1000 };
    }),
  };
}

function lineOf(value: any): number[][] | null {
  if (value?.type === "LineString") return value.coordinates;
  if (value?.type === "Feature") return lineOf(value.geometry);
  if (value?.type === "FeatureCollection") for (const one of value.features) {
    const line = lineOf(one);
    if (line) return line;
  }
  return null;
}
