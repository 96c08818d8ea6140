// When the drive may begin, as the answer has it: the windows on a strip of time, and the best departure in words.
import { button, h } from "../dom";
import { metres, number, share } from "../format";
import { verdictWords, type Route } from "../result";
import { utcText } from "../sky";
import { store } from "../state";
import { reasonText } from "./advice";

export function windowsView(route: Route): HTMLElement[] {
  const { departures } = route.decision;
  if (!departures) return [];
  const { windows, best, halt, nearest, tried } = departures;
  const drive = best ?? nearest;
  // Of the same day the hour is enough.
  const after = (from: string, to: string) => (from.slice(0, 10) === to.slice(0, 10) ? utcText(to).slice(11) : utcText(to));
  // The whole minutes within.
  const minute = 60_000;
  const inward = (from: string, to: string) => [Math.ceil(Date.parse(from) / minute), Math.floor(Date.parse(to) / minute)].map((at) => new Date(at * minute).toISOString()) as [string, string];
  const told = (from: string, to: string) => (from >= to ? utcText(from) : `${utcText(from).slice(0, -4)} to ${after(from, to)}`);
  const range = (from: string, to: string) => told(...inward(from, to));
  const without = nearest?.rules.some(({ verdict }) => verdict === "no_go") ? "no_go" : "unknown";
  const [from_ms, to_ms] = [tried[0], tried.at(-1)].map((one) => Date.parse(one?.departs ?? ""));
  return [
    h("h3", {}, "When it may begin"),
    windows.length > 0
      ? h("ul", { class: "windows" }, windows.map(({ from, to }) => h("li", {}, h("span", { class: "badge go" }, "GO"), ` ${range(from, to)}`)))
      : h("p", {}, h("span", { class: `badge ${halt ? "go" : without}` }, verdictWords[halt ? "go" : without]), halt ? " Only with a halt to charge." : " No departure keeps all that is asked of the day."),
    from_ms! < to_ms! ? strip(windows, from_ms!, to_ms!, drive?.departs) : null,
    drive ? h("p", { "data-departs": drive.departs }, h("strong", {}, `${best ? "Best" : "Fewest rules broken"}: ${utcText(drive.departs)}.`),
      ` It arrives ${after(drive.departs, laterMinute(drive.arrives))}, at the slow pace ${after(drive.departs, laterMinute(drive.arrives_late))}. ${battery(drive)} The sun is on it for ${share(drive.lit_share)} of the time.`,
      halt && ` It halts for ${number(halt.hours)} h after ${metres(halt.at_m)} to charge.`) : null,
    nearest ? h("ul", { class: "reasons" }, nearest.rules.filter((rule) => rule.verdict !== "go").map((rule) => h("li", {}, reasonText(rule.words)))) : null,
    drive ? button("Show its shadows on the map", () => store.set({ day: { at_ms: Date.parse(drive.departs), shows: "shadow" } }), { class: "quiet", "data-do": "show-departure" }) : null,
  ].filter((part) => part !== null);
}

/** An arrival is told no earlier than it is. */
const laterMinute = (time: string): string => new Date(Math.ceil(Date.parse(time) / 60_000) * 60_000).toISOString();

/** A battery that would fall below empty is empty, at a place. The worse pace is the one that leaves less in it. */
function battery(drive: NonNullable<NonNullable<Route["decision"]["departures"]>["best"]>): string {
  const emptyAt = (key: "charge_percent" | "charge_low_percent") => drive.stations.find((at) => at[key] <= 0)?.distance_m;
  const lost = (at_m: number | undefined) => (at_m === undefined ? "empty on the way" : `empty at ${metres(at_m)}`);
  if (drive.least_charge_percent < 0) return `The battery is ${lost(emptyAt("charge_percent"))}.`;
  const usual = `The battery is at ${number(drive.charge_percent, 3)} % then, on the way never below ${number(drive.least_charge_percent, 3)} %`;
  return drive.least_charge_low_percent < 0
    ? `${usual}; at the worse pace it is ${lost(emptyAt("charge_low_percent"))}.`
    : `${usual} (at the worse pace ${number(drive.charge_low_percent, 3)} % and ${number(drive.least_charge_low_percent, 3)} %).`;
}

/** The windows between the first and the last departure that was tried, with the chosen one. */
function strip(windows: { from: string; to: string }[], from_ms: number, to_ms: number, departs: string | undefined): HTMLElement {
  const percent = (at: string) => (100 * (Date.parse(at) - from_ms)) / (to_ms - from_ms);
  const place = (element: HTMLElement, from: number, width?: number) => {
    element.style.left = `${from}%`;
    if (width !== undefined) element.style.width = `${width}%`;
    return element;
  };
  return h("div", { class: "strip" },
    h("div", { class: "strip-bar", role: "img", "aria-label": `${windows.length} windows of departure` },
      windows.map(({ from, to }) => place(h("span", { class: "strip-window" }), percent(from), percent(to) - percent(from))),
      departs && place(h("span", { class: "strip-best" }), percent(departs))),
    h("div", { class: "strip-ends" }, h("span", {}, utcText(new Date(from_ms).toISOString())), h("span", {}, utcText(new Date(to_ms).toISOString()))));
}
