// The time of day: a slider over one sol, with sun and Earth, and what of the ground lies in shadow then.
import { field, fill, h, svg, swatch } from "../dom";
import { number } from "../format";
import { askSky, clockText, momentAt, utcText, windOf, type Moment } from "../sky";
import { palettes, store, type Day, type State } from "../state";

const step_ms = 300_000;
/** As the service draws them, by the share of the daylight in which the sun reaches the ground. */
export const sunlitColours = [...palettes["cividis"]!].reverse();
const sunlitLabels = ["below 25 %", "25 to 50 %", "50 to 75 %", "75 to 90 %", "90 % and more"];

/** To where the sun stands; north is up. */
function arrow({ azimuth_deg, elevation_deg }: Moment["sun"]): SVGElement {
  const up = elevation_deg > 0;
  return svg("svg", { viewBox: "-16 -16 32 32", width: 30, height: 30, role: "img", "aria-label": `The sun stands in the ${windOf(azimuth_deg)}` },
    svg("circle", { cx: 0, cy: 0, r: 14, fill: "none", stroke: "currentColor", "stroke-width": 1 }),
    svg("g", { transform: `rotate(${azimuth_deg.toFixed(1)})` },
      svg("path", { d: "M0 11 V-4", stroke: "currentColor", "stroke-width": 2.5, "stroke-dasharray": up ? "none" : "3 3" }),
      svg("circle", { cx: 0, cy: -8, r: 4.5, fill: up ? "#ffd400" : "none", stroke: "currentColor", "stroke-width": 1.5 })));
}

const height = ({ elevation_deg, azimuth_deg }: Moment["sun"]): string => `${number(Math.abs(elevation_deg), 2)}° ${elevation_deg < 0 ? "below" : "over"} the level in the ${windOf(azimuth_deg)} (${azimuth_deg.toFixed(0)}°)`;

function set(change: Partial<Day>): void {
  store.set({ day: { ...store.state.day, ...change } });
}

export function dayPanel(target: HTMLDetailsElement): void {
  const kinds: [Day["shows"], string][] = [["", "nothing"], ["shadow", "shadow"], ["share", "sunlit share"]];
  const choice = h("div", { class: "row", role: "group", "aria-label": "What the map shows of the sunlight" });
  const date = h("input", { type: "date", required: true, onchange: () => {
    const at_ms = Date.parse(`${date.value}T${new Date(store.state.day.at_ms).toISOString().slice(11)}`);
    if (Number.isFinite(at_ms)) set({ at_ms });
  } });
  const slider = h("input", { type: "range", step: step_ms, "aria-label": "Time of day", "data-day": true, oninput: () => set({ at_ms: Number(slider.value) }) });
  const told = h("div", { class: "day-told", role: "status", "aria-live": "off" });
  const legend = h("div");
  const fields = h("div", {}, field("Day (UTC)", date), slider, told, legend);
  const refused = h("p", { class: "hint", "data-no-sky": true });
  target.append(h("summary", {}, "Time of day"), choice, refused, fields);
  // Who opens it wants to see a shadow.
  target.addEventListener("toggle", () => target.open && store.state.day.shows === "" && set({ shows: "shadow" }));
  target.open = store.state.day.shows !== "";
  store.on(["day"], ({ day }) => fill(choice, kinds.map(([shows, text]) => h("button", { type: "button", class: "chip", "aria-pressed": String(day.shows === shows), "data-shows": shows, onclick: () => set({ shows }) }, text))));
  store.on(["day", "terrain", "drawn", "sol"], askSky);
  store.on(["day", "sol"], ({ day, sol }) => {
    refused.textContent = sol?.refused ?? "";
    refused.hidden = !sol?.refused;
    fields.hidden = day.shows === "" || !!sol?.refused;
    date.value = new Date(day.at_ms).toISOString().slice(0, 10);
    if (!sol || sol.refused || day.shows === "") return;
    slider.min = String(sol.from_ms);
    slider.max = String(sol.to_ms);
    slider.value = String(day.at_ms);
    const now = momentAt(sol, day.at_ms);
    slider.setAttribute("aria-valuetext", `${clockText(now.true_solar_h)} local true solar time`);
    fill(told, arrow(now.sun), h("div", {},
      h("p", {}, h("strong", { "data-clock": true }, clockText(now.true_solar_h)), ` local true solar time (mean ${clockText(now.mean_solar_h)})`),
      h("p", {}, `${utcText(day.at_ms)}, Ls ${now.solar_longitude_deg.toFixed(0)}°`),
      h("p", {}, `Sun ${height(now.sun)}`),
      h("p", {}, `${store.state.drawn.start ? "The start" : "The middle of the map"} is ${now.lit ? "in the sun" : "in shadow"}; the ground hides what is below ${number(now.horizon_deg, 2)}°`),
      h("p", {}, `Earth ${height(now.earth)}`)));
    fill(legend, day.shows === "share"
      ? [h("p", { class: "hint" }, "The sun reaches the ground in this share of the sol's daylight"), h("ul", { class: "legend" }, sunlitLabels.map((label, k) => h("li", {}, swatch(sunlitColours[k]!), label)))]
      : h("ul", { class: "legend" }, h("li", {}, swatch("#101430"), "in shadow")));
  });
  startAtDeparture();
  // The rover stands where it is at that time.
  store.on(["day"], ({ day, result, route }) => {
    const times = result?.routes[route]?.stations.at_ms;
    if (!times || day.shows === "" || day.at_ms < times[0]! || day.at_ms > times.at(-1)!) return;
    const k = times.findIndex((at) => at >= day.at_ms);
    store.set({ hover_m: result.routes[route]!.stations.distance_m[k]! });
  });
}

/** The slider begins at the best departure of the route, unless a link has brought another time. */
function startAtDeparture(): void {
  let given = new URLSearchParams(location.hash.slice(1)).has("at");
  let before = "";
  store.on(["result", "route"], ({ result, route }) => {
    const { departures } = result?.routes[route]?.decision ?? {};
    const departs = (departures?.best ?? departures?.nearest)?.departs;
    if (!departs || departs === before) return;
    before = departs;
    if (!given) set({ at_ms: Date.parse(departs) });
    given = false;
  });
}

/** On the map, where the panel may be out of sight. */
export function daySign(target: HTMLElement): void {
  store.on(["day", "sol"], ({ day, sol }: State) => {
    if (day.shows === "" || !sol || sol.refused) return fill(target);
    const now = momentAt(sol, day.at_ms);
    fill(target, arrow(now.sun), h("span", {}, day.shows === "share" ? "Sunlit share of the sol" : `Shadow at ${clockText(now.true_solar_h)}, sun ${now.sun.elevation_deg < 0 ? "down" : `${number(now.sun.elevation_deg, 2)}° high`}`));
  });
}
