// Series against metres driven, under each other with one cursor, which is also a place on the map.
import uPlot from "uplot";
import type { Limits } from "../api/client";
import { fill, h, swatch } from "../dom";
import { number, share } from "../format";
import { empty } from "../problem";
import { resampled, tripsOf, type DrivenStretch, type Route, type Stations } from "../result";
import { store, type State } from "../state";
import { FollowedCharts } from "./followed_charts";
import { lineSwatch, paintGround, paintLimits, token, type Painted } from "./painting";

type Values = (number | null)[];
interface Chart {
  key: string;
  title: string;
  line: (s: Stations, ends_m: number[]) => Values | undefined; // of the route's segments; undefined: not asked for
  digits?: number;
  low?: (s: Stations) => Values;
  high?: (s: Stations) => Values;
  second?: { title: string; line: (s: Stations) => Values | undefined };
  limit?: string; // key in the request's limits
  beyond?: { key: string; words: string }; // and of a second one, behind which it is worse
  both?: boolean; // the limit holds to both sides
  rule?: string; // that trips at it
}

/** The sum up to each station; each segment begins anew. */
function summed(values: Values, { distance_m }: Stations, ends_m: number[]): Values {
  let [sum, k] = [0, 0];
  return values.map((v, i) => {
    while (k < ends_m.length - 1 && distance_m[i]! >= ends_m[k]!) [sum, k] = [0, k + 1];
    return (sum += v ?? 0);
  });
}

function energy(s: Stations): Values {
  let sum = 0;
  return s.power_w.map((power, i) => (sum += i === 0 || power === null ? 0 : (power * (s.elapsed_s[i]! - s.elapsed_s[i - 1]!)) / 3600));
}

export const charts: Chart[] = [
  { key: "height", title: "Elevation, m", line: (s) => s.height_m, digits: 6 },
  { key: "slip", title: "Slip, ratio (band: 5 to 95 % of the draws)", line: (s) => s.slip_p50, low: (s) => s.slip_p05, high: (s) => s.slip_p95, limit: "max_slip", beyond: { key: "embedding_slip", words: "wheels dig from" }, rule: "slip_check" },
  { key: "stops", title: "Probability of a halt up to here, share of the draws", line: (s, ends_m) => summed(s.expected_stops, s, ends_m), limit: "max_stop", beyond: { key: "no_go_stop", words: "NO-GO above" } },
  { key: "embedding", title: "Embedded up to here, share of the draws", line: (s, ends_m) => summed(s.embedding, s, ends_m), limit: "max_embedding", rule: "embedding" },
  { key: "sinkage", title: "Sinkage, deepest wheel, 95 % of the draws are below, m", line: (s) => s.sinkage_m_p95, limit: "max_sinkage_m", rule: "sinkage" },
  { key: "current", title: "Current, hottest motor, 95 % of the draws are below, A", line: (s) => s.current_a_p95, limit: "max_current_a", rule: "current" },
  { key: "tilt", title: "Tilt, deg (band: 5 to 95 % of the draws)", line: (s) => s.tilt_deg, low: (s) => s.tilt_deg_p05, high: (s) => s.tilt_deg_p95, limit: "max_tilt_deg", rule: "tilt" },
  { key: "clearance", title: "Clearance of the belly, m (band: 5 to 95 % of the draws)", line: (s) => s.clearance_m, low: (s) => s.clearance_m_p05, high: (s) => s.clearance_m_p95, limit: "min_clearance_m", rule: "clearance" },
  { key: "side_slip", title: "Side slip, deg", line: (s) => s.side_slip_deg, limit: "max_side_slip_deg", rule: "side_slip", both: true },
  { key: "aside", title: "Way to the side between checks, m (band: 5 to 95 % of the draws)", line: (s) => s.aside_m, low: (s) => s.aside_m_p05, high: (s) => s.aside_m_p95, limit: "max_aside_m", rule: "aside", both: true },
  { key: "attitude", title: "Pitch and roll (dashed), deg", line: (s) => s.pitch_deg, second: { title: "roll", line: (s) => s.roll_deg } },
  { key: "energy", title: "Energy up to here, Wh", line: energy },
  { key: "power", title: "Power of the drive motors, W", line: (s) => s.power_w },
  { key: "charge", title: "Battery (dashed: at the worse pace), %", line: (s) => s.charge_percent, second: { title: "worse pace", line: (s) => s.charge_low_percent }, limit: "min_charge_percent" },
  { key: "motor", title: "Hottest drive motor, an envelope (dashed: at the slow pace), degC", line: (s) => s.motor_c, second: { title: "slow pace", line: (s) => s.motor_slow_c } },
  { key: "in_out", title: "Power in and out (dashed), W", line: (s) => s.in_w, second: { title: "out", line: (s) => s.out_w } },
  { key: "sun", title: "Sun over the ground's horizon, deg", line: (s) => s.sun_over_horizon_deg },
];
/** Charts of the day are there where it was asked for. */
const offered = ({ stations }: Route): Chart[] => charts.filter(({ line }) => line(stations, []) !== undefined);
/** Each wheel's own, with the mean soils. */
const wheelCharts = [
  { key: "slip", title: "Wheels: slip, ratio" },
  { key: "sinkage_m", title: "Wheels: sinkage, m", limit: "max_sinkage_m" },
  { key: "current_a", title: "Wheels: current, A", limit: "max_current_a" },
];
/** Apart for colour-blind eyes [Okabe and Ito 2008]. */
const wheelColours = ["#0072b2", "#e69f00", "#009e73", "#cc79a7", "#d55e00", "#56b4e9"];

function limitsOf({ limit, beyond, both }: Pick<Chart, "limit" | "beyond" | "both">, limits: Record<string, number>): Painted["limits"] {
  const of = (key: string | undefined, words: string, sign = 1) => (key !== undefined && limits[key] !== undefined ? [{ at: sign * limits[key], words: `${words} ${number(sign * limits[key])}` }] : []);
  return [...of(limit, limit?.startsWith("min") ? "at least" : limit === "max_stop" || limit === "max_embedding" ? "GO below" : "limit"), ...(both ? of(limit, "limit", -1) : []), ...of(beyond?.key, beyond?.words ?? "")];
}

const points = { show: false };
const axes = (): uPlot.Axis[] => {
  const axis = { stroke: token("--ink"), grid: { stroke: token("--line"), width: 1 }, ticks: { stroke: token("--line"), width: 1 }, font: "11px system-ui, sans-serif" };
  return [{ ...axis, size: 26, values: (_u, ticks) => ticks.map((t) => `${t} m`) }, { ...axis, size: 66, space: 18, values: (_u, ticks) => ticks.map((t) => (t === null ? "" : number(t, 6))) }];
};
const usuallyShown = ["height", "slip", "stops", "embedding", "sinkage", "current", "charge", "in_out"];

type Read = number | null | undefined;
function readoutOf([line, low, high, second, other]: Read[], digits: number, at_m: number): string {
  const parts = [number(line, digits)];
  if (low !== undefined) parts.push(`(${number(low)} to ${number(high)})`);
  if (second !== undefined) parts.push(`/ ${number(second)}`);
  if (other !== undefined) parts.push(`· compared ${number(other, digits)}`);
  return `${parts.join(" ")} at ${at_m.toFixed(1)} m`;
}

export class ProfileCharts {
  private plots: { plot: uPlot; read: (i: number | null) => void; take?: (limits: Record<string, number>) => void }[] = [];
  private moved_limits: Limits = store.state.options.limits;
  private shown = new Set(usuallyShown);
  private readonly list = h("div", { class: "charts", tabindex: 0, role: "region", "aria-label": "Charts along the route" });
  private measured: uPlot | null = null; // of a drive so far
  private drawnRoute: Route | null = null;
  private readonly followed = new FollowedCharts(this.list);
  private setting = false; // the cursor is being set from the state

  constructor(private readonly target: HTMLElement) {
    new ResizeObserver(() => this.resize()).observe(this.list);
    store.on(["result", "route", "compared", "other"], (s) => this.draw(s));
    let shown = this.followed.shows(store.state);
    store.on(["tab", "followed"], (s) => {
      const next = this.followed.shows(s);
      if (next !== shown) {
        shown = next;
        this.draw(s);
      } else if (next) this.followed.point(s);
    });
    store.on(["hover_m"], (s) => this.point(s));
    store.on(["options"], ({ options, result }) => {
      if (options.limits === this.moved_limits) return;
      this.moved_limits = options.limits;
      for (const { plot, take } of this.plots) {
        take?.({ ...result?.limits, ...options.limits });
        plot.setData(plot.data);
      }
    });
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.draw(store.state));
  }

  draw(state: State): void {
    for (const { plot } of this.plots) plot.destroy();
    this.plots = [];
    this.measured?.destroy();
    this.measured = null;
    this.followed.clear();
    if (this.followed.shows(state)) {
      this.drawnRoute = null;
      fill(this.target, this.list);
      this.followed.draw(state);
      return;
    }
    const route = state.result?.routes[state.route] ?? null;
    this.drawnRoute = route;
    if (!route) {
      fill(this.target, empty(state.result ? "There is no route to draw." : "Plan a drive or check one: its profile appears here, with every limit."));
      return;
    }
    const second = state.compared !== null ? state.result?.routes[state.compared] : state.other?.routes[0];
    fill(this.target, this.choice(route, second ? (state.compared !== null ? second.title : `kept ${second.title.toLowerCase()}`) : ""), this.list);
    this.list.replaceChildren();
    for (const chart of wheelCharts) if (this.shown.has(chart.title)) this.addWheels(chart, route.stations, limitsOf(chart, state.result!.limits));
    if (state.result!.driven.length > 0) this.addDriven(state.result!.driven);
    const tripped = new Set<string>(tripsOf(route).map((rule) => rule.rule));
    for (const chart of offered(route)) if (this.shown.has(chart.key) || tripped.has(chart.rule ?? "")) this.add(chart, route, second ?? null, { ...state.result!.limits, ...state.options.limits });
    this.point(state);
  }

  private choice(route: Route, second: string): HTMLElement {
    return h(
      "div",
      { class: "chips", role: "group", "aria-label": "Which series are shown" },
      [...offered(route), ...wheelCharts.map(({ title }) => ({ key: title, title }))].map(({ key, title }) => {
        const pressed = this.shown.has(key);
        return h("button", { type: "button", class: "chip", "aria-pressed": String(pressed), onclick: () => {
          if (pressed) this.shown.delete(key);
          else this.shown.add(key);
          this.draw(store.state);
        } }, title.split(",")[0]!.replace(/ \(.*/, ""));
      }),
      h("span", { class: "key" }, second && [lineSwatch("--other", [3, 3]), second], h("span", { class: "swatch shaded" }), "unknown ground", h("span", { class: "swatch limit" }), "limit", h("span", { class: "swatch trip" }), "a rule trips in some draws"),
    );
  }

  private add(chart: Chart, route: Route, second: Route | null, limits: Record<string, number>): void {
    const s = route.stations;
    const painted: Painted = { limits: [], trips: tripsOf(route).filter((r) => r.rule === chart.rule) };
    // Limits that are moved move their lines.
    const take = (now: Record<string, number>) => (painted.limits = limitsOf(chart, now));
    take(limits);
    const held = () => painted.limits.slice(0, chart.both ? 2 : 1).map((l) => l.at);
    const ends_m = ({ outcomes: { segments } }: Route) => (segments ?? []).map((segment) => segment.to_m);
    const columns: (Values | null)[] = [chart.line(s, ends_m(route)) ?? null, chart.low?.(s) ?? null, chart.high?.(s) ?? null, chart.second?.line(s) ?? null];
    columns.push(second ? resampled(chart.line(second.stations, ends_m(second)) ?? [], second.stations.distance_m, s.distance_m) : null);
    const given = columns.map((c) => c ?? s.distance_m.map(() => null));
    const readout = h("span", { class: "readout" });
    const box = h("div", { class: "chart" });
    this.list.append(h("section", { class: "chart-box", "aria-label": chart.title }, h("div", { class: "chart-head" }, h("h3", {}, chart.title), readout), box));
    if (painted.trips.length > 0) box.parentElement!.append(h("p", { class: "visually-hidden" }, painted.trips.map((r) => `${r.words} trips in ${share(r.trips.value)} of the draws from ${number(r.from_m)} to ${number(r.to_m)} m. `).join("")));
    const plot = new uPlot(
      {
        width: Math.max(box.clientWidth, 200),
        height: 112,
        legend: { show: false },
        cursor: { y: false, sync: { key: "route" }, drag: { x: true, y: false } },
        scales: {
          x: { time: false },
          y: { range: (_u, min, max) => uPlot.rangeNum(Math.min(min, ...held()), Math.max(max, ...held()), 0.08, true) },
        },
        axes: axes(),
        bands: chart.low ? [{ series: [3, 2], fill: token("--band") }] : [],
        series: [
          {},
          { stroke: token("--series"), width: 2, points },
          { stroke: chart.low ? token("--series") : "transparent", width: chart.low ? 0.5 : 0, show: !!chart.low, points },
          { stroke: chart.high ? token("--series") : "transparent", width: chart.high ? 0.5 : 0, show: !!chart.high, points },
          { stroke: token("--series"), width: 2, dash: [6, 4], show: !!chart.second, points },
          { stroke: token("--other"), width: 2, dash: [3, 3], show: !!second, points },
        ],
        hooks: {
          drawClear: [(u) => paintGround(u, s, painted)],
          draw: [(u) => paintLimits(u, painted)],
          setCursor: [(u) => this.moved(u)],
        },
      },
      [s.distance_m, ...given] as uPlot.AlignedData,
      box,
    );
    const digits = chart.digits ?? 3;
    this.plots.push({ plot, take, read: (i) => (readout.textContent = i === null ? "" : readoutOf(columns.map((v) => v?.[i]), digits, s.distance_m[i]!)) });
  }

  private addWheels({ key, title }: (typeof wheelCharts)[number], s: Stations, limits: Painted["limits"]): void {
    const wheels = Object.entries(s.wheels ?? {}).filter(([, columns]) => columns[key]);
    if (wheels.length === 0) return;
    const box = h("div", { class: "chart" });
    const readouts = wheels.map(() => h("span", { class: "wheel-value" }));
    const names = wheels.map(([name], k) => [swatch(wheelColours[k % wheelColours.length]!), name, " ", readouts[k]!]);
    this.list.append(h("section", { class: "chart-box", "aria-label": title }, h("div", { class: "chart-head" }, h("h3", {}, title), h("span", { class: "wheel-names" }, names.flat())), box));
    const painted = { limits, trips: [] };
    const plot = new uPlot(
      {
        width: Math.max(box.clientWidth, 200),
        height: 112,
        legend: { show: false },
        cursor: { y: false, sync: { key: "route" } },
        scales: { x: { time: false }, y: { range: (_u, min, max) => uPlot.rangeNum(min, Math.max(max, limits[0]?.at ?? max), 0.08, true) } },
        axes: axes(),
        series: [{}, ...wheels.map((_, k) => ({ stroke: wheelColours[k % wheelColours.length]!, width: 1.5, points }))],
        hooks: { drawClear: [(u) => paintGround(u, s, painted)], draw: [(u) => paintLimits(u, painted)], setCursor: [(u) => this.moved(u)] },
      },
      [s.distance_m, ...wheels.map(([, columns]) => columns[key]!)] as uPlot.AlignedData,
      box,
    );
    this.plots.push({ plot, read: (i) => readouts.forEach((cell, k) => (cell.textContent = i === null ? "" : number(wheels[k]![1][key]![i], 2))) });
  }

  /** What was measured so far and what had been predicted, on one axis: the way by odometry, apart from the route ahead. */
  private addDriven(driven: DrivenStretch[]): void {
    const box = h("div", { class: "chart" });
    const title = "Slip driven so far: measured (dashed) against predicted (band: 5 to 95 %)";
    this.list.append(h("section", { class: "chart-box", "aria-label": title }, h("div", { class: "chart-head" }, h("h3", {}, title)), box));
    const of = (value: (s: DrivenStretch) => number): Values => [value(driven[0]!), ...driven.map(value)];
    const step = uPlot.paths.stepped!({ align: -1 });
    const plot = new uPlot(
      {
        width: Math.max(box.clientWidth, 200),
        height: 112,
        legend: { show: false },
        cursor: { y: false },
        scales: { x: { time: false } },
        axes: axes(),
        bands: [{ series: [4, 3], fill: token("--band") }],
        series: [
          {},
          { stroke: token("--limit"), width: 2, dash: [6, 4], paths: step },
          { stroke: token("--series"), width: 2, paths: step },
          { stroke: token("--series"), width: 0.5, paths: step },
          { stroke: token("--series"), width: 0.5, paths: step },
        ],
      },
      [[driven[0]!.from_m, ...driven.map((s) => s.to_m)], of((s) => s.slip), of((s) => s.predicted_slip.p50), of((s) => s.predicted_slip.p05), of((s) => s.predicted_slip.p95)] as uPlot.AlignedData,
      box,
    );
    this.measured = plot;
  }

  /** The cursor of a chart was moved by hand. */
  private moved(u: uPlot): void {
    if (this.setting || !this.drawnRoute) return;
    const { idx, left } = u.cursor;
    const at = left === undefined || left < 0 || idx === null || idx === undefined ? null : this.drawnRoute.stations.distance_m[idx]!;
    this.setting = true;
    store.set({ hover_m: at });
    this.setting = false;
    this.read(at === null ? null : idx!);
  }

  /** The place that the map points at. */
  private point(state: State): void {
    if (this.setting || !this.drawnRoute) return;
    this.setting = true;
    for (const { plot } of this.plots) {
      const left = state.hover_m === null ? -10 : plot.valToPos(state.hover_m, "x");
      plot.setCursor({ left, top: left < 0 ? -10 : 10 });
    }
    this.setting = false;
    const d = this.drawnRoute.stations.distance_m;
    this.read(state.hover_m === null ? null : d.findIndex((v) => v >= state.hover_m! - 1e-9));
  }

  private read(i: number | null): void {
    for (const { read } of this.plots) read(i === null || i < 0 ? null : i);
  }

  private resize(): void {
    for (const plot of [...this.plots.map((p) => p.plot), ...(this.measured ? [this.measured] : []), ...this.followed.plots]) {
      const width = plot.root.parentElement!.clientWidth;
      if (width > 0 && Math.abs(width - plot.width) > 1) plot.setSize({ width, height: plot.height });
    }
  }

  /** Moves the cursor by so many stations, or windows of recorded drives: for the keyboard. */
  step(stations: number): void {
    if (this.followed.shows(store.state)) {
      this.followed.step(stations);
      return;
    }
    const route = this.drawnRoute;
    if (!route) return;
    const d = route.stations.distance_m;
    const now = store.state.hover_m === null ? -1 : d.findIndex((v) => v >= store.state.hover_m! - 1e-9);
    const next = Math.min(Math.max(now + stations, 0), d.length - 1);
    store.set({ hover_m: d[next]! });
  }
}
