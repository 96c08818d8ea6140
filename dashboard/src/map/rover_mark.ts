// The rover at the charts' cursor: its wheels and body to scale, seen from above, turned and leaning as predicted there.
import LineString from "ol/geom/LineString.js";
import Point from "ol/geom/Point.js";
import Polygon from "ol/geom/Polygon.js";
import { Circle, Fill, RegularShape, Stroke, Style } from "ol/style.js";
import type { Rover } from "../api/client";
import type { Stations } from "../result";

const rad = Math.PI / 180;
const least_px = 16; // a rover that is drawn smaller than this is a ring
const arrow_deg = 15; // a lean of so much is an arrow as long as half the rover

/** Where the rover stands and how: yaw counter-clockwise from east, pitch with the nose down positive, roll with the right side down. */
export interface Pose {
  x_m: number;
  y_m: number;
  yaw_deg: number;
  pitch_deg: number;
  roll_deg: number;
}

export const poseAt = (s: Stations, i: number): Pose => ({ x_m: s.x_m[i]!, y_m: s.y_m[i]!, yaw_deg: s.yaw_deg[i] ?? 0, pitch_deg: s.pitch_deg[i] ?? 0, roll_deg: s.roll_deg[i] ?? 0 });

/** A place of the rover (forward, left, up) on the map, seen from above. */
function onMap({ x_m, y_m, yaw_deg, pitch_deg, roll_deg }: Pose, [x, y, z]: number[]): number[] {
  const [p, r, w] = [pitch_deg * rad, roll_deg * rad, yaw_deg * rad];
  const [y1, z1] = [y! * Math.cos(r) - z! * Math.sin(r), y! * Math.sin(r) + z! * Math.cos(r)];
  const x2 = x! * Math.cos(p) + z1 * Math.sin(p);
  return [x_m + x2 * Math.cos(w) - y1 * Math.sin(w), y_m + x2 * Math.sin(w) + y1 * Math.cos(w)];
}

function box(pose: Pose, [cx, cy, cz]: number[], length: number, width: number): Polygon {
  const corners = [[1, 1], [1, -1], [-1, -1], [-1, 1], [1, 1]].map(([i, j]) => onMap(pose, [cx! + (i! * length) / 2, cy! + (j! * width) / 2, cz!]));
  return new Polygon([corners]);
}

const ring = (pose: Pose) => new Style({ geometry: new Point([pose.x_m, pose.y_m]), image: new Circle({ radius: 8, fill: new Fill({ color: "#ffffffcc" }), stroke: new Stroke({ color: "#000", width: 3 }) }) });

export function roverStyles(rover: Rover | undefined, pose: Pose, resolution: number): Style[] {
  const wheels = rover?.wheels ?? [];
  const reach = Math.max(0, ...wheels.map((w) => Math.abs(w.position_m?.[0] ?? 0) + (w.radius_m ?? 0)));
  if ((2 * reach) / resolution < least_px) return [ring(pose)];
  const side = Math.max(...wheels.map((w) => Math.abs(w.position_m?.[1] ?? 0) - (w.width_m ?? 0) / 2));
  const height = rover?.com_m?.[2] ?? 0;
  const styles = wheels.map((w) => new Style({ geometry: box(pose, w.position_m ?? [0, 0, 0], 2 * (w.radius_m ?? 0.1), w.width_m ?? 0.1), fill: new Fill({ color: "#111" }), stroke: new Stroke({ color: "#fff", width: 1.5 }) }));
  styles.push(new Style({ geometry: box(pose, [0, 0, height], 1.5 * reach, 1.7 * side), fill: new Fill({ color: "#ffffffd0" }), stroke: new Stroke({ color: "#111", width: 2 }), zIndex: 1 }));
  // The nose, and an arrow to where it leans.
  styles.push(new Style({ geometry: new LineString([onMap(pose, [0.75 * reach, 0.5 * side, height]), onMap(pose, [1.05 * reach, 0, height]), onMap(pose, [0.75 * reach, -0.5 * side, height])]), stroke: new Stroke({ color: "#111", width: 3 }), zIndex: 1 }));
  const lean = Math.hypot(pose.pitch_deg, pose.roll_deg);
  if (lean > 1) {
    const way = (reach * lean) / arrow_deg / lean;
    const tip = onMap({ ...pose, pitch_deg: 0, roll_deg: 0 }, [way * pose.pitch_deg, -way * pose.roll_deg, 0]);
    const turn = Math.atan2(tip[0]! - pose.x_m, tip[1]! - pose.y_m);
    styles.push(new Style({ geometry: new LineString([[pose.x_m, pose.y_m], tip]), stroke: new Stroke({ color: "#b3261e", width: 3 }), zIndex: 2 }));
    styles.push(new Style({ geometry: new Point(tip), image: new RegularShape({ points: 3, radius: 7, rotation: turn, fill: new Fill({ color: "#b3261e" }) }), zIndex: 2 }));
  }
  return styles;
}

const angle = (value: number) => `${Math.abs(value).toFixed(1)}°`;

/** "nose up 4.1°, right side down 2.0°": as the prediction has it on the mean soils. */
export function leanText({ pitch_deg, roll_deg }: Pose): string {
  const parts = [Math.abs(pitch_deg) >= 0.05 && `nose ${pitch_deg > 0 ? "down" : "up"} ${angle(pitch_deg)}`, Math.abs(roll_deg) >= 0.05 && `${roll_deg > 0 ? "right" : "left"} side down ${angle(roll_deg)}`].filter(Boolean);
  return parts.length > 0 ? parts.join(", ") : "level";
}
