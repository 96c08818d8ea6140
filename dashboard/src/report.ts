// A page of paper: what the meeting needs of a route, legible in black and white.
import { fill, h } from "./dom";
import { number, roverWords, sentence, share, wheelWords, words } from "./format";
import { lengthText } from "./map/scale_bar";
import type { TerrainMap } from "./map/terrain_map";
import { reasonText } from "./panels/advice";
import { figures, nearest, provenance, unit } from "./panels/verdict";
import { verdictWords, type Result, type Route } from "./result";
import { palettes, store } from "./state";
import { causeWords } from "./why";

const paper = h("section", { class: "paper", "aria-hidden": "true" });
const kindWords: Record<string, string> = { plan: "Plan of a drive", check: "Check of a drive", prediction: "Prediction of a drive" };
const charts_shown = 4;
const reasons_shown = 9;

export function reportPage(map: TerrainMap, redraw: () => void): () => Promise<void> {
  document.body.append(paper);
  // Without the button the page is made of what is on the screen.
  window.addEventListener("beforeprint", () => {
    if (paper.childElementCount === 0) fill(paper, ...page(map));
  });
  window.addEventListener("afterprint", () => fill(paper));
  async function print(): Promise<void> {
    const { palette } = store.state;
    const { theme } = document.documentElement.dataset;
    document.documentElement.dataset.theme = "light";
    store.set({ palette: palettes["grey, for paper"]! });
    redraw();
    await map.whenDrawn();
    fill(paper, ...page(map));
    store.set({ palette });
    if (theme) document.documentElement.dataset.theme = theme;
    else delete document.documentElement.dataset.theme;
    redraw();
    await Promise.all([...paper.querySelectorAll("img")].map((image) => image.decode().catch(() => undefined)));
    window.print();
  }
  window.addEventListener("keydown", (event) => {
    if (!(event.ctrlKey || event.metaKey) || event.key !== "p" || !store.state.result) return;
    event.preventDefault();
    void print();
  });
  return print;
}

function page(map: TerrainMap): HTMLElement[] {
  const { result, route: index, terrain } = store.state;
  const route = result?.routes[index];
  if (!result || !route) return [h("p", {}, "There is no route to print: plan a drive or check one.")];
  const title = terrain?.terrain?.title ?? result.terrain;
  return [
    h("header", {}, h("div", {}, h("h1", {}, `${kindWords[result.kind] ?? words(result.kind)}: ${title}`), h("p", {}, asked(result))), h("div", { class: `paper-verdict ${route.verdict}` }, verdictWords[route.verdict], h("small", {}, route.title))),
    mapPicture(map),
    h("div", { class: "paper-columns" },
      h("div", {}, h("h2", {}, "Why"), h("ul", {}, route.decision.reasons.slice(0, reasons_shown).map((reason) => h("li", {}, reasonText(reason))))),
      h("div", {}, h("h2", {}, "Figures"), figureTable(result))),
    h("h2", {}, "Rules: limit, nearest value (5 to 95 % of the draws), share of the draws in which it trips, where, why"),
    ruleTable(route),
    h("div", { class: "paper-charts" }, chartPictures()),
    h("footer", {}, [...provenance(result).slice(0, 4), ["Fingerprint of the map", result.provenance.terrain_fingerprint ?? "–"]].map(([k, v]) => `${k} ${v}`).join(" · ")),
  ];
}

function asked(result: Result): string {
  const { options } = store.state;
  const request = result.request as { keep_out?: unknown[]; keep_in?: unknown[]; model?: unknown };
  const parts = [
    `Rover ${roverWords(result.rover)}`,
    `rules ${options.rules ? words(options.rules) : "of the service"}`,
    `soils as ${words(result.provenance.legend ?? "–")}`,
    (request.keep_out ?? []).length > 0 ? `${request.keep_out!.length} zones to keep out of` : "",
    (request.keep_in ?? []).length > 0 ? `${request.keep_in!.length} zones to stay in` : "",
    request.model ? "with a model that drives have corrected" : "",
    `asked ${result.created.slice(0, 16).replace("T", " ")} UTC`,
  ];
  return parts.filter(Boolean).join(", ");
}

/** The map as it is on the screen, with a scale of its own. */
function mapPicture(map: TerrainMap): HTMLElement {
  const picture = map.picture();
  const line = h("div", { class: "paper-scale" });
  line.style.width = `${picture.scale_share * 100}%`;
  return h("figure", {}, h("div", { class: "paper-map" }, h("img", { src: picture.url, alt: "Map of the routes" }), line), h("figcaption", {}, `The bar is ${lengthText(picture.scale_m)}; north is up. Routes: darker is more risk, dashes are unknown ground, at triangles a rule trips.`));
}

function figureTable(result: Result): HTMLElement {
  const routes = result.routes.slice(0, 3);
  return h("table", {}, h("thead", {}, h("tr", {}, h("td", {}), routes.map((r) => h("th", {}, `${r.title} ${verdictWords[r.verdict]}`)))), h("tbody", {}, figures.map(([name, value, write]) => h("tr", {}, h("th", {}, name), routes.map((r) => h("td", {}, write(value(r))))))));
}

function ruleTable(route: Route): HTMLElement {
  return h("table", {}, h("tbody", {}, route.outcomes.rules.map((r) => h("tr", { class: r.from_m !== null ? "trips" : "" },
    h("th", {}, sentence(r.words)), h("td", {}, `${number(r.limit)}${unit(r.unit)}`), h("td", {}, nearest(r)), h("td", {}, share(r.trips.value)), h("td", {}, r.from_m === null ? "" : `${r.from_m.toFixed(0)} to ${r.to_m?.toFixed(0)} m`), h("td", {}, [r.cause && causeWords(r.cause), r.wheel && wheelWords(r.wheel)].filter(Boolean).join(", "))))));
}

function chartPictures(): HTMLElement[] {
  return [...document.querySelectorAll<HTMLElement>(".chart-box")].slice(0, charts_shown).map((box) => h("figure", {}, h("figcaption", {}, box.querySelector("h3")?.textContent ?? ""), h("img", { src: box.querySelector("canvas")!.toDataURL(), alt: "" })));
}
