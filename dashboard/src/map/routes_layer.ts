// The routes of a result as lines, coloured by class; what lies on unknown ground is never coloured like a value.
import Feature from "ol/Feature.js";
import LineString from "ol/geom/LineString.js";
import Point from "ol/geom/Point.js";
import VectorLayer from "ol/layer/Vector.js";
import VectorSource from "ol/source/Vector.js";
import { Circle, Fill, RegularShape, Stroke, Style, Text } from "ol/style.js";
import { classesOf, ruleWords, stationAt, surprises, tripsOf, type DrivenStretch, type Route } from "../result";
import { share, words } from "../format";
import type { State } from "../state";

export class RoutesLayer {
  readonly source = new VectorSource();
  readonly layer = new VectorLayer({ source: this.source, zIndex: 20, updateWhileInteracting: true });
  private readonly marker = new Feature<Point>();
  private readonly markers = new VectorSource({ features: [this.marker] });
  readonly markerLayer = new VectorLayer({
    source: this.markers,
    zIndex: 40,
    style: new Style({ image: new Circle({ radius: 8, fill: new Fill({ color: "#ffffffcc" }), stroke: new Stroke({ color: "#000", width: 3 }) }) }),
  });

  draw(state: State): void {
    this.source.clear();
    const routes = state.result?.routes ?? [];
    routes.forEach((route, index) => {
      const chosen = index === state.route;
      const features = lines(route, state, chosen || index === state.compared);
      for (const feature of features) feature.set("route", index);
      this.source.addFeatures(features);
      if (routes.length > 1) this.source.addFeature(label(route, index, routes.length, chosen));
    });
    state.other?.routes.slice(0, 1).forEach((route) => this.source.addFeatures(plain(route, "#8a2c6b", 4, [9, 6])));
    const chosen = routes[state.route];
    if (chosen) this.source.addFeatures(trips(chosen));
    if (state.job?.state === "running" && state.job.best_so_far?.line) this.source.addFeature(styled(state.job.best_so_far.line as number[][], [stroke("#fff", 6), stroke("#111", 3, [2, 7], 1)]));
    for (const stretch of state.result?.driven ?? []) this.source.addFeature(residual(stretch));
    this.point(state);
  }

  /** Marks the place along the chosen route that the charts' cursor is at. */
  point(state: State): void {
    const route = state.result?.routes[state.route];
    if (!route || state.hover_m === null) {
      this.marker.setGeometry(undefined);
      return;
    }
    const i = stationAt(route.stations, state.hover_m);
    this.marker.setGeometry(new Point([route.stations.x_m[i]!, route.stations.y_m[i]!]));
  }
}

function coordinates(route: Route, from = 0, to = route.stations.count - 1): number[][] {
  const line: number[][] = [];
  for (let i = from; i <= to; ++i) line.push([route.stations.x_m[i]!, route.stations.y_m[i]!]);
  return line;
}

function styled(line: number[][], styles: Style | Style[]): Feature {
  const feature = new Feature(new LineString(line));
  feature.setStyle(styles);
  return feature;
}

const stroke = (color: string, width: number, lineDash?: number[], zIndex = 0): Style =>
  new Style({ stroke: new Stroke({ color, width, lineCap: lineDash ? "butt" : "round", ...(lineDash ? { lineDash } : {}) }), zIndex });

function plain(route: Route, colour: string, width: number, dash?: number[]): Feature[] {
  return [styled(coordinates(route), [stroke("#fff", width + 3), stroke(colour, width, dash, 1)])];
}

function lines(route: Route, state: State, strong: boolean): Feature[] {
  const width = strong ? 6 : 3;
  const above = strong ? 4 : 0;
  if (state.routeColour === "plain") return plain(route, strong ? "#0050a0" : "#555", width);
  const classes = classesOf(route, state.routeColour, state.bounds[state.routeColour]);
  const features = [styled(coordinates(route), stroke("#000000", width + 4, undefined, above)), styled(coordinates(route), stroke("#fff", width + 2.5, undefined, above + 1))];
  for (let from = 0; from + 1 < classes.length; ) {
    let to = from + 1;
    while (to + 1 < classes.length && classes[to + 1] === classes[from + 1]) ++to;
    const k = classes[from + 1];
    const line = coordinates(route, from, to);
    features.push(styled(line, k === null || k === undefined ? [stroke("#fff", width, undefined, above + 2), stroke("#111", width, [7, 7], above + 3)] : stroke(state.palette[k]!, width, undefined, above + 2)));
    from = to;
  }
  return features;
}

/** Where a rule trips in some of the draws: with its probability and cause. Labels that would lie on each other share a place. */
function trips(route: Route): Feature[] {
  const at = new Map<number, string[]>();
  const { distance_m } = route.stations;
  const near_m = 0.06 * (distance_m.at(-1) ?? 0);
  for (const rule of tripsOf(route)) {
    const own = stationAt(route.stations, rule.from_m!);
    const k = [...at.keys()].find((other) => Math.abs(distance_m[other]! - distance_m[own]!) < near_m) ?? own;
    at.set(k, [...(at.get(k) ?? []), `${ruleWords[rule.rule] ?? words(rule.rule)} ${share(rule.trips.value)}${rule.cause ? `, ${words(rule.cause)}` : ""}`]);
  }
  const xs = route.stations.x_m;
  const middle = (Math.min(...xs) + Math.max(...xs)) / 2;
  return [...at].map(([k, texts]) => {
    const east = xs[k]! > middle; // there the label lies to the left, inwards
    const feature = new Feature(new Point([route.stations.x_m[k]!, route.stations.y_m[k]!]));
    feature.setStyle(
      new Style({
        image: new RegularShape({ points: 3, radius: 9, fill: new Fill({ color: "#ffd400" }), stroke: new Stroke({ color: "#111", width: 2 }) }),
        text: new Text({ text: texts.join("\n"), font: "12px system-ui, sans-serif", textAlign: east ? "right" : "left", offsetX: east ? -14 : 14, fill: new Fill({ color: "#111" }), stroke: new Stroke({ color: "#fff", width: 4 }) }),
        zIndex: 18,
      }),
    );
    return feature;
  });
}

/** Where a stretch of the drive so far ended: a circle where the prediction held, a square where it did not. */
function residual(stretch: DrivenStretch): Feature {
  const feature = new Feature(new Point([stretch.x_m, stretch.y_m]));
  const fill = new Fill({ color: surprises(stretch) ? "#d7191c" : "#2c7bb6" });
  const border = new Stroke({ color: "#fff", width: 2 });
  feature.setStyle(new Style({ image: surprises(stretch) ? new RegularShape({ points: 4, radius: 8, angle: Math.PI / 4, fill, stroke: border }) : new Circle({ radius: 6, fill, stroke: border }), zIndex: 19 }));
  return feature;
}

/** The number stands where the routes are apart. */
function label(route: Route, index: number, of: number, chosen: boolean): Feature {
  const i = Math.floor((route.stations.count * (index + 1)) / (of + 1));
  const feature = new Feature(new Point([route.stations.x_m[i]!, route.stations.y_m[i]!]));
  feature.setStyle(
    new Style({
      image: new Circle({ radius: 12, fill: new Fill({ color: chosen ? "#111" : "#fff" }), stroke: new Stroke({ color: chosen ? "#fff" : "#111", width: 2 }) }),
      text: new Text({ text: String(index + 1), font: "bold 13px system-ui, sans-serif", fill: new Fill({ color: chosen ? "#fff" : "#111" }) }),
      zIndex: 20,
    }),
  );
  return feature;
}
