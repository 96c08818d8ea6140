// The rover at the cursor from its side and from behind, leaning as predicted, with the angles in words.
import { fill, h, svg } from "../dom";
import { number, share, words } from "../format";
import { store, type State } from "../state";
import { stationAt } from "../result";
import { utcText } from "../sky";
import { leanText, poseAt } from "./rover_mark";

const [width, height] = [64, 44];

function view(turn_deg: number, wheels: number[], half: number, title: string): SVGElement {
  return svg("svg", { viewBox: `${-width / 2} ${-height + 10} ${width} ${height}`, width, height, role: "img", "aria-label": title },
    svg("line", { x1: -30, x2: 30, y1: 6, y2: 6, stroke: "currentColor", "stroke-width": 1, "stroke-dasharray": "3 3" }),
    svg("g", { transform: `rotate(${turn_deg.toFixed(1)})` },
      svg("line", { x1: -30, x2: 30, y1: 6, y2: 6, stroke: "currentColor", "stroke-width": 2 }),
      svg("rect", { x: -half, y: -17, width: 2 * half, height: 10, fill: "none", stroke: "currentColor", "stroke-width": 2 }),
      ...wheels.flatMap((x) => [svg("circle", { cx: x, cy: 0, r: 6, fill: "currentColor" }), svg("line", { x1: x, y1: 0, x2: 0.6 * x, y2: -8, stroke: "currentColor", "stroke-width": 2 })])));
}

export function leanView(target: HTMLElement): void {
  const draw = ({ result, route, hover_m, stale }: State) => {
    const chosen = stale === "all" ? undefined : result?.routes[route];
    target.classList.toggle("off", !chosen || hover_m === null); // it keeps its place: no mark is to lie under it
    if (!chosen || hover_m === null) return;
    const { stations: s } = chosen;
    const i = stationAt(s, hover_m);
    const pose = poseAt(s, i);
    // Seen from its right side the nose is to the right; seen from behind its right side is.
    fill(target,
      h("div", { class: "views" }, view(pose.pitch_deg, [-20, 0, 20], 17, "from its side, nose to the right"), view(pose.roll_deg, [-14, 14], 13, "from behind")),
      h("p", { "data-lean": true }, `${s.distance_m[i]!.toFixed(1)} m: ${leanText(pose)}`, s.at_ms ? `, ${utcText(s.at_ms[i]!).slice(11)}` : "", h("br"), h("span", {}, `slip ${number(s.slip_p50[i] ?? s.slip[i], 2)}, ${s.on_unknown_ground[i] ? "unknown ground" : words(s.soil[i] ?? "unknown ground")}, halts ${share(s.risk[i])}`)));
  };
  let asked = 0;
  // At most once a frame: the pointer moves faster.
  store.on(["hover_m", "result", "route", "stale"], () => {
    cancelAnimationFrame(asked);
    asked = requestAnimationFrame(() => draw(store.state));
  });
}
