// The form of a plan: by clicks on the map, by typing, by keyboard.
import { asCurl } from "../api/client";
import type { TerrainMap } from "../map/terrain_map";
import { button, field, fill, folded, h } from "../dom";
import { readPlace, sentence, words, writePlace } from "../format";
import { placeInDegrees } from "../map/body";
import { firstTool, store, type Drawn, type Place, type Tool } from "../state";
import { planNow } from "../work";
import { options } from "./options";
import { examplesView } from "./examples";
import { planDraft } from "./request";

const tools: { tool: Tool; text: string; key: string }[] = [
  { tool: "start", text: "Start", key: "S" },
  { tool: "goal", text: "Goal", key: "G" },
  { tool: "waypoint", text: "Way point", key: "W" },
  { tool: "keep_out", text: "Keep out", key: "K" },
  { tool: "keep_in", text: "Keep in", key: "I" },
];

/** A tool that is pressed again is put down, unless it is what the plan lacks. */
function pick(tool: Tool, now: Tool): void {
  store.set({ tool: tool === now ? firstTool(store.state) : tool });
}

/** Buttons that say what a click on the map does. */
export function toolBar(shown: Tool[]): HTMLElement {
  const bar = h("div", { class: "tools", role: "group", "aria-label": "What a click on the map does" });
  store.on(["tool"], ({ tool }) => {
    fill(
      bar,
      tools
        .filter((t) => shown.includes(t.tool))
        .map((t) =>
          h("button", { type: "button", "aria-pressed": String(t.tool === tool), title: `Key ${t.key}`, "data-tool": t.tool, onclick: () => pick(t.tool, tool) }, t.text),
        ),
    );
  });
  return bar;
}

interface PlaceField {
  element: HTMLElement;
  show: (place: Place | null) => void;
}

/** Stays while others change: what is being typed into it is not lost. */
function placeField(label: string, id: string, map: TerrainMap, change: (place: Place | null) => void): PlaceField {
  const degrees = h("small", { "data-degrees": id });
  const input = h("input", {
    id,
    placeholder: "x, y in metres, or degrees: 137.4 E, 4.7 S",
    inputmode: "text",
    autocomplete: "off",
    spellcheck: "false",
    onchange: () => {
      const place = readPlace(input.value, map.body);
      input.setCustomValidity(place || input.value.trim() === "" ? "" : "Two numbers: x and y in metres, or longitude with E or W and latitude with N or S");
      if (input.reportValidity()) change(place);
    },
  });
  return {
    element: h("div", {}, field(label, input), degrees),
    show: (place) => {
      const text = writePlace(place);
      degrees.textContent = place ? placeInDegrees(place, map.body) : "";
      if (input.value !== text && document.activeElement !== input) input.value = text;
      else if (readPlace(input.value, map.body) === null && place) input.value = text;
    },
  };
}

export function zones(): HTMLElement {
  const list = h("div", { class: "zones" });
  let shown: unknown = null;
  store.on(["drawn"], ({ drawn }) => {
    const now = JSON.stringify([drawn.keep_out, drawn.keep_in]);
    if (now === shown) return; // a drag moves other things
    shown = now;
    const row = (kind: "keep_out" | "keep_in", words: string) =>
      drawn[kind].map((ring, i) =>
        h("li", {}, h("span", {}, `${words} ${i + 1}, ${ring.length} corners`), button("Remove", () => store.draw({ [kind]: drawn[kind].filter((_, k) => k !== i) }), { class: "quiet", "aria-label": `Remove ${words} ${i + 1}` })),
      );
    const rows = [...row("keep_out", "keep out"), ...row("keep_in", "keep in")];
    fill(list, rows.length > 0 && h("ul", { class: "plain" }, rows));
  });
  return list;
}

export function planPanel(target: HTMLElement, map: TerrainMap): void {
  const common = h("div");
  // What has been typed needs no click any more.
  const put = (change: Partial<Drawn>) => {
    store.draw(change);
    if (["start", "goal"].includes(store.state.tool)) store.set({ tool: firstTool(store.state) });
  };
  const from = placeField("Start", "plan-start", map, (place) => put({ start: place }));
  const goal = placeField("Goal", "plan-goal", map, (place) => put({ goal: place }));
  const via = h("div");
  let waypoints: PlaceField[] = [];
  const weights = h("details", { class: "weights" });
  const curl = h("details");
  const go = button("Plan the drive", planNow, { class: "primary", "data-do": "plan" });
  const hint = h("p", { class: "hint", id: "plan-hint" });
  go.setAttribute("aria-describedby", "plan-hint");
  options(common, "plan");
  store.on(["drawn", "terrain"], ({ drawn }) => {
    from.show(drawn.start);
    goal.show(drawn.goal);
    if (waypoints.length !== drawn.waypoints.length) {
      const change = (i: number, place: Place | null) => store.draw({ waypoints: store.state.drawn.waypoints.flatMap((w, k) => (k === i ? (place ? [place] : []) : [w])) });
      waypoints = drawn.waypoints.map((_, i) => placeField(`Way point ${i + 1}`, `plan-via-${i}`, map, (place) => change(i, place)));
      fill(via, waypoints.map((waypoint, i) => h("div", { class: "with-button" }, waypoint.element, button("Remove", () => change(i, null), { class: "quiet", "aria-label": `Remove way point ${i + 1}` }))));
    }
    waypoints.forEach((waypoint, i) => waypoint.show(drawn.waypoints[i]!));
    const missing = [!drawn.start && "a start", !drawn.goal && "a goal"].filter(Boolean).join(" and ");
    go.disabled = missing !== "";
    hint.textContent = missing ? `Click ${missing} on the map, or type ${drawn.start || drawn.goal ? "it" : "them"}.` : "Drag start or goal on the map to plan anew at once. Ctrl+Enter plans, Ctrl+Z takes back what was drawn.";
  });
  const drawWeights = folded(weights, () => "What a route costs", () => {
    const { costTerms, options: chosen } = store.state;
    const routes = h("input", { type: "number", min: 1, max: 8, value: chosen.routes, onchange: () => store.option({ routes: Math.min(8, Math.max(1, Math.round(Number(routes.value)) || 3)) }) });
    return [
      field("Routes wanted", routes),
      ...costTerms.map((term) => {
        const weight = term.weight!;
        const input = h("input", {
          type: "number", step: "any", min: weight.lowest, max: weight.highest, value: chosen.weights[term.name!] ?? weight.initial,
          onchange: () => {
            const { [term.name!]: _, ...others } = store.state.options.weights;
            const value = Number(input.value);
            store.option({ weights: input.value === "" || value === weight.initial ? others : { ...others, [term.name!]: value } });
          },
        });
        return field(`${sentence(words(term.name!))}, ${weight.unit}`, input, `${sentence(term.summary ?? "")}.`);
      }),
    ];
  });
  store.on(["costTerms", "options"], () => {
    if (!(weights.contains(document.activeElement) && document.activeElement instanceof HTMLInputElement)) drawWeights();
  });
  const drawCurl = folded(curl, () => "The request as a command", () => [h("pre", { tabindex: 0, "data-curl": true }, asCurl("v1/plans", planDraft()))]);
  store.on(["drawn", "options", "terrain", "rules"], drawCurl);
  fill(target, examplesView(), common, h("h2", {}, "Places"), toolBar(tools.map((t) => t.tool)), from.element, via, goal.element, zones(), weights, go, hint, curl);
}
