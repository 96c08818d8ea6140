// Limits that can be moved: the routes are recoloured from the draws that are there, and the verdict waits for a new question.
import { button, fill, h } from "../dom";
import { number } from "../format";
import { limits, type Limit } from "../limits";
import { store } from "../state";

export function limitSliders(): HTMLElement {
  const rows = limits.map(slider);
  const back = button("As asked", () => store.option({ limits: {} }), { class: "quiet", "data-do": "limits-as-asked" });
  const box = h("details", { class: "limits", "data-limits": true },
    h("summary", {}, "What if the limits were others?"),
    h("p", { class: "hint" }, "Move a limit: the routes are coloured by the share of the draws that pass it at each place, from the draws that this answer has. The verdict is of the limits that were asked for, until you ask anew."),
    rows.map((row) => row.element), back);
  store.on(["result", "options"], ({ result, options }) => {
    for (const row of rows) row.show(result?.limits[row.key], options.limits[row.key]);
    back.disabled = Object.keys(options.limits).length === 0;
  });
  return box;
}

interface Row {
  key: Limit["key"];
  element: HTMLElement;
  show: (asked: number | undefined, moved: number | undefined) => void;
}

function slider({ key, words, unit, lowest, highest, step }: Limit): Row {
  const value = h("output", {});
  const range = h("input", { type: "range", id: `limit-${key}`, min: lowest, max: highest, step, "data-limit": key, oninput: () => {
    store.option({ limits: { ...store.state.options.limits, [key]: Number(range.value) } });
    store.set({ routeColour: "limits" });
  } });
  const element = h("div", { class: "limit" }, h("label", { for: range.id }, words), range, value);
  return {
    key,
    element,
    show: (asked, moved) => {
      element.hidden = asked === undefined;
      const now = moved ?? asked ?? lowest;
      if (document.activeElement !== range || Number(range.value) !== now) range.value = String(now);
      fill(value, `${number(now)}${unit && ` ${unit}`}`);
    },
  };
}
