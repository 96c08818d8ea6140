// Start, goal, way points, zones and the path of a check: drawn, dragged, taken away.
import Feature from "ol/Feature.js";
import type OlMap from "ol/Map.js";
import LineString from "ol/geom/LineString.js";
import Point from "ol/geom/Point.js";
import Polygon from "ol/geom/Polygon.js";
import Draw from "ol/interaction/Draw.js";
import Modify from "ol/interaction/Modify.js";
import VectorLayer from "ol/layer/Vector.js";
import VectorSource from "ol/source/Vector.js";
import { Circle, Fill, RegularShape, Stroke, Style, Text } from "ol/style.js";
import { planSoon } from "../live";
import { firstTool, store, type Place, type Ring, type State, type Tool } from "../state";

const mark = (text: string, colour: string): Style =>
  new Style({
    image: new Circle({ radius: 11, fill: new Fill({ color: colour }), stroke: new Stroke({ color: "#fff", width: 2 }) }),
    text: new Text({ text, font: "bold 12px system-ui, sans-serif", fill: new Fill({ color: "#fff" }) }),
    zIndex: 30,
  });
const styles = {
  // Around what the pointer could drag: its letter stays legible.
  held: new Style({ image: new Circle({ radius: 14, stroke: new Stroke({ color: "#0090ff", width: 3 }) }) }),
  keep_out: new Style({ fill: new Fill({ color: "#d7191c55" }), stroke: new Stroke({ color: "#67001f", width: 2 }) }),
  keep_in: new Style({ fill: new Fill({ color: "#0050a010" }), stroke: new Stroke({ color: "#0050a0", width: 3, lineDash: [10, 6] }) }),
  corner: new Style({ image: new RegularShape({ points: 4, radius: 7, angle: Math.PI / 4, fill: new Fill({ color: "#fff" }), stroke: new Stroke({ color: "#111", width: 2 }) }) }),
};

const xy = (place: Place): number[] => [place.x_m, place.y_m];
const place = ([x, y]: number[]): Place => ({ x_m: Math.round(x! * 100) / 100, y_m: Math.round(y! * 100) / 100 });
const ring = (polygon: Polygon): Ring =>
  polygon.getCoordinates()[0]!.slice(0, -1).map(([x, y]): [number, number] => [Math.round(x! * 100) / 100, Math.round(y! * 100) / 100]);

export class DrawnLayer {
  private readonly source = new VectorSource();
  readonly layer = new VectorLayer({ source: this.source, zIndex: 30 });
  private drawing: Draw | null = null;
  private corners: number[][] = []; // that the keyboard has placed
  dragged = false;
  private frame = 0;
  private placed = ""; // start, goal and way points when the drag began

  constructor(private readonly map: OlMap) {
    const finger = matchMedia("(pointer: coarse)").matches;
    const modify = new Modify({ source: this.source, style: styles.held, pixelTolerance: finger ? 24 : 12, insertVertexCondition: (event) => event.originalEvent.shiftKey });
    modify.on("modifystart", (event) => {
      store.remember();
      this.dragged = true;
      event.features.forEach((feature) => feature.getGeometry()?.on("change", this.moved));
    });
    modify.on("modifyend", (event) => {
      event.features.forEach((feature) => feature.getGeometry()?.un("change", this.moved));
      cancelAnimationFrame(this.frame);
      this.takeOver();
      this.planAfterDrag(true);
      this.dragged = false;
      this.draw(store.state);
    });
    map.addInteraction(modify);
  }

  /** At most once a frame: the pointer moves faster. */
  private readonly moved = (): void => {
    cancelAnimationFrame(this.frame);
    this.frame = requestAnimationFrame(() => {
      this.takeOver();
      this.planAfterDrag(false);
    });
  };

  /** A plan follows its places; zones and paths wait to be asked about. */
  private planAfterDrag(end: boolean): void {
    const { drawn, tab } = store.state;
    if (tab === "plan" && JSON.stringify([drawn.start, drawn.goal, drawn.waypoints]) !== this.placed) planSoon(end);
  }

  draw(state: State): void {
    // What is being dragged is drawn by the drag.
    if (this.dragged) return;
    this.placed = JSON.stringify([state.drawn.start, state.drawn.goal, state.drawn.waypoints]);
    this.source.clear();
    const add = (kind: string, index: number, geometry: Point | Polygon | LineString, style: Style | Style[]) => {
      const feature = new Feature({ geometry, kind, index });
      feature.setStyle(style);
      this.source.addFeature(feature);
    };
    const { drawn } = state;
    drawn.keep_out.forEach((r, i) => add("keep_out", i, new Polygon([[...r, r[0]!]]), styles.keep_out));
    drawn.keep_in.forEach((r, i) => add("keep_in", i, new Polygon([[...r, r[0]!]]), styles.keep_in));
    if (state.tab === "check") {
      // The answer lies where the path does.
      if (drawn.path.length > 1 && state.result?.kind !== "check") add("path", 0, new LineString(drawn.path.map(xy)), new Style({ stroke: new Stroke({ color: "#111", width: 2, lineDash: [4, 4] }) }));
      drawn.path.forEach((p, i) => add("corner", i, new Point(xy(p)), styles.corner));
    } else {
      if (drawn.start) add("start", 0, new Point(xy(drawn.start)), mark("S", "#1a7f37"));
      drawn.waypoints.forEach((p, i) => add("waypoint", i, new Point(xy(p)), mark(String(i + 1), "#5b3fa0")));
      if (drawn.goal) add("goal", 0, new Point(xy(drawn.goal)), mark("G", "#b3261e"));
    }
  }

  /** What was dragged becomes the state. */
  private takeOver(): void {
    const of = (kind: string) =>
      this.source
        .getFeatures()
        .filter((f) => f.get("kind") === kind)
        .sort((a, b) => a.get("index") - b.get("index"));
    const points = (kind: string): Place[] => of(kind).map((f) => place((f.getGeometry() as Point).getCoordinates()));
    const rings = (kind: string): Ring[] => of(kind).map((f) => ring(f.getGeometry() as Polygon));
    const onCheck = store.state.tab === "check";
    // A line that is dragged moves its corners; a corner that is dragged moves its line.
    const line = of("path")[0]?.getGeometry() as LineString | undefined;
    store.move({
      keep_out: rings("keep_out"),
      keep_in: rings("keep_in"),
      ...(onCheck
        ? { path: line ? line.getCoordinates().map(place) : points("corner") }
        : { start: points("start")[0] ?? null, goal: points("goal")[0] ?? null, waypoints: points("waypoint") }),
    });
  }

  /** What a click on the map does from now on. */
  use(tool: Tool): void {
    if (this.drawing) this.map.removeInteraction(this.drawing);
    this.drawing = null;
    this.corners = [];
    if (tool !== "keep_out" && tool !== "keep_in") return;
    this.drawing = new Draw({ type: "Polygon", source: new VectorSource(), style: styles[tool] });
    this.drawing.on("drawend", (event) => {
      const drawn = ring(event.feature.getGeometry() as Polygon);
      store.draw({ [tool]: [...store.state.drawn[tool], drawn] });
      store.set({ tool: "look" });
    });
    this.map.addInteraction(this.drawing);
  }

  stopDrawing(): void {
    this.drawing?.abortDrawing();
  }

  /** A corner of the zone that is being drawn; one where the first is ends it. */
  corner(at: number[]): boolean {
    if (!this.drawing) return false;
    const first = this.corners[0];
    const closes = first !== undefined && this.corners.length >= 3 && Math.hypot(first[0]! - at[0]!, first[1]! - at[1]!) < 1e-6;
    if (closes) {
      const tool = store.state.tool as "keep_out" | "keep_in";
      store.draw({ [tool]: [...store.state.drawn[tool], this.corners.map((c): [number, number] => [place(c).x_m, place(c).y_m])] });
      store.set({ tool: "look" });
    } else {
      this.corners.push([at[0]!, at[1]!]);
      this.drawing.appendCoordinates([at as [number, number]]);
    }
    return true;
  }
}

/** Puts what the tool stands for at a place. */
export function putAt(tool: Tool, at: number[]): boolean {
  const here = place(at);
  const { drawn } = store.state;
  if (tool === "start") store.draw({ start: here });
  else if (tool === "goal") store.draw({ goal: here });
  else if (tool === "waypoint") store.draw({ waypoints: [...drawn.waypoints, here] });
  else if (tool === "corner") store.draw({ path: [...drawn.path, here] });
  else return false;
  // One start and one goal: the next click is for the other where that is missing.
  if (tool === "start" || tool === "goal") store.set({ tool: firstTool(store.state) });
  if (tool !== "corner") planSoon(true);
  return true;
}
