// Maps of risk as layers: classes in colours that can be changed; what is not known is hatched and never has a colour.
import ImageLayer from "ol/layer/Image.js";
import ImageCanvas from "ol/source/ImageCanvas.js";
import type Projection from "ol/proj/Projection.js";
import type { State } from "../state";
import { riskClasses } from "./risk_map";
import type { RiskMap } from "./risk_types";
import type { Raster } from "./tiff";

const rows_at_once = 128; // coloured in one go: the page answers in between

interface Painted {
  colours: HTMLCanvasElement;
  unknown: HTMLCanvasElement;
  under: string; // colour between the lines of the hatching
}

export type RiskLayer = ImageLayer<ImageCanvas>;

/** A layer of a map that is there. It appears once it has been coloured. */
export function riskLayer(map: RiskMap, state: State, projection: Projection): RiskLayer {
  let painted: Painted | null = null;
  const e = map.document!.extent;
  const target = document.createElement("canvas");
  const source = new ImageCanvas({
    projection,
    ratio: 1.2,
    interpolate: false,
    canvasFunction: (extent, resolution, pixelRatio, size) => {
      const [width, height] = [Math.round(size[0]!), Math.round(size[1]!)];
      target.width = width;
      target.height = height;
      if (!painted) return target;
      const px = pixelRatio / resolution;
      const box: [number, number, number, number] = [(e.west_m - extent[0]!) * px, (extent[3]! - e.north_m) * px, (e.east_m - e.west_m) * px, (e.north_m - e.south_m) * px];
      drawHatched(target, painted, box, pixelRatio);
      const context = target.getContext("2d")!;
      context.imageSmoothingEnabled = false;
      context.drawImage(painted.colours, ...box);
      return target;
    },
  });
  void paint(map, state).then((done) => {
    painted = done;
    source.changed();
  });
  return new ImageLayer({ source, opacity: map.opacity, zIndex: 12 });
}

/** The hatching is as wide at every zoom. */
function drawHatched(target: HTMLCanvasElement, { unknown, under }: Painted, box: [number, number, number, number], pixelRatio: number): void {
  const context = target.getContext("2d")!;
  context.imageSmoothingEnabled = false;
  context.drawImage(unknown, ...box);
  context.globalCompositeOperation = "source-in";
  context.fillStyle = hatching(context, Math.round(8 * pixelRatio), under);
  context.fillRect(0, 0, target.width, target.height);
  context.globalCompositeOperation = "source-over";
}

function hatching(context: CanvasRenderingContext2D, size: number, under: string): CanvasPattern {
  const tile = document.createElement("canvas");
  tile.width = tile.height = size;
  const c = tile.getContext("2d")!;
  c.fillStyle = under;
  c.fillRect(0, 0, size, size);
  c.strokeStyle = "#222222";
  c.lineWidth = size / 4;
  for (const shift of [-size, 0, size]) {
    c.beginPath();
    c.moveTo(shift, size);
    c.lineTo(shift + size, 0);
    c.stroke();
  }
  return context.createPattern(tile, "repeat")!;
}

function canvasOf({ columns, rows }: Raster): [HTMLCanvasElement, CanvasRenderingContext2D] {
  const canvas = document.createElement("canvas");
  canvas.width = columns;
  canvas.height = rows;
  return [canvas, canvas.getContext("2d")!];
}

const rgb = (colour: string): number[] => [1, 3, 5].map((i) => parseInt(colour.slice(i, i + 2), 16));

async function paint(map: RiskMap, state: State): Promise<Painted> {
  const raster = map.raster!;
  const { classes, classOf } = riskClasses(map.document!, state);
  const ofClass = classes.map((c) => (c.colour ? rgb(c.colour) : [0, 0, 0]));
  const [colours, onColours] = canvasOf(raster);
  const [unknown, onUnknown] = canvasOf(raster);
  for (let first = 0; first < raster.rows; first += rows_at_once) {
    const rows = Math.min(rows_at_once, raster.rows - first);
    const [known, masked] = [onColours.createImageData(raster.columns, rows), onUnknown.createImageData(raster.columns, rows)];
    for (let i = 0; i < rows * raster.columns; ++i) {
      const k = classOf(raster.values[first * raster.columns + i]!);
      const into = k < 0 ? masked.data : known.data;
      if (k >= 0) for (let c = 0; c < 3; ++c) into[4 * i + c] = ofClass[k]![c]!;
      into[4 * i + 3] = 255;
    }
    onColours.putImageData(known, 0, first);
    onUnknown.putImageData(masked, 0, first);
    await new Promise((resolve) => setTimeout(resolve));
  }
  return { colours, unknown, under: classes.find((c) => c.hatched)?.colour ?? "#ffffff" };
}
