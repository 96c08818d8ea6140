// What lies under the pointer: place, height, slope, soil, as the service says.
import { get, type Ground } from "../api/client";
import { number, share, words } from "../format";
import { store } from "../state";
import { placeInDegrees } from "./body";
import { riskTitles, valueAt } from "./risk_map";
import type { RiskMap } from "./risk_types";
import type { TerrainMap } from "./terrain_map";

let timer = 0;
let asked: AbortController | null = null;

/** The place at once; the ground when the pointer has rested. */
export function readout(target: HTMLElement, map: TerrainMap, at: number[] | null): void {
  clearTimeout(timer);
  asked?.abort();
  if (!at) {
    target.textContent = "";
    return;
  }
  const [x, y] = at as [number, number];
  if (map.isTerrain && !map.isOnMap(at)) {
    target.textContent = "beyond the map";
    return;
  }
  const risks = store.state.risk.map((m) => riskText(m, x, y)).join("");
  const degrees = placeInDegrees({ x_m: x, y_m: y }, map.body);
  const place = `x ${x.toFixed(1)} m, y ${y.toFixed(1)} m${degrees && ` · ${degrees}`}`;
  target.textContent = place + risks;
  const name = store.state.terrain?.terrain?.name;
  if (!name || document.hidden || !map.isTerrain) return;
  timer = window.setTimeout(() => {
    asked = new AbortController();
    get<Ground>(`v1/terrains/${name}/point?x_m=${x}&y_m=${y}`, asked.signal)
      .then((g) => {
        target.textContent = `${place} · height ${number(g.height_m, 6)} m · slope ${number(g.slope_deg)}° · ${g.soil ? words(g.soil) : "unknown ground"}${g.label ? ` (${g.label})` : ""}${risks}`;
      })
      .catch(() => {
        // Off the map, or no elevation there: the place alone is shown.
      });
  }, 250);
}

function riskText(map: RiskMap, x_m: number, y_m: number): string {
  const value = valueAt(map, x_m, y_m);
  if (value === undefined) return "";
  const title = riskTitles[map.kind].toLowerCase();
  if (value === null) return ` · ${title}: unknown`;
  const name = map.document?.classes?.find((c) => c.value === value)?.name;
  return ` · ${title}: ${name ?? (map.kind.endsWith("risk") ? share(value) : number(value))}`;
}
