// Where a rule trips in some of the draws of the ground: a triangle with rule, probability and cause, beside what else is drawn there.
import Feature from "ol/Feature.js";
import Point from "ol/geom/Point.js";
import VectorLayer from "ol/layer/Vector.js";
import VectorSource from "ol/source/Vector.js";
import { Fill, RegularShape, Stroke, Style, Text } from "ol/style.js";
import { share } from "../format";
import { causeWords } from "../why";
import { stationAt, tripsOf, type Route } from "../result";

const character_px = 6.6;
const line_px = 16;
const reach_px = 14; // from the triangle to its label
const mark_px = 13; // radius of the marks of start, goal and routes
const below_px = 22;

interface Side {
  align: CanvasTextAlign;
  baseline: CanvasTextBaseline;
  dx: number; // of the label's anchor
  dy: number;
}
const sides: Side[] = [
  { align: "left", baseline: "middle", dx: reach_px, dy: 0 },
  { align: "right", baseline: "middle", dx: -reach_px, dy: 0 },
  { align: "center", baseline: "top", dx: 0, dy: reach_px },
  { align: "center", baseline: "bottom", dx: 0, dy: -reach_px },
];

export class TripLabels {
  private readonly source = new VectorSource();
  readonly layer = new VectorLayer({ source: this.source, zIndex: 35 });

  /** Labels keep off the marks, which are other things' places, and off the route as far as they can. */
  draw(route: Route | undefined, marks: number[][]): void {
    this.source.clear();
    if (!route) return;
    const { x_m, y_m } = route.stations;
    const line = x_m.map((x, i) => [x, y_m[i]!]);
    const middle = (Math.min(...x_m) + Math.max(...x_m)) / 2;
    for (const [index, [k, texts]] of [...labelled(route)].entries()) {
      const at = line[k]!;
      const feature = new Feature(new Point(at));
      feature.setStyle((_, resolution) => {
        // Below a mark that is at the same place.
        const down = marks.some((m) => Math.hypot(m[0]! - at[0]!, m[1]! - at[1]!) < mark_px * resolution) ? below_px : 0;
        // Neighbours go above and below by turns.
        const [below, above] = index % 2 === 0 ? sides.slice(2) : sides.slice(2).reverse();
        const inwards = at[0]! > middle ? [sides[1]!, sides[0]!, below!, above!] : [sides[0]!, sides[1]!, below!, above!];
        return style(texts, down, freest([at[0]!, at[1]! - down * resolution], texts, resolution, marks, line, inwards));
      });
      this.source.addFeature(feature);
    }
  }
}

/** Labels that would lie on each other share a place. */
function labelled(route: Route): Map<number, string[]> {
  const at = new Map<number, string[]>();
  const { distance_m } = route.stations;
  const near_m = 0.06 * (distance_m.at(-1) ?? 0);
  for (const rule of tripsOf(route)) {
    const own = stationAt(route.stations, rule.from_m!);
    const k = [...at.keys()].find((other) => Math.abs(distance_m[other]! - distance_m[own]!) < near_m) ?? own;
    at.set(k, [...(at.get(k) ?? []), `${rule.words} ${share(rule.trips.value)}${rule.cause ? `, ${causeWords(rule.cause)}` : ""}`]);
  }
  return at;
}

/** The side on which the label covers least. */
function freest([x, y]: number[], texts: string[], resolution: number, marks: number[][], line: number[][], tried: Side[]): Side {
  const width = character_px * Math.max(...texts.map((t) => t.length));
  const height = line_px * texts.length;
  const covered = ({ align, baseline, dx, dy }: Side): number => {
    const left = dx - (align === "left" ? 0 : align === "right" ? width : width / 2);
    const top = dy - (baseline === "top" ? 0 : baseline === "bottom" ? height : height / 2);
    const within = ([px, py]: number[], margin: number) => {
      const [right, down] = [(px! - x!) / resolution, (y! - py!) / resolution];
      return right > left - margin && right < left + width + margin && down > top - margin && down < top + height + margin;
    };
    return marks.filter((m) => within(m, mark_px)).length + line.filter((p) => within(p, 0)).length / line.length;
  };
  return tried.map((side) => ({ side, cost: covered(side) })).reduce((best, one) => (one.cost < best.cost - 1e-9 ? one : best)).side;
}

const triangle = (down: number) => new RegularShape({ points: 3, radius: 9, displacement: [0, -down], fill: new Fill({ color: "#ffd400" }), stroke: new Stroke({ color: "#111", width: 2 }) });

function style(texts: string[], down: number, { align, baseline, dx, dy }: Side): Style {
  return new Style({
    image: triangle(down),
    text: new Text({ text: texts.join("\n"), font: "12px system-ui, sans-serif", textAlign: align, textBaseline: baseline, offsetX: dx, offsetY: dy + down, fill: new Fill({ color: "#111" }), backgroundFill: new Fill({ color: "#ffffffd9" }), padding: [1, 3, 0, 3] }),
  });
}
