// The map of one terrain: its layers as tiles in its own grid, with what is drawn and the routes above.
import OlMap from "ol/Map.js";
import View from "ol/View.js";
import type BaseLayer from "ol/layer/Layer.js";
import Overlay from "ol/Overlay.js";
import Projection from "ol/proj/Projection.js";
import { defaults as defaultControls } from "ol/control/defaults.js";
import TileLayer from "ol/layer/Tile.js";
import { getRenderPixel } from "ol/render.js";
import TileImage from "ol/source/TileImage.js";
import TileGrid from "ol/tilegrid/TileGrid.js";
import type ImageTile from "ol/ImageTile.js";
import type RenderEvent from "ol/render/Event.js";
import { address, ask, token, type TerrainDocument } from "../api/client";
import { button, fill, h } from "../dom";
import { stationAt } from "../result";
import { store, type LayerName, type State } from "../state";
import { whyAt } from "../why";
import { bodyOf, type Body } from "./body";
import { DrawnLayer, putAt } from "./drawn_layer";
import { GapLayer } from "./gap_layer";
import { clearOf } from "./margins";
import { riskLayer, type RiskLayer } from "./risk_layer";
import type { RiskKind, RiskMap } from "./risk_types";
import { RoutesLayer } from "./routes_layer";
import { groundResolution, roundLength, ScaleBar } from "./scale_bar";
import { ShadowLayer } from "./shadow_layer";

const overlays: LayerName[] = ["slope", "soil", "unknown"];
const reach_px = 14; // of the pointer to a route

export class TerrainMap {
  readonly map: OlMap;
  private readonly routes = new RoutesLayer();
  private readonly drawn: DrawnLayer;
  private readonly gap = new GapLayer();
  private readonly shadow: ShadowLayer;
  private layers = new Map<string, TileLayer<TileImage>>();
  private risk = new Map<RiskKind, { of: RiskMap["raster"]; layer: RiskLayer }>();
  private bare = ""; // a campaign's own ground that is shown, of which there is no map
  private shown: TerrainDocument | null = null;
  private legend = "";
  body: Body | null = null;
  pointer: number[] | null = null;
  private placed = -1; // time stamp of the click that placed something
  private readonly whyBox = h("div", { class: "why", role: "status", "data-why": true });
  private readonly why = new Overlay({ element: this.whyBox, autoPan: { margin: 8 }, offset: [0, -14], positioning: "bottom-center", stopEvent: true });

  constructor(target: HTMLElement, private readonly told: (coordinate: number[] | null) => void, private readonly controls: () => HTMLElement[]) {
    this.map = new OlMap({
      target,
      controls: defaultControls({ attribution: false, rotate: false }).extend([new ScaleBar()]),
      layers: [this.routes.layer, this.routes.labels.layer, this.routes.markerLayer, this.gap.layer, this.gap.ringLayer],
    });
    this.shadow = new ShadowLayer(this.map, () => this.isTerrain);
    this.swipeable(this.shadow.layer);
    this.map.addLayer(this.shadow.layer);
    this.drawn = new DrawnLayer(this.map);
    this.map.addLayer(this.drawn.layer);
    // What a tool places is there at once; what a click looks at may still become a double click, which zooms.
    this.map.on("click", (event) => {
      this.placed = this.place(event.coordinate) ? event.originalEvent.timeStamp : -1;
    });
    this.map.on("singleclick", (event) => {
      if (event.originalEvent.timeStamp !== this.placed) this.look(event.coordinate, event.pixel);
    });
    this.map.on("dblclick", () => this.placed < 0); // two places that follow fast zoom nothing
    this.map.addOverlay(this.why);
    this.map.on("pointermove", (event) => {
      this.pointer = event.coordinate;
      this.told(event.coordinate);
      if (event.dragging) return;
      if (store.state.tab === "drives" && store.state.followed.diagnosis) {
        const window = this.windowAt(event.pixel) ?? null;
        if (window !== store.state.followed.window) store.follow({ window });
      } else this.hover(event.coordinate);
    });
    target.addEventListener("pointerleave", () => {
      this.pointer = null;
      this.told(null);
      store.set({ hover_m: null });
    });
    store.on(["terrain"], (s) => this.show(s.terrain));
    store.on(["options"], (s) => {
      if (this.shown && s.options.legend !== this.legend) this.show(s.terrain, true);
    });
    store.on(["layers"], (s) => this.blend(s));
    store.on(["swipe"], () => this.map.render());
    let classes = [store.state.palette, store.state.bounds];
    store.on(["risk", "palette", "bounds", "terrain"], (s) => {
      this.showRisk(s, classes[0] !== s.palette || classes[1] !== s.bounds);
      classes = [s.palette, s.bounds];
    });
    store.on(["followed", "tab", "palette"], (s) => {
      this.showGround(s);
      this.gap.draw(s);
    });
    store.on(["result", "other", "route", "compared", "routeColour", "palette", "bounds", "job", "stale", "rovers"], (s) => this.routes.draw(s));
    let moved = store.state.options.limits;
    store.on(["options"], (s) => {
      if (s.options.limits !== moved && s.routeColour === "limits") this.routes.draw(s);
      moved = s.options.limits;
    });
    store.on(["result", "route", "tab", "stale"], () => this.closeWhy());
    store.on(["hover_m"], (s) => this.routes.point(s));
    store.on(["drawn", "tab", "result"], (s) => this.drawn.draw(s));
    store.on(["tool"], (s) => {
      this.drawn.use(s.tool);
      target.classList.toggle("aiming", s.tool !== "look");
    });
  }

  get view(): [number, number, number] | null {
    const centre = this.map.getView().getCenter();
    const resolution = this.map.getView().getResolution();
    return centre && resolution && this.shown ? [centre[0]!, centre[1]!, resolution] : null;
  }
  set view(view: [number, number, number]) {
    this.map.getView().setCenter([view[0], view[1]]);
    this.map.getView().setResolution(view[2]);
  }

  private show(document: TerrainDocument | null, anew = false): void {
    if (!document?.terrain || (document === this.shown && !anew)) return;
    const moved = document !== this.shown;
    this.shown = document;
    this.legend = store.state.options.legend;
    for (const layer of this.layers.values()) this.map.removeLayer(layer);
    this.layers.clear();
    const body = (this.body = bodyOf(document.terrain));
    const tiles = document.tiles!;
    const extent = body.projection.getExtent()!;
    for (const layer of document.layers ?? []) {
      const first = layer.min_z ?? 0;
      const grid = new TileGrid({
        origin: [tiles.west_m!, tiles.north_m!],
        resolutions: tiles.metres_per_px!,
        tileSize: tiles.tile_px!,
        minZoom: first,
        extent,
      });
      const ofSoil = layer.name === "soil" || layer.name === "unknown";
      const query = ofSoil && this.legend ? `&legend=${encodeURIComponent(this.legend)}` : "";
      const source = new TileImage({
        projection: body.projection,
        tileGrid: grid,
        transition: 0,
        interpolate: layer.name === "hillshade",
        tileUrlFunction: ([z, x, y]) =>
          address(tiles.address!.replace("{layer}", layer.name!).replace("{z}", String(z)).replace("{x}", String(x)).replace("{y}", String(y)) + query),
        tileLoadFunction: (tile, src) => loadTile(tile as ImageTile, src),
      });
      const tileLayer = new TileLayer({ source, zIndex: 1 + this.layers.size, extent });
      if (layer.name !== "hillshade") this.swipeable(tileLayer);
      this.layers.set(layer.name!, tileLayer);
      this.map.addLayer(tileLayer);
    }
    if (moved) {
      this.shadow.use(body.projection);
      this.map.setView(new View({ projection: body.projection, extent: grown(extent), constrainOnlyCenter: true, showFullExtent: true, maxResolution: (tiles.metres_per_px![0] ?? 1) * 2, minResolution: 0.01 }));
      this.map.getView().fit(extent, { padding: this.margins(20) });
    }
    this.blend(store.state);
    if (this.bare) this.map.getLayers().forEach((layer) => layer !== this.gap.layer && layer !== this.gap.ringLayer && layer.setVisible(false));
  }

  private blend(state: State): void {
    for (const name of overlays) {
      const layer = this.layers.get(name);
      layer?.setVisible(state.layers[name] > 0 && this.isTerrain);
      layer?.setOpacity(state.layers[name]);
    }
  }

  private showRisk(state: State, anew: boolean): void {
    const there = state.risk.filter((m) => m.raster && m.document?.terrain === state.terrain?.terrain?.name);
    for (const [kind, { of, layer }] of this.risk) {
      if (!anew && there.some((m) => m.kind === kind && m.raster === of)) continue;
      this.map.removeLayer(layer);
      this.risk.delete(kind);
    }
    for (const map of there) {
      const shown = this.risk.get(map.kind);
      if (shown) shown.layer.setOpacity(map.opacity);
      else if (this.body) {
        const layer = riskLayer(map, state, this.body.projection);
        this.swipeable(layer);
        this.risk.set(map.kind, { of: map.raster, layer });
        this.map.addLayer(layer);
      }
    }
  }

  /** The campaign's ground where no terrain of the service is shown for it: an empty one, with the scale alone. */
  private showGround(state: State): void {
    const { followed, tab, terrains } = state;
    const windows = followed.diagnosis?.document.where.windows.filter((w) => w.terrain === followed.terrain) ?? [];
    const bare = tab === "drives" && windows.length > 0 && !terrains.some((t) => t.name === followed.terrain) ? followed.terrain : "";
    if (bare === this.bare) return;
    this.bare = bare;
    for (const layer of this.map.getLayers().getArray()) if (layer !== this.gap.layer && layer !== this.gap.ringLayer) layer.setVisible(bare === "");
    if (bare) {
      const [xs, ys] = [windows.map((w) => w.x_m), windows.map((w) => w.y_m)];
      const margin = 2;
      const extent: [number, number, number, number] = [Math.min(...xs) - margin, Math.min(...ys) - margin, Math.max(...xs) + margin, Math.max(...ys) + margin];
      const projection = new Projection({ code: `slipway:drives-on:${bare}`, units: "m", metersPerUnit: 1, axisOrientation: "enu", extent, getPointResolution: (resolution) => resolution });
      this.map.setView(new View({ projection, extent: grown(extent), constrainOnlyCenter: true, showFullExtent: true, minResolution: 0.001 }));
      this.map.getView().fit(extent, { padding: this.margins(20) });
    } else {
      const shown = this.shown;
      this.shown = null;
      this.show(shown);
    }
  }

  /** Once all that is asked for has been drawn. */
  whenDrawn(): Promise<void> {
    return new Promise((resolve) => {
      this.map.once("rendercomplete", () => resolve());
      this.map.render();
    });
  }

  /** The map as a picture, and a length that a bar beside it can show. */
  picture(): { url: string; scale_m: number; scale_share: number } {
    const [width, height] = this.map.getSize() ?? [1, 1];
    const canvas = document.createElement("canvas");
    canvas.width = width!;
    canvas.height = height!;
    const context = canvas.getContext("2d")!;
    context.fillStyle = "#fff";
    context.fillRect(0, 0, width!, height!);
    for (const layer of this.map.getViewport().querySelectorAll<HTMLCanvasElement>(".ol-layer canvas, canvas.ol-layer")) {
      if (layer.width === 0) continue;
      context.globalAlpha = Number(layer.style.opacity || (layer.parentNode as HTMLElement).style.opacity || 1);
      const matrix = /matrix\(([^)]+)\)/.exec(layer.style.transform)?.[1]?.split(",").map(Number);
      if (matrix?.length === 6) context.setTransform(...(matrix as [number, number, number, number, number, number]));
      else context.setTransform(width! / layer.width, 0, 0, height! / layer.height, 0, 0);
      context.drawImage(layer, 0, 0);
    }
    const shown_m = width! * (groundResolution(this.map) ?? 1);
    const scale_m = roundLength(shown_m / 4);
    return { url: canvas.toDataURL("image/jpeg", 0.85), scale_m, scale_share: scale_m / shown_m };
  }

  /** What the map shows: west, south, east, north. */
  extent(): number[] {
    return this.map.getView().calculateExtent(this.map.getSize());
  }

  /** Whether what is shown is the terrain's map, and not a campaign's ground. */
  get isTerrain(): boolean {
    return this.bare === "";
  }

  /** Shows a layer to the left of the swipe alone. */
  private swipeable(layer: BaseLayer): void {
    layer.on("prerender", (event: RenderEvent) => {
      const context = event.context as CanvasRenderingContext2D;
      const { swipe } = store.state;
      context.save();
      if (swipe === null) return;
      const [width, height] = this.map.getSize() ?? [0, 0];
      const corners = [[0, 0], [width! * swipe, 0], [width! * swipe, height!], [0, height!]].map((corner) => getRenderPixel(event, corner));
      context.beginPath();
      corners.forEach(([x, y], i) => (i === 0 ? context.moveTo(x!, y!) : context.lineTo(x!, y!)));
      context.closePath();
      context.clip();
    });
    layer.on("postrender", (event: RenderEvent) => (event.context as CanvasRenderingContext2D).restore());
  }

  private place(coordinate: number[]): boolean {
    if (!this.isTerrain || store.state.tool === "look") return false;
    if (this.isOnMap(coordinate)) return putAt(store.state.tool, coordinate);
    this.told(coordinate);
    return true;
  }

  private look(coordinate: number[], pixel: number[]): void {
    if (store.state.tool !== "look") return;
    this.closeWhy();
    const window = this.windowAt(pixel);
    if (window !== undefined) {
      const drive = store.state.followed.diagnosis!.document.where.windows[window]!.drive;
      store.follow({ drive: store.state.followed.drive === drive ? "" : drive });
      return;
    }
    // Route 0 would not end the search: it counts from 1 here.
    const route = this.map.forEachFeatureAtPixel(pixel, (feature) => ((feature.get("route") as number | undefined) ?? -1) + 1, { hitTolerance: 10, layerFilter: (l) => l === this.routes.layer });
    if (!route) return;
    store.set({ route: route - 1 });
    this.hover(coordinate);
    this.tellWhy();
  }

  /** Says why the route has its colour where the cursor is. */
  tellWhy(): void {
    const { result, route: index, hover_m } = store.state;
    const route = result?.routes[index];
    if (!route || hover_m === null) return;
    const { head, lines } = whyAt(route, hover_m, store.state);
    const close = button("×", () => this.closeWhy(), { class: "quiet tiny", "aria-label": "Close" });
    fill(this.whyBox, h("div", { class: "job-head" }, h("strong", {}, head), close), lines.map((line) => h("p", {}, line)));
    const i = stationAt(route.stations, hover_m);
    this.why.setPosition([route.stations.x_m[i]!, route.stations.y_m[i]!]);
  }

  closeWhy(): void {
    this.why.setPosition(undefined);
  }

  isOnMap([x, y]: number[]): boolean {
    const [west, south, east, north] = this.body?.projection.getExtent() ?? [0, 0, 0, 0];
    return x! >= west! && x! <= east! && y! >= south! && y! <= north!;
  }

  /** The window of a recorded drive that is there. */
  private windowAt(pixel: number[]): number | undefined {
    if (store.state.tab !== "drives" || !store.state.followed.diagnosis) return undefined;
    const window = this.map.forEachFeatureAtPixel(pixel, (feature) => ((feature.get("window") as number | undefined) ?? -1) + 1, { hitTolerance: 4, layerFilter: (l) => l === this.gap.layer });
    return window ? window - 1 : undefined;
  }

  /** The place along the chosen route that the pointer is at. */
  private hover(coordinate: number[]): void {
    const route = store.state.result?.routes[store.state.route];
    if (!route || store.state.tool !== "look") return;
    const { x_m, y_m, distance_m } = route.stations;
    const reach = reach_px * (this.map.getView().getResolution() ?? 1);
    let nearest = -1;
    let least = reach * reach;
    for (let i = 0; i < x_m.length; ++i) {
      const d = (x_m[i]! - coordinate[0]!) ** 2 + (y_m[i]! - coordinate[1]!) ** 2;
      if (d < least) [nearest, least] = [i, d];
    }
    store.set({ hover_m: nearest < 0 ? null : distance_m[nearest]! });
  }

  /** Room around what is brought into sight, beside the controls. */
  private margins(px: number): number[] {
    const target = this.map.getTargetElement();
    return clearOf(target.getBoundingClientRect(), this.controls().map((control) => control.getBoundingClientRect()), px);
  }

  centre(): number[] | null {
    return this.map.getView().getCenter() ?? null;
  }

  /** A corner of the zone that is being drawn. */
  corner(at: number[]): boolean {
    return this.drawn.corner(at);
  }

  stopDrawing(): void {
    this.drawn.stopDrawing();
  }

  /** Brings a stretch of the chosen route into sight. */
  showStretch(from_m: number, to_m: number): void {
    const route = store.state.result?.routes[store.state.route];
    if (!route) return;
    const first = stationAt(route.stations, from_m);
    const last = Math.max(stationAt(route.stations, to_m), first);
    const xs = route.stations.x_m.slice(first, last + 1);
    const ys = route.stations.y_m.slice(first, last + 1);
    this.map.getView().fit([Math.min(...xs) - 8, Math.min(...ys) - 8, Math.max(...xs) + 8, Math.max(...ys) + 8], { padding: this.margins(28), duration: 200 });
  }

  /** Where the map has become smaller, or controls larger, the places of the plan come back into sight. */
  keepInSight(): void {
    const { start, goal, waypoints } = store.state.drawn;
    const [top, right, bottom, left] = this.margins(14);
    const [width, height] = this.map.getSize() ?? [0, 0];
    const hidden = [start, goal, ...waypoints].some((place) => {
      const pixel = place && this.map.getPixelFromCoordinate([place.x_m, place.y_m]);
      return pixel && (pixel[0]! < left! || pixel[0]! > width! - right! || pixel[1]! < top! || pixel[1]! > height! - bottom!);
    });
    if (hidden && !this.drawn.dragged) this.showRoutes();
  }

  showRoutes(): void {
    const extent = this.routes.source.getExtent();
    if (extent && extent.every(Number.isFinite)) this.map.getView().fit(extent, { padding: this.margins(28) });
  }
}

const grown = ([w, s, e, n]: number[]): [number, number, number, number] => {
  const margin = Math.max(e! - w!, n! - s!) / 2;
  return [w! - margin, s! - margin, e! + margin, n! + margin];
};

/** A token can't go with the address of a picture, so it is fetched. */
function loadTile(tile: ImageTile, src: string): void {
  const image = tile.getImage() as HTMLImageElement;
  if (!token()) {
    image.src = src;
    return;
  }
  ask(src.slice(address("").length))
    .then((response) => response.blob())
    .then((blob) => {
      const url = URL.createObjectURL(blob);
      image.addEventListener("load", () => URL.revokeObjectURL(url), { once: true });
      image.src = url;
    })
    .catch(() => tile.setState(3));
}
