// Where the ground lies in shadow at the slider's time, or in which share of the sol's daylight the sun reaches it: pictures of the service's.
import type OlMap from "ol/Map.js";
import ImageLayer from "ol/layer/Image.js";
import type Projection from "ol/proj/Projection.js";
import ImageCanvas from "ol/source/ImageCanvas.js";
import { ask } from "../api/client";
import { momentAt } from "../sky";
import { store, type State } from "../state";
import { report } from "../work";

const apart_ms = 150; // between two pictures
const most_suns = 24;

export class ShadowLayer {
  readonly layer = new ImageLayer<ImageCanvas>({ zIndex: 11 });
  private shown: { image: ImageBitmap; bounds: number[] } | null = null;
  private at = ""; // of the picture that is shown or was asked for last
  private sent = -Infinity;
  private busy = false;
  private timer = 0;

  /** `isTerrain`: what the map shows is the terrain, and not a campaign's own ground. */
  constructor(private readonly map: OlMap, private readonly isTerrain: () => boolean) {
    map.on("moveend", () => this.soon());
    store.on(["day", "sol", "terrain"], () => this.soon());
  }

  /** The ground of another terrain. */
  use(projection: Projection): void {
    this.shown = null;
    this.at = "";
    const target = document.createElement("canvas");
    this.layer.setSource(new ImageCanvas({
      projection,
      ratio: 1,
      canvasFunction: (extent, resolution, pixelRatio, size) => {
        target.width = Math.round(size[0]!);
        target.height = Math.round(size[1]!);
        if (!this.shown) return target;
        const px = pixelRatio / resolution;
        const [west, south, east, north] = this.shown.bounds as [number, number, number, number];
        target.getContext("2d")!.drawImage(this.shown.image, (west - extent[0]!) * px, (extent[3]! - north) * px, (east - west) * px, (north - south) * px);
        return target;
      },
    }));
  }

  private soon(): void {
    const shows = store.state.day.shows !== "" && this.isTerrain();
    this.layer.setVisible(shows);
    clearTimeout(this.timer);
    if (shows) this.timer = window.setTimeout(() => void this.send(), Math.max(0, this.sent + apart_ms - performance.now()));
  }

  private async send(): Promise<void> {
    const wanted = wantedOf(store.state, this.map.getView().calculateExtent(this.map.getSize()));
    if (this.busy || !wanted || wanted.path === this.at) return; // what has changed meanwhile is looked at when the picture is there
    this.busy = true;
    this.sent = performance.now();
    this.at = wanted.path;
    this.layer.setOpacity(0.6); // that of before
    try {
      const image = await createImageBitmap(await (await ask(wanted.path)).blob());
      this.shown = { image, bounds: wanted.bounds };
      this.layer.getSource()?.changed();
      this.map.getTargetElement().dataset.shadow = wanted.suns;
    } catch (error) {
      report(error);
    }
    this.busy = false;
    this.layer.setOpacity(1);
    this.soon();
  }
}

function wantedOf({ terrain, day, sol }: State, view: number[]): { path: string; bounds: number[]; suns: string } | null {
  const e = terrain?.terrain?.extent;
  if (!e || !sol || sol.moments.length < 2 || !sol.key.startsWith(`${terrain.terrain!.name}/`)) return null;
  const bounds = [Math.max(view[0]!, e.west_m!), Math.max(view[1]!, e.south_m!), Math.min(view[2]!, e.east_m!), Math.min(view[3]!, e.north_m!)].map((v) => Math.round(v * 100) / 100);
  if (bounds[0]! >= bounds[2]! || bounds[1]! >= bounds[3]!) return null;
  const up = sol.moments.filter(({ sun }) => sun.elevation_deg > 0);
  const every = Math.ceil(up.length / most_suns);
  const moments = day.shows === "share" && up.length > 1 ? up.filter((_, i) => i % every === 0) : [momentAt(sol, day.at_ms)];
  if (day.shows === "share" && moments.length === 1) moments.push(moments[0]!); // several suns have the colours of a share
  const suns = moments.map(({ sun }) => `${sun.azimuth_deg.toFixed(2)},${sun.elevation_deg.toFixed(2)}`).join(";");
  return { path: `v1/terrains/${encodeURIComponent(terrain.terrain!.name!)}/shadow.png?bounds=${bounds.join()}&sun=${suns}&v=${terrain.hash ?? ""}`, bounds, suns };
}
