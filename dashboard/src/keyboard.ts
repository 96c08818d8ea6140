// Everything that the mouse does can be done from the keyboard.
import type { TerrainMap } from "./map/terrain_map";
import { putAt } from "./map/drawn_layer";
import type { ProfileCharts } from "./profile/charts";
import { store, type Tool } from "./state";

export const keys: [string, string][] = [
  ["S, G, W", "the next click on the map sets the start, the goal, a way point"],
  ["K, I", "draw a zone to keep out of, or to stay in; Enter places a corner at the map's centre, a double click ends"],
  ["C", "the next clicks are corners of the path to check"],
  ["Enter (on the map)", "put it at the centre of the map"],
  ["Arrows, + and − (on the map)", "move and zoom the map"],
  [", and .", "move the cursor along the route or through recorded drives; with Shift by ten. In the charts ← and → do so too"],
  ["1 to 8", "choose a route"],
  ["Ctrl+Enter", "plan or check"],
  ["Ctrl+Z", "take back what was drawn last"],
  ["Escape", "stop drawing, close what is open"],
  ["Y", "why the route has its colour at the cursor"],
  ["Ctrl+P", "a page of paper of the route that is shown"],
  ["?", "this list"],
];

const tools: Record<string, Tool> = { s: "start", g: "goal", w: "waypoint", k: "keep_out", i: "keep_in", c: "corner" };

export function keyboard(map: TerrainMap, mapElement: HTMLElement, charts: ProfileCharts, help: () => void): void {
  document.addEventListener("keydown", (event) => {
    const target = event.target as HTMLElement;
    const typing = target.matches("input:not([type=checkbox]):not([type=range]), textarea, select") || target.closest("dialog") !== null;
    if (event.ctrlKey || event.metaKey) {
      if (event.key === "Enter") document.querySelector<HTMLButtonElement>(".panel:not([hidden]) .primary:not(:disabled)")?.click();
      else if (event.key === "z" && !typing) store.undo();
      else return;
      event.preventDefault();
      return;
    }
    if (typing || event.altKey) return;
    const tool = tools[event.key.toLowerCase()];
    const count = Number(event.key);
    if (tool) {
      if (tool === "corner") store.set({ tab: "check" });
      store.set({ tool }); // pressed again it stays: Escape ends it
    } else if (event.key === "Escape") {
      map.stopDrawing();
      map.closeWhy();
      store.set({ tool: "look", hover_m: null });
    } else if (event.key === "?") help();
    else if (event.key.toLowerCase() === "y") map.tellWhy();
    else if (target.closest(".charts") && (event.key === "ArrowLeft" || event.key === "ArrowRight")) charts.step((event.shiftKey ? 10 : 1) * (event.key === "ArrowLeft" ? -1 : 1));
    else if (event.key === "," || event.key === "<") charts.step(event.shiftKey ? -10 : -1);
    else if (event.key === "." || event.key === ">") charts.step(event.shiftKey ? 10 : 1);
    else if (count >= 1 && count <= (store.state.result?.routes.length ?? 0)) store.set({ route: count - 1 });
    else if (event.key === "Enter" && mapElement.contains(target)) {
      const centre = map.centre();
      if (!centre || !(putAt(store.state.tool, centre) || map.corner(centre))) return;
    } else return;
    event.preventDefault();
  });
}
