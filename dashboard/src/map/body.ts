// A terrain's map on its own body: no Earth in it.
import Projection from "ol/proj/Projection.js";
import proj4 from "proj4";
import type { Terrain } from "../api/client";

export interface Body {
  projection: Projection;
  /** Longitude (east) and latitude in degrees; null where the map has no place on the body. */
  degrees(x_m: number, y_m: number): [number, number] | null;
  fromDegrees(longitude: number, latitude: number): [number, number] | null;
}

const rad = Math.PI / 180;

/** Great-circle distance on a sphere, by the haversine. */
function distance(radius_m: number, a: [number, number], b: [number, number]): number {
  const s = Math.sin(((b[1] - a[1]) * rad) / 2) ** 2;
  const t = Math.sin(((b[0] - a[0]) * rad) / 2) ** 2;
  return 2 * radius_m * Math.asin(Math.sqrt(s + Math.cos(a[1] * rad) * Math.cos(b[1] * rad) * t));
}

export function bodyOf(terrain: Terrain): Body {
  const e = terrain.extent!;
  const radius_m = terrain.semi_major_axis_m ?? 0;
  let converter: proj4.Converter | null = null;
  if (terrain.crs_wkt && radius_m > 0) {
    try {
      // Of a sphere: PROJ's planetocentric latitude, as the service counts it.
      converter = proj4(`+proj=longlat +a=${radius_m} +b=${radius_m} +no_defs`, terrain.crs_wkt);
      if (!converter.inverse([e.west_m!, e.north_m!]).every(Number.isFinite)) converter = null;
    } catch {
      converter = null; // a system that proj4 does not know: map metres are taken for the ground's
    }
  }
  const degrees = (x: number, y: number): [number, number] | null => (converter ? (converter.inverse([x, y]) as [number, number]) : null);
  const projection = new Projection({
    code: `slipway:${terrain.name}`,
    units: "m",
    metersPerUnit: 1,
    axisOrientation: "enu",
    extent: [e.west_m!, e.south_m!, e.east_m!, e.north_m!],
    // OpenLayers would measure on the Earth's radius.
    getPointResolution: (resolution, [x, y]) => {
      const half = 50; // metres of the map: few enough for any terrain, many enough for the arithmetic
      const [w, east, s, n] = [degrees(x! - half, y!), degrees(x! + half, y!), degrees(x!, y! - half), degrees(x!, y! + half)];
      if (!w || !east || !s || !n) return resolution;
      return (resolution * (distance(radius_m, w, east) + distance(radius_m, s, n))) / 2 / (2 * half);
    },
  });
  return {
    projection,
    degrees,
    fromDegrees: (longitude, latitude) => (converter ? (converter.forward([longitude, latitude]) as [number, number]) : null),
  };
}

const degreesText = (value: number, positive: string, negative: string): string => `${Math.abs(value).toFixed(5)}° ${value < 0 ? negative : positive}`;

/** "137.37012° E, 4.66780° S"; nothing where the map has no place on its body. */
export function placeInDegrees({ x_m, y_m }: { x_m: number; y_m: number }, body: Body | null): string {
  const degrees = body?.degrees(x_m, y_m);
  return degrees ? `${degreesText(degrees[0], "E", "W")}, ${degreesText(degrees[1], "N", "S")}` : "";
}
