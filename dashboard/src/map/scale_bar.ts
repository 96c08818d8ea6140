// How long a metre of the body's ground is on the map: a bar of a round length, here and on paper.
import type OlMap from "ol/Map.js";
import type MapEvent from "ol/MapEvent.js";
import Control from "ol/control/Control.js";
import { h } from "../dom";

const most_px = 150;

/** The longest of 1, 2 and 5 times a power of ten that is at most this long. */
export function roundLength(most_m: number): number {
  const power = 10 ** Math.floor(Math.log10(most_m));
  const factor = [5, 2].find((k) => k * power <= most_m * (1 + 1e-9)) ?? 1;
  return factor * power;
}

/** Lengths below a metre in centimetres, from a thousand metres on in kilometres. */
export function lengthText(length_m: number): string {
  const [value, unit] = length_m >= 1000 ? [length_m / 1000, "km"] : length_m >= 1 ? [length_m, "m"] : [length_m * 100, "cm"];
  return `${Number(value.toPrecision(3))} ${unit}`;
}

/** Metres of ground that a pixel at the map's centre is: on the body, not on the Earth, which OpenLayers would take. */
export function groundResolution(map: OlMap): number | null {
  const view = map.getView();
  const [centre, resolution] = [view.getCenter(), view.getResolution()];
  if (!centre || !resolution) return null;
  return view.getProjection().getPointResolutionFunc()?.(resolution, centre) ?? resolution;
}

export class ScaleBar extends Control {
  private readonly bar: HTMLElement;
  private shown = "";

  constructor() {
    const bar = h("div", { class: "scale-bar-inner" });
    super({ element: h("div", { class: "scale-bar ol-unselectable" }, bar) });
    this.bar = bar;
  }

  override render(event: MapEvent): void {
    const metres_per_px = groundResolution(event.map);
    this.element.hidden = metres_per_px === null;
    if (metres_per_px === null) return;
    const length_m = roundLength(most_px * metres_per_px);
    const width = `${(length_m / metres_per_px).toFixed(1)}px`;
    if (width + length_m === this.shown) return;
    this.shown = width + length_m;
    this.bar.style.width = width;
    this.bar.textContent = lengthText(length_m);
    this.bar.dataset.length = String(length_m);
  }
}
