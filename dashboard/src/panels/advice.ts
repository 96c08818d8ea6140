// What keeps a route from a GO and what would change that, as the service says it: with a button where the page can do it.
import { button, h } from "../dom";
import { sentence, words } from "../format";
import type { TerrainMap } from "../map/terrain_map";
import { verdictWords, type Result, type Route } from "../result";
import { store } from "../state";
import { planNow } from "../work";

type Advice = Route["decision"]["advice"][number];

const scout_m = 5;

/** A reason as the service says it; names of rules and soils have their underscores as spaces, times no seconds. */
export const reasonText = (reason: string): string => sentence(words(reason.replace(/(\d{4}-\d\d-\d\d)T(\d\d:\d\d):[\d.]+Z/g, "$1 $2 UTC")));

function act(result: Result, advice: Advice, show: (from_m: number, to_m: number) => void): HTMLElement | null {
  switch (advice.kind) {
    case "shorter_drive":
      if (result.kind !== "plan") return button("Show where", () => show(0, advice.at_m), { "data-do": "shorter" });
      return button("Make it the goal and plan again", () => {
        store.draw({ goal: { x_m: advice.x_m, y_m: advice.y_m }, waypoints: [] });
        planNow();
      }, { "data-do": "nearer-goal" });
    case "other_route":
      return button("Look at it", () => store.set({ route: advice.route - 1, compared: null }), { "data-do": "other-route" });
    case "scout_drive":
      return button("Show where", () => show(advice.at_m, advice.at_m + scout_m), { "data-do": "scout" });
  }
}

export function adviceView(result: Result, route: Route, map: TerrainMap): HTMLElement[] {
  const { verdict, reasons, rules, advice, otherwise } = route.decision;
  const show = (from_m: number, to_m: number) => {
    store.set({ hover_m: from_m });
    map.showStretch(from_m, to_m);
  };
  // What a rule says of the drive bears that rule's own verdict.
  const reason = (text: string) => {
    const rule = rules.find((r) => text.startsWith(r.words));
    const at_m = rule?.at_m;
    return h("li", {}, rule && verdict !== "go" ? h("span", { class: `badge ${rule.verdict}` }, verdictWords[rule.verdict]) : null, " ", reasonText(text), at_m !== undefined ? [" ", button("Show where", () => show(at_m, at_m), { class: "link" })] : null);
  };
  return [
    h("h3", {}, verdict === "go" ? "Why it is a GO" : "What keeps it from a GO"),
    h("ul", { class: "reasons", "data-reasons": verdict }, reasons.map(reason)),
    ...(verdict === "go" ? [] : [
      h("h3", {}, "What would change it"),
      h("ul", { class: "advice" }, [...advice.map((a) => h("li", {}, `${sentence(a.words)}.`, act(result, a, show))), ...(otherwise ? [h("li", {}, `${sentence(otherwise)}.`)] : [])]),
    ]),
  ];
}
