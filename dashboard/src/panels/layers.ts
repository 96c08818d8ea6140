// Which layers the map shows, how strongly, and what their colours mean.
import { button, field, fill, h, select, swatch } from "../dom";
import { words } from "../format";
import type { TerrainMap } from "../map/terrain_map";
import { shareClasses, shareColours } from "../limits";
import { classLabels, classTitles } from "../result";
import { palettes, store, usualBounds, usualPalette, type LayerName, type RouteColour, type State } from "../state";
import { dayPanel } from "./day";
import { gapControls } from "./diagnosis";
import { riskLayers } from "./risk_layers";

const titles: Record<LayerName, string> = { slope: "Slope", soil: "Assumed soil", unknown: "Unknown ground" };
const usualOpacity: Record<LayerName, number> = { slope: 0.6, soil: 0.55, unknown: 0.6 };
const paletteKey = "slipway-palette";
const boundsKey = "slipway-classes";

export function layersPanel(target: HTMLElement, map: TerrainMap): void {
  takeKept();
  const switches = h("div");
  const risks = h("div");
  const swipe = h("div");
  const routes = h("div");
  const classes = h("div");
  const legends = h("div");
  const riskLegends = h("div");
  const gap = h("div");
  const day = h("details", { class: "day", "data-time-of-day": true });
  const isWide = matchMedia("(min-width: 80rem)").matches; // elsewhere the map is what there is room for
  const ofTerrain = h("div", {},
    h("details", { open: isWide }, h("summary", {}, "Layers"), switches, swipe),
    day,
    h("details", { "data-risks": true }, h("summary", {}, "Risk of the ground"), risks),
    h("details", { open: matchMedia("(min-width: 60rem)").matches }, h("summary", {}, "Legend"), riskLegends, legends, routes));
  fill(target, gap, ofTerrain, h("details", {}, h("summary", {}, "Colours and classes"), classes));
  gapControls(gap);
  // A campaign's own ground has no layers.
  store.on(["tab", "followed", "terrains"], ({ tab, followed, terrains }) => {
    ofTerrain.hidden = tab === "drives" && followed.diagnosis !== null && followed.terrain !== "" && !terrains.some((t) => t.name === followed.terrain);
  });
  switches.append(...(Object.keys(titles) as LayerName[]).map(layerSwitch));
  riskLayers(risks, riskLegends, map);
  dayPanel(day);
  const line = h("input", { type: "range", min: 0, max: 1, step: 0.01, value: 1, "aria-label": "Swipe: layers are shown to the left of it", oninput: () => store.set({ swipe: Number(line.value) >= 1 ? null : Number(line.value) }) });
  fill(swipe, h("div", { class: "layer" }, h("span", {}, "Swipe"), line));
  // Where no route is, its colours mean nothing.
  store.on(["routeColour", "palette", "bounds", "result"], (state) => fill(routes, state.result && routeLegend(state)));
  store.on(["palette", "bounds"], (state) => {
    if (!classes.contains(document.activeElement)) fill(classes, classEditor(state));
  });
  store.on(["terrain", "layers", "options"], (state) => fill(legends, layerLegends(state)));
}

/** What this browser was set to. */
function takeKept(): void {
  const palette = localStorage.getItem(paletteKey)?.split(",");
  if (palette?.length === usualPalette.length && palette.every((c) => /^#[0-9a-f]{6}$/.test(c))) store.set({ palette });
  const kept = (localStorage.getItem(boundsKey) ?? "").split(";").map((list) => list.split(",").map(Number));
  if (kept.length === 2 && kept.every(areBounds)) store.set({ bounds: { risk: kept[0]!, slip: kept[1]! } });
}

const areBounds = (list: number[]): boolean => list.length === 4 && list.every((v, i) => Number.isFinite(v) && v > (i === 0 ? 0 : list[i - 1]!));

function setPalette(palette: string[]): void {
  localStorage.setItem(paletteKey, palette.join(","));
  store.set({ palette });
}

function setBounds(bounds: State["bounds"]): void {
  localStorage.setItem(boundsKey, [bounds.risk, bounds.slip].map((list) => list.join(",")).join(";"));
  store.set({ bounds });
}

function layerSwitch(name: LayerName): HTMLElement {
  const box = h("input", { type: "checkbox", id: `layer-${name}`, onchange: () => set(box.checked ? usualOpacity[name] : 0) });
  const range = h("input", { type: "range", min: 0.05, max: 1, step: 0.05, "aria-label": `Opacity of ${titles[name].toLowerCase()}`, oninput: () => set(Number(range.value)) });
  const set = (opacity: number) => store.set({ layers: { ...store.state.layers, [name]: opacity } });
  store.on(["layers"], ({ layers }) => {
    box.checked = layers[name] > 0;
    range.hidden = !box.checked;
    if (layers[name] > 0) range.value = String(layers[name]);
  });
  return h("div", { class: "layer" }, h("label", {}, box, titles[name]), range);
}

function routeLegend(state: State): HTMLElement {
  const choices: [RouteColour, string][] = [["risk", "risk"], ["slip", "slip"], ["limits", "limits"], ["plain", "one colour"]];
  const by = state.routeColour;
  return h(
    "div",
    {},
    h("h3", {}, "Routes"),
    h("div", { class: "row", role: "group", "aria-label": "What the routes' colours show" }, choices.map(([value, text]) => h("button", { type: "button", class: "chip", "aria-pressed": String(by === value), onclick: () => store.set({ routeColour: value }) }, text))),
    by !== "plain" && [
      h("p", { class: "hint" }, classTitles[by]),
      h("ul", { class: "legend" }, (by === "limits" ? shareClasses.map((label, k) => [label, shareColours[k]!] as const) : classLabels(state.bounds[by]).map((label, k) => [label, k] as const)).map(([label, k]) => h("li", {}, swatch(state.palette[k]!), label)), h("li", {}, h("span", { class: "swatch dashed", "aria-hidden": "true" }), "on unknown ground"), h("li", {}, h("span", { class: "swatch triangle", "aria-hidden": "true" }), "a rule trips in some draws")),
    ],
  );
}

/** Colours and the values between classes: of the routes and of the maps of risk alike. */
function classEditor(state: State): HTMLElement {
  const named = Object.entries(palettes).find(([, colours]) => colours.join() === state.palette.join())?.[0] ?? "";
  const scheme = select([...Object.keys(palettes).map((name) => ({ value: name, text: name })), ...(named ? [] : [{ value: "", text: "of one's own" }])], named, (name) => setPalette(palettes[name] ?? state.palette));
  scheme.id = "palette";
  const bounds = (by: "risk" | "slip", title: string) =>
    h("fieldset", {}, h("legend", {}, title), h("div", { class: "bounds" }, state.bounds[by].map((bound, i) => {
      const input = h("input", { type: "number", step: "any", min: 0, value: bound, "aria-label": `${title}: bound ${i + 1}`, "data-bound": `${by}-${i}`, onchange: () => {
        const list = store.state.bounds[by].map((b, k) => (k === i ? Number(input.value) : b));
        input.setCustomValidity(areBounds(list) ? "" : "Each bound must be above the one before it");
        if (input.reportValidity()) setBounds({ ...store.state.bounds, [by]: list });
      } });
      return input;
    })));
  return h("div", {},
    field("Colours", scheme, "All of them can be told apart by colour-blind eyes."),
    h("div", { class: "row", role: "group", "aria-label": "Colours one by one" }, state.palette.map((colour, k) => {
      const pick = h("input", { type: "color", value: colour, "aria-label": `Colour of class ${k + 1}`, onchange: () => setPalette(store.state.palette.map((c, i) => (i === k ? pick.value : c))) });
      return pick;
    })),
    bounds("risk", "Classes of risk"), bounds("slip", "Classes of slip"),
    button("As usual", () => {
      setPalette(usualPalette);
      setBounds(usualBounds);
    }, { class: "quiet" }));
}

function layerLegends(state: State): HTMLElement[] {
  const layers = state.terrain?.layers ?? [];
  const shown = layers.filter((l) => l.name !== "hillshade" && state.layers[l.name as LayerName] > 0);
  if (shown.length === 0) return [h("p", { class: "hint" }, "Shaded relief: light falls from the north-west.")];
  return shown.map((layer) => {
    const legend = layer.legends?.find((l) => l.legend === state.options.legend) ?? layer.legends?.[0];
    return h(
      "div",
      {},
      (legend?.entries ?? []).length !== 1 && h("p", { class: "hint" }, layer.unit ? `${layer.title}, ${layer.unit}` : layer.title),
      h("ul", { class: "legend" }, (legend?.entries ?? []).map((entry) => h("li", {}, swatch(entry.colour ?? null), words(entry.label ?? "")))),
    );
  });
}
