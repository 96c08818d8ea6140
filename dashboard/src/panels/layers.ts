// Which layers the map shows, how strongly, and what their colours mean.
import { fill, h, swatch } from "../dom";
import { words } from "../format";
import { classLabels, classTitles } from "../result";
import { store, usualPalette, type LayerName, type RouteColour, type State } from "../state";

const titles: Record<LayerName, string> = { slope: "Slope", soil: "Assumed soil", unknown: "Unknown ground" };
const usualOpacity: Record<LayerName, number> = { slope: 0.6, soil: 0.55, unknown: 0.6 };
const paletteKey = "slipway-palette";

export function layersPanel(target: HTMLElement): void {
  const kept = localStorage.getItem(paletteKey)?.split(",");
  if (kept?.length === usualPalette.length && kept.every((c) => /^#[0-9a-f]{6}$/.test(c))) store.set({ palette: kept });
  const switches = h("div");
  const swipe = h("div");
  const routes = h("div");
  const legends = h("div");
  fill(target, h("details", { open: true }, h("summary", {}, "Layers"), switches, swipe), h("details", { open: true }, h("summary", {}, "Routes"), routes), h("details", { open: true }, h("summary", {}, "Legend"), legends));
  switches.append(...(Object.keys(titles) as LayerName[]).map(layerSwitch));
  const line = h("input", { type: "range", min: 0, max: 1, step: 0.01, value: 1, "aria-label": "Swipe: layers are shown to the left of it", oninput: () => store.set({ swipe: Number(line.value) >= 1 ? null : Number(line.value) }) });
  fill(swipe, h("div", { class: "layer" }, h("span", {}, "Swipe"), line));
  store.on(["routeColour", "palette"], (state) => fill(routes, routeLegend(state)));
  store.on(["terrain", "layers", "options"], (state) => fill(legends, layerLegends(state)));
}

function layerSwitch(name: LayerName): HTMLElement {
  const box = h("input", { type: "checkbox", id: `layer-${name}`, onchange: () => set(box.checked ? usualOpacity[name] : 0) });
  const range = h("input", { type: "range", min: 0.05, max: 1, step: 0.05, "aria-label": `Opacity of ${titles[name].toLowerCase()}`, oninput: () => set(Number(range.value)) });
  const set = (opacity: number) => store.set({ layers: { ...store.state.layers, [name]: opacity } });
  store.on(["layers"], ({ layers }) => {
    box.checked = layers[name] > 0;
    range.disabled = !box.checked;
    if (layers[name] > 0) range.value = String(layers[name]);
  });
  return h("div", { class: "layer" }, h("label", {}, box, titles[name]), range);
}

function routeLegend(state: State): HTMLElement {
  const choices: [RouteColour, string][] = [["risk", "risk"], ["slip", "slip"], ["plain", "one colour"]];
  const by = state.routeColour;
  const set = (k: number, colour: string) => {
    const palette = state.palette.map((c, i) => (i === k ? colour : c));
    localStorage.setItem(paletteKey, palette.join(","));
    store.set({ palette });
  };
  return h(
    "div",
    {},
    h("div", { class: "row", role: "group", "aria-label": "What the routes' colours show" }, choices.map(([value, text]) => h("button", { type: "button", class: "chip", "aria-pressed": String(by === value), onclick: () => store.set({ routeColour: value }) }, text))),
    by !== "plain" && [
      h("p", { class: "hint" }, classTitles[by]),
      h("ul", { class: "legend" }, classLabels(by).map((label, k) => {
        const pick = h("input", { type: "color", value: state.palette[k], "aria-label": `Colour of ${label}`, onchange: () => set(k, pick.value) });
        return h("li", {}, pick, label);
      }), h("li", {}, h("span", { class: "swatch dashed", "aria-hidden": "true" }), "on unknown ground")),
    ],
  );
}

function layerLegends(state: State): HTMLElement[] {
  const layers = state.terrain?.layers ?? [];
  const shown = layers.filter((l) => l.name !== "hillshade" && state.layers[l.name as LayerName] > 0);
  if (shown.length === 0) return [h("p", { class: "hint" }, "Shaded relief alone: light falls from the north-west.")];
  return shown.map((layer) => {
    const legend = layer.legends?.find((l) => l.legend === state.options.legend) ?? layer.legends?.[0];
    return h(
      "div",
      {},
      h("p", { class: "hint" }, layer.unit ? `${layer.title}, ${layer.unit}` : layer.title),
      h("ul", { class: "legend" }, (legend?.entries ?? []).map((entry) => h("li", {}, swatch(entry.colour ?? null), words(entry.label ?? "")))),
    );
  });
}
