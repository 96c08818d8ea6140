// The routes of a result as lines, coloured by class; what lies on unknown ground is never coloured like a value.
import Feature from "ol/Feature.js";
import LineString from "ol/geom/LineString.js";
import Point from "ol/geom/Point.js";
import VectorLayer from "ol/layer/Vector.js";
import VectorSource from "ol/source/Vector.js";
import { Circle, Fill, RegularShape, Stroke, Style, Text } from "ol/style.js";
import { limitClasses, shareColours } from "../limits";
import { classesOf, roverOf, stationAt, surprises, verdictColours, type DrivenStretch, type Route } from "../result";
import type { State } from "../state";
import { poseAt, roverStyles } from "./rover_mark";
import { TripLabels } from "./trip_labels";

export class RoutesLayer {
  readonly source = new VectorSource();
  readonly layer = new VectorLayer({ source: this.source, zIndex: 20, updateWhileInteracting: true });
  readonly labels = new TripLabels();
  private readonly marker = new Feature<Point>();
  private readonly markers = new VectorSource({ features: [this.marker] });
  readonly markerLayer = new VectorLayer({
    source: this.markers,
    zIndex: 40,
    updateWhileInteracting: true,
  });

  draw(state: State): void {
    this.source.clear();
    const routes = state.result?.routes ?? [];
    const marks = [state.drawn.start, state.drawn.goal, ...state.drawn.waypoints].flatMap((p) => (p ? [[p.x_m, p.y_m]] : []));
    routes.forEach((route, index) => {
      const chosen = index === state.route;
      const features = lines(route, state, chosen || index === state.compared);
      for (const feature of features) feature.set("route", index);
      this.source.addFeatures(features);
      if (routes.length > 1) {
        const number = label(route, index, routes.length, chosen);
        marks.push(number.getGeometry()!.getCoordinates());
        this.source.addFeature(number);
      }
    });
    state.other?.routes.slice(0, 1).forEach((route) => this.source.addFeatures(plain(route, "#8a2c6b", 4, [9, 6])));
    const chosen = routes[state.route];
    this.labels.draw(state.stale === "all" ? undefined : chosen, marks);
    const best = state.job?.state === "running" ? state.job.best_so_far : undefined;
    if (best?.line) this.source.addFeature(styled(best.line, [stroke("#fff", 8, undefined, 8), stroke(best.verdict ? verdictColours[best.verdict] : "#111", 5, [2, 7], 9)]));
    for (const stretch of state.result?.driven ?? []) this.source.addFeature(residual(stretch));
    this.point(state);
  }

  /** Marks the place along the chosen route that the charts' cursor is at. */
  point(state: State): void {
    const route = state.result?.routes[state.route];
    if (!route || state.hover_m === null || state.stale === "all") {
      this.marker.setGeometry(undefined);
      return;
    }
    const pose = poseAt(route.stations, stationAt(route.stations, state.hover_m));
    const rover = roverOf(state.result!, state.rovers);
    this.marker.setStyle((_, resolution) => roverStyles(rover, pose, resolution));
    this.marker.setGeometry(new Point([pose.x_m, pose.y_m]));
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
  // The answer to another question has no colours.
  if (state.stale === "all") return plain(route, strong ? "#8a8a8a" : "#b5b5b5", width);
  const by = state.routeColour;
  if (by === "plain") return plain(route, strong ? "#0050a0" : "#555", width);
  const classes = by === "limits" ? limitClasses(route, { ...state.result?.limits, ...state.options.limits }).map((k) => (k === null ? null : shareColours[k]!)) : classesOf(route, by, state.bounds[by]);
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

/** Where a stretch of the drive so far ended: a circle where the prediction held, a square where it did not. */
function residual(stretch: DrivenStretch): Feature {
  const feature = new Feature(new Point([stretch.x_m, stretch.y_m]));
  const fill = new Fill({ color: surprises(stretch) ? "#d7191c" : "#2c7bb6" });
  const border = new Stroke({ color: "#fff", width: 2 });
  feature.setStyle(new Style({ image: surprises(stretch) ? new RegularShape({ points: 4, radius: 8, angle: Math.PI / 4, fill, stroke: border }) : new Circle({ radius: 6, fill, stroke: border }), zIndex: 19 }));
  return feature;
}

/** The number stands where the routes are apart. */
function label(route: Route, index: number, of: number, chosen: boolean): Feature<Point> {
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
