// Recorded drives: what was predicted against what was driven, and a watch's evidence drive after drive.
import uPlot from "uplot";
import { h } from "../dom";
import { number, words } from "../format";
import { empty } from "../problem";
import { store, type State } from "../state";
import { lineSwatch, strokeLimit, token } from "./painting";

type Values = (number | null)[];
const series = [
  { key: "measured", title: "driven", colour: "--ink", width: 2.5, dash: [] as number[] },
  { key: "nominal", title: "predicted as believed before", colour: "--limit", width: 1.5, dash: [2, 4] },
  { key: "retuned", title: "predicted, re-tuned", colour: "--other", width: 1.5, dash: [8, 4] },
  { key: "with_effects", title: "predicted with the effects", colour: "--series", width: 2, dash: [] as number[] },
] as const;

export class FollowedCharts {
  plots: uPlot[] = [];
  private readouts: { element: HTMLElement; at: (k: number) => string }[] = [];
  private windows: number[] = []; // of the diagnosis, in the order of the charts
  private setting = false;

  constructor(private readonly list: HTMLElement) {}

  /** What is shown; "" where it is the route's charts. */
  shows({ tab, followed }: State): string {
    if (tab !== "drives" || !(followed.diagnosis || followed.watch)) return "";
    return [followed.diagnosis?.job, followed.watch?.job, followed.terrain, followed.drive].join("/");
  }

  clear(): void {
    for (const plot of this.plots) plot.destroy();
    this.plots = [];
    this.readouts = [];
  }

  draw(state: State): void {
    this.list.replaceChildren();
    if (state.followed.watch) this.addEvidence(state);
    if (state.followed.diagnosis) this.addChannels(state);
    this.point(state);
  }

  /** Points at the window that the map points at. */
  point({ followed }: State): void {
    if (this.setting) return;
    this.setting = true;
    const k = followed.window === null ? -1 : this.windows.indexOf(followed.window);
    for (const plot of this.plots) if (plot.root.dataset.windows) plot.setCursor({ left: k < 0 ? -10 : plot.valToPos(k, "x"), top: k < 0 ? -10 : 10 });
    this.setting = false;
    this.read(k);
  }

  /** Moves the cursor by so many windows. */
  step(windows: number): void {
    if (this.windows.length === 0) return;
    const now = store.state.followed.window === null ? -1 : this.windows.indexOf(store.state.followed.window);
    store.follow({ window: this.windows[Math.min(Math.max(now + windows, 0), this.windows.length - 1)]! });
  }

  private read(k: number): void {
    for (const { element, at } of this.readouts) element.textContent = k < 0 ? "" : at(k);
  }

  private box(title: string, ...more: (Node | string)[]): HTMLElement {
    const box = h("div", { class: "chart" });
    this.list.append(h("section", { class: "chart-box", "aria-label": title }, h("div", { class: "chart-head" }, h("h3", {}, title), ...more), box));
    return box;
  }

  private addChannels({ followed }: State): void {
    const all = followed.diagnosis!.document.where.windows;
    this.windows = all.flatMap((w, i) => (w.terrain === followed.terrain && (followed.drive === "" || w.drive === followed.drive) ? [i] : []));
    const shown = this.windows.map((i) => all[i]!);
    const channels = [...new Map(shown.flatMap((w) => (w.values ?? []).map((v) => [v.channel, v.unit] as const)))];
    if (channels.length === 0) {
      this.list.append(empty("This diagnosis was made before windows kept what was measured: diagnose the drives again."));
      return;
    }
    const key = h("div", { class: "key wide-key" }, series.flatMap((s) => [lineSwatch(s.colour, s.dash), h("span", {}, s.title)]), h("span", {}, followed.drive ? `drive ${followed.drive}, window after window` : "all drives on this ground in their order, window after window"));
    this.list.append(key);
    for (const [channel, unit] of channels) {
      const value = (name: string): Values => shown.map((w) => (w.values?.find((v) => v.channel === channel) as Record<string, number> | undefined)?.[name] ?? null);
      const lines = series.map((s) => value(s.key));
      const readout = h("span", { class: "readout" });
      this.readouts.push({ element: readout, at: (k) => `driven ${number(lines[0]![k], 2)}, believed ${number(lines[1]![k], 2)}, with effects ${number(lines[3]![k], 2)}` });
      const box = this.box(`${words(channel)}${unit === "1" ? "" : `, ${unit}`}`, readout);
      const plot = new uPlot(
        {
          ...frame(box),
          cursor: { y: false, sync: { key: "windows" } },
          axes: [{ ...axis(), size: 26, values: (_u, ticks) => ticks.map((t) => (Number.isInteger(t) ? (shown[t]?.drive ?? "") : "")) }, { ...axis(), size: 58, space: 18, values: (_u, ticks) => ticks.map((t) => number(t, 6)) }],
          series: [{}, ...series.map((s) => ({ stroke: token(s.colour), width: s.width, dash: [...s.dash], points: { show: shown.length < 60, size: 5, stroke: token(s.colour), fill: token(s.colour) } }))],
          hooks: { setCursor: [(u) => this.moved(u)] },
        },
        [shown.map((_, i) => i), ...lines] as uPlot.AlignedData,
        box,
      );
      plot.root.dataset.windows = "yes";
      this.plots.push(plot);
    }
  }

  private moved(u: uPlot): void {
    if (this.setting) return;
    const { idx, left } = u.cursor;
    const window = left === undefined || left < 0 || idx === null || idx === undefined ? null : (this.windows[idx] ?? null);
    if (window === store.state.followed.window) return;
    this.setting = true;
    store.follow({ window });
    this.setting = false;
    this.read(window === null ? -1 : idx!);
  }

  /** The decimal logarithm of the evidence that something has changed, up to each drive; the line is where an alarm is raised. */
  private addEvidence({ followed }: State): void {
    const { drives, alpha, alarm } = followed.watch!.document;
    const bar = Math.log10(1 / alpha);
    const at = (id: string | undefined) => drives.findIndex((d) => d.id === id);
    const box = this.box("Evidence of a change, drive after drive (log10)", h("span", { class: "key" }, lineSwatch("--limit", [8, 5]), `alarm at ${number(bar)}, twice running`));
    box.parentElement!.classList.add("wide-chart");
    const plot = new uPlot(
      {
        ...frame(box),
        cursor: { y: false },
        scales: { x: { time: false }, y: { range: (_u, min, max) => uPlot.rangeNum(Math.min(min, -0.5), Math.max(max, bar), 0.08, true) } },
        axes: [{ ...axis(), size: 26, values: (_u, ticks) => ticks.map((t) => (Number.isInteger(t) ? (drives[t]?.id ?? "") : "")) }, { ...axis(), size: 58 }],
        series: [{}, { stroke: token("--series"), width: 2, points: { show: true, size: 5, stroke: token("--series"), fill: token("--series") } }],
        hooks: { drawClear: [(u) => paintAlarm(u, bar, at(alarm?.since), at(alarm?.drive))] },
      },
      [drives.map((_, i) => i), drives.map((d) => d.log10_evidence ?? null)] as uPlot.AlignedData,
      box,
    );
    this.plots.push(plot);
  }
}

function paintAlarm(u: uPlot, bar: number, since: number, alarm: number): void {
  const { ctx } = u;
  const { top, height } = u.bbox;
  const px = devicePixelRatio;
  ctx.save();
  if (alarm >= 0) {
    const [from, to] = [u.valToPos(Math.max(since, 0), "x", true), u.valToPos(alarm, "x", true)];
    ctx.fillStyle = token("--trip");
    ctx.fillRect(from, top, Math.max(to - from, 2 * px), height);
    ctx.fillStyle = token("--limit");
    ctx.fillRect(to, top, 2 * px, height);
  }
  strokeLimit(u, u.valToPos(bar, "y", true));
  ctx.restore();
}

const axis = () => ({ stroke: token("--ink"), grid: { stroke: token("--line"), width: 1 }, ticks: { stroke: token("--line"), width: 1 }, font: "11px system-ui, sans-serif" });
const frame = (box: HTMLElement) => ({ width: Math.max(box.clientWidth, 200), height: 132, legend: { show: false }, scales: { x: { time: false } } });
