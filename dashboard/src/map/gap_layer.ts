// The map of the gap: each window of recorded drives where it was driven, by how far prediction and drive part there.
import Feature from "ol/Feature.js";
import Point from "ol/geom/Point.js";
import Polygon from "ol/geom/Polygon.js";
import VectorLayer from "ol/layer/Vector.js";
import VectorSource from "ol/source/Vector.js";
import { Circle, Fill, RegularShape, Stroke, Style, Text } from "ol/style.js";
import type { State } from "../state";

/** In deviations of the noise: 1 is as well as can be predicted. */
export const gapBounds = [1, 1.5, 2, 4];
export const gapClass = (deviations: number): number => gapBounds.filter((bound) => deviations >= bound).length;
export const gapLabels = [`below ${gapBounds[0]}`, ...gapBounds.slice(1).map((b, i) => `${gapBounds[i]} to ${b}`), `above ${gapBounds.at(-1)}`];

export class GapLayer {
  readonly source = new VectorSource();
  readonly layer = new VectorLayer({ source: this.source, zIndex: 25 });
  private readonly ring = new Feature<Point>();
  readonly ringLayer = new VectorLayer({
    source: new VectorSource({ features: [this.ring] }),
    zIndex: 41,
    style: new Style({ image: new Circle({ radius: 12, stroke: new Stroke({ color: "#000", width: 3 }), fill: new Fill({ color: "#ffffff55" }) }) }),
  });

  draw({ followed, tab, palette }: State): void {
    this.source.clear();
    const where = tab === "drives" ? followed.diagnosis?.document.where : undefined;
    this.point({ followed, tab } as State);
    if (!where) return;
    for (const place of where.places.features) {
      if (place.properties.terrain !== followed.terrain) continue;
      const disc = new Feature(new Polygon(place.geometry.coordinates!));
      disc.setStyle(new Style({ stroke: new Stroke({ color: "#111", width: 2, lineDash: [6, 4] }), text: new Text({ text: `${Math.round(100 * place.properties.share_of_gap)} % of the gap in ${place.properties.channel}`, font: "bold 12px system-ui, sans-serif", fill: new Fill({ color: "#111" }), stroke: new Stroke({ color: "#fff", width: 4 }), overflow: true }) }));
      this.source.addFeature(disc);
    }
    where.windows.forEach((window, index) => {
      if (window.terrain !== followed.terrain) return;
      const value = window[followed.rung];
      const feature = new Feature({ geometry: new Point([window.x_m, window.y_m]), window: index });
      feature.setStyle(mark(value === undefined ? null : gapClass(value), palette, followed.drive === "" || followed.drive === window.drive));
      this.source.addFeature(feature);
    });
  }

  point({ followed, tab }: State): void {
    const window = tab === "drives" && followed.window !== null ? followed.diagnosis?.document.where.windows[followed.window] : undefined;
    this.ring.setGeometry(window && window.terrain === followed.terrain ? new Point([window.x_m, window.y_m]) : undefined);
  }
}

/** Circles where the prediction holds, squares where it is off by two deviations and more: apart without colours too. */
function mark(k: number | null, palette: string[], chosen: boolean): Style {
  const stroke = new Stroke({ color: chosen ? "#111" : "#888", width: chosen ? 1.5 : 1 });
  const fill = new Fill({ color: k === null ? "#fff" : chosen ? palette[k]! : `${palette[k]!}70` });
  const radius = chosen ? 7 : 5;
  return new Style({ image: k !== null && k >= 3 ? new RegularShape({ points: 4, radius: radius * 1.3, angle: Math.PI / 4, fill, stroke }) : new Circle({ radius, fill, stroke }), zIndex: (chosen ? 10 : 0) + (k ?? 0) });
}
