// What plans and checks have in common: rover, rules, the reading of the map.
import { field, fill, h, select } from "../dom";
import { words } from "../format";
import { store } from "../state";

export function options(target: HTMLElement): void {
  store.on(["rovers", "rules", "terrain", "options"], (state) => {
    const { options: chosen, rovers, rules, terrain } = state;
    const active = document.activeElement?.id;
    const soil = terrain?.terrain?.soil;
    const legends = [soil?.legend_name ?? "", ...(soil?.other_legends ?? []).map((l) => l.name ?? "")].filter(Boolean);
    const rover = select(rovers.map((r) => ({ value: r.name!, text: r.name! })), chosen.rover, (value) => store.option({ rover: value }));
    const rule = select(
      [{ value: "", text: "the service's own" }, ...rules.map((r) => ({ value: r.name!, text: words(r.name!) }))],
      chosen.rules,
      (value) => store.option({ rules: value }),
    );
    const legend = select(legends.map((name, i) => ({ value: i === 0 ? "" : name, text: words(name) })), chosen.legend, (value) => store.option({ legend: value }));
    rover.id = "option-rover";
    rule.id = "option-rules";
    legend.id = "option-legend";
    const assumption = chosen.legend ? soil?.other_legends?.find((l) => l.name === chosen.legend)?.assumption : soil?.assumption;
    fill(
      target,
      h("div", { class: "columns" }, field("Rover", rover), field("Rules", rule)),
      legends.length > 1 ? field("Soils of the map", legend) : null,
      assumption ? h("details", {}, h("summary", {}, "What is assumed of the ground"), h("p", {}, assumption)) : null,
    );
    if (active?.startsWith("option-")) document.getElementById(active)?.focus();
  });
}
