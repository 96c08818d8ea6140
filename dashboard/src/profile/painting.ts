// What lies below and above the lines of a chart along a route: unknown ground, where rules trip, limits.
import type uPlot from "uplot";
import { swatch } from "../dom";
import { share, wheelWords } from "../format";
import { causeWords } from "../why";
import type { Rule, Stations } from "../result";

export const token = (name: string): string => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

export interface Painted {
  limits: { at: number; words: string }[];
  trips: Rule[];
}

/** Calls `draw` with the plot's area as the clip. */
function inside(u: uPlot, draw: (ctx: CanvasRenderingContext2D, px: number) => void): void {
  const { ctx } = u;
  const { left, top, width, height } = u.bbox;
  ctx.save();
  ctx.beginPath();
  ctx.rect(left, top, width, height);
  ctx.clip();
  draw(ctx, devicePixelRatio);
  ctx.restore();
}

/** The line of a limit over the whole plot, at this height of the canvas. */
export function strokeLimit(u: uPlot, y: number): void {
  const { ctx } = u;
  const { left, width } = u.bbox;
  const px = devicePixelRatio;
  ctx.strokeStyle = token("--limit");
  ctx.lineWidth = 2 * px;
  ctx.setLineDash([8 * px, 5 * px]);
  ctx.beginPath();
  ctx.moveTo(left, y);
  ctx.lineTo(left + width, y);
  ctx.stroke();
}

/** Below the lines: shades what lies on unknown ground and where a rule trips. */
export function paintGround(u: uPlot, stations: Stations, { trips }: Painted): void {
  inside(u, (ctx, px) => {
    const { top, height } = u.bbox;
    const shade = (from_m: number, to_m: number) => {
      const [from, to] = [u.valToPos(from_m, "x", true), u.valToPos(to_m, "x", true)];
      ctx.fillRect(from, top, Math.max(to - from, px), height);
      return from;
    };
    ctx.fillStyle = token("--unknown");
    const unknown = stations.on_unknown_ground;
    for (let i = 0; i < unknown.length; ++i) {
      if (!unknown[i]) continue;
      let end = i;
      while (end + 1 < unknown.length && unknown[end + 1]) ++end;
      shade(stations.distance_m[i]!, stations.distance_m[Math.min(end + 1, unknown.length - 1)]!);
      i = end;
    }
    for (const trip of trips) {
      ctx.fillStyle = token("--trip");
      const from = shade(trip.from_m!, trip.to_m ?? trip.from_m!);
      ctx.fillStyle = token("--limit");
      ctx.fillRect(from, top, 2 * px, height);
    }
  });
}

/** Above the lines: the limits with their values, and with which probability and why a rule trips. */
export function paintLimits(u: uPlot, { limits, trips }: Painted): void {
  inside(u, (ctx, px) => {
    const { left, top, width, height } = u.bbox;
    ctx.font = `${11 * px}px system-ui, sans-serif`;
    ctx.textAlign = "left"; // the axes leave their own
    ctx.textBaseline = "alphabetic";
    const write = (text: string, x: number, y: number) => {
      ctx.setLineDash([]);
      ctx.lineWidth = 4 * px;
      ctx.strokeStyle = token("--paper");
      ctx.strokeText(text, x, y);
      ctx.fillStyle = token("--limit");
      ctx.fillText(text, x, y);
    };
    const written: number[] = []; // heights of the labels, all at the right
    const least = 12 * px; // between two of them
    for (const limit of limits) {
      const y = u.valToPos(limit.at, "y", true);
      if (y < top - px || y > top + height + px) continue;
      strokeLimit(u, y);
      const places = [y - 4 * px, y + 12 * px].filter((at) => at > top + 10 * px && at < top + height);
      const at = places.find((place) => written.every((other) => Math.abs(other - place) >= least)) ?? places[0] ?? y;
      written.push(at);
      write(limit.words, left + width - ctx.measureText(limit.words).width - 4 * px, at);
    }
    trips.forEach((trip, k) => {
      const text = `${share(trip.trips.value)}${trip.cause ? `, ${causeWords(trip.cause)}` : ""}${trip.wheel ? `, ${wheelWords(trip.wheel)}` : ""}`;
      const from = u.valToPos(trip.from_m!, "x", true);
      write(text, Math.min(from + 5 * px, left + width - ctx.measureText(text).width - 4 * px), top + height - (5 + 13 * k) * px);
    });
  });
}

/** A piece of a line as the charts draw it. */
export function lineSwatch(colour: string, dash: readonly number[]): HTMLElement {
  const line = swatch(token(colour));
  line.className = `swatch line ${dash.length === 0 ? "" : dash[0]! < 4 ? "dotted" : "dashed-line"}`;
  line.style.backgroundColor = "transparent";
  line.style.borderTopColor = token(colour);
  return line;
}
