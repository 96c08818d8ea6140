// What plans, checks and maps have in common: rover, rules, the belief about the ground, effects, a corrected model.
import { button, field, fill, folded, h, select } from "../dom";
import { bareName, number, roverWords, sentence, wheelWords, words } from "../format";
import { limits } from "../limits";
import { store, type State } from "../state";
import { departureFields, hasSky, skyTable, solOnMap } from "./departure";

export function options(target: HTMLElement, id: string): void {
  const common = h("div");
  const belief = h("details");
  const rover = h("details");
  const day = h("details", { "data-departure": true });
  fill(target, common, belief, rover, day);
  const keepFocus = (element: HTMLElement, draw: () => void) => {
    const active = document.activeElement?.id;
    draw();
    if (active && element.querySelector(`#${CSS.escape(active)}`)) document.getElementById(active)?.focus();
  };
  store.on(["rovers", "rules", "terrain", "options"], (state) => keepFocus(common, () => fill(common, commonFields(state, id))));
  const drawBelief = folded(belief, () => "What is believed of the ground", () => beliefFields(store.state, id));
  store.on(["terrain", "options"], () => keepFocus(belief, drawBelief));
  const drawRover = folded(rover, () => `Effects and failed wheels${changed(store.state)}`, () => roverFields(store.state, id));
  store.on(["effects", "rovers", "options"], () => keepFocus(rover, drawRover));
  let typed = store.state.options.departure; // here: the fields that are typed into stay
  const drawDay = folded(day, dayTitle, () => departureFields(store.state, id, (departure) => {
    typed = departure;
    store.option({ departure });
    day.querySelector("summary")!.textContent = dayTitle();
  }));
  let drawn = "";
  store.on(["terrain", "options", "sol"], (state) => {
    const now = `${hasSky(state)} ${skyTable(state) !== null} ${solOnMap(state) !== null}`;
    if (now === drawn && state.options.departure === typed) return;
    drawn = now;
    typed = state.options.departure;
    drawDay();
  });
}

const dayTitle = (): string => `When it may begin${Object.keys(store.state.options.departure).length > 0 ? " (asked)" : ""}`;

function commonFields(state: State, id: string): (HTMLElement | null)[] {
  const { options: chosen, rovers, rules } = state;
  const rover = select(rovers.map((r) => ({ value: r.name!, text: roverWords(r.name!) })), chosen.rover, (value) => store.option({ rover: value, failedWheels: {}, ...(chosen.model && chosen.model.rover !== value ? { model: null } : {}) }));
  const rule = select([{ value: "", text: "the usual limits" }, ...rules.map((r) => ({ value: r.name!, text: words(r.name!) }))], chosen.rules, (value) => store.option({ rules: value }));
  rover.id = `${id}-rover`;
  rule.id = `${id}-rules`;
  const set = rules.find((r) => r.name === chosen.rules);
  const summary = rovers.find((r) => r.name === chosen.rover)?.summary;
  return [
    h("div", { class: "columns" }, field("Rover", rover), field("Rules", rule)),
    summary ? h("p", { class: "hint" }, `${summary}.`) : null,
    set ? h("p", { class: "hint" }, `${set.summary ?? ""}.`) : null,
    movedLimits(state),
    state.terrain?.terrain?.soil?.source === "none" ? h("p", { class: "hint", "data-no-soils": true }, "No map names the soils of this terrain: all of it is unknown ground, and no drive on it can be called a GO before some of it has been seen.") : null,
    modelNote(state),
  ];
}

/** Limits that were moved go with the next question too. */
function movedLimits({ options: { limits: moved } }: State): HTMLElement | null {
  const texts = limits.flatMap(({ key, words: text, unit }) => (moved[key] === undefined ? [] : [`${text.toLowerCase()} ${moved[key]}${unit && ` ${unit}`}`]));
  if (texts.length === 0) return null;
  return h("div", { class: "model-note", "data-moved-limits": true }, h("span", {}, `With ${texts.join(", ")}.`), button("As the rules have it", () => store.option({ limits: {} }), { class: "quiet" }));
}

function modelNote({ options: { model } }: State): HTMLElement | null {
  if (!model) return null;
  return h("div", { class: "model-note", "data-model": model.diagnosis },
    h("span", {}, `With the model that the drives${model.campaign ? ` of ${words(model.campaign)}` : ""} corrected${model.ground.length > 0 ? `; ${model.ground.map(words).join(", ")} as their ground` : ""}.`),
    button("Without it", () => store.option({ model: null }), { class: "quiet", "data-do": "no-model" }));
}

/** How the map's soils are read, how sure that is, and what unknown ground is taken for. */
function beliefFields({ terrain, options: chosen }: State, id: string): (HTMLElement | null)[] {
  const soil = terrain?.terrain?.soil;
  const legends = [soil?.legend_name ?? "", ...(soil?.other_legends ?? []).map((l) => l.name ?? "")].filter(Boolean);
  const legend = select(legends.map((name, i) => ({ value: i === 0 ? "" : name, text: words(name) })), chosen.legend === soil?.legend_name ? "" : chosen.legend, (value) => store.option({ legend: value }));
  legend.id = `${id}-legend`;
  const other = soil?.other_legends?.find((l) => l.name === chosen.legend);
  const assumption = other?.assumption ?? soil?.assumption;
  const confidence = h("input", { id: `${id}-confidence`, type: "number", min: 0.01, max: 0.99, step: 0.01, value: chosen.confidence ?? "", placeholder: String(other?.confidence ?? soil?.confidence ?? 1), onchange: () => {
    const value = Number(confidence.value);
    store.option({ confidence: confidence.value !== "" && value > 0 && value < 1 ? value : null });
  } });
  const draws = h("input", { id: `${id}-draws`, type: "number", min: 1, max: 2000, step: 1, value: chosen.draws ?? "", onchange: () => {
    const value = Math.round(Number(draws.value));
    store.option({ draws: draws.value !== "" && value >= 1 && value <= 2000 ? value : null });
  } });
  const known = [...new Set((other?.legend ?? soil?.legend ?? []).map((entry) => entry.soil).filter((s): s is string => !!s))];
  const unknown = select([{ value: "", text: words(soil?.unknown_soil ?? "unknown ground") }, ...known.map((s) => ({ value: s, text: words(s) }))], chosen.unknownSoil, (value) => store.option({ unknownSoil: value }));
  unknown.id = `${id}-unknown`;
  return [
    legends.length > 1 ? field("Soils of the map", legend) : null,
    assumption ? h("p", { class: "hint" }, assumption) : null,
    h("div", { class: "columns" }, field("Map is right with probability", confidence), field("Unknown ground is taken for", unknown)),
    field("Draws of the ground", draws, "As many as the verdict needs, unless you say how many."),
  ];
}

function changed({ options: chosen }: State): string {
  const differ = chosen.effects.length + Object.keys(chosen.failedWheels).length;
  return differ > 0 ? ` (${differ} changed)` : "";
}

/** Effects beyond the basic model, and wheels whose drive has failed. */
function roverFields({ effects, rovers, options: chosen }: State, id: string): (HTMLElement | null)[] {
  const rover = rovers.find((r) => r.name === chosen.rover);
  const own = (rover as { effects?: { name: string }[] } | undefined)?.effects ?? [];
  const set = (name: string, change: Partial<State["options"]["effects"][number]> | null) => {
    const others = chosen.effects.filter((e) => e.name !== name);
    const now = chosen.effects.find((e) => e.name === name) ?? { name, on: true, parameters: {} };
    store.option({ effects: change === null ? others : [...others, { ...now, ...change }].sort((a, b) => a.name.localeCompare(b.name)) });
  };
  const rows = effects.map((effect) => {
    const name = effect.name!;
    const has = own.some((e) => e.name === name);
    const asked = chosen.effects.find((e) => e.name === name);
    const on = asked ? asked.on : has;
    const box = h("input", { type: "checkbox", id: `${id}-effect-${name}`, checked: on, onchange: () => set(name, box.checked === has ? null : { on: box.checked }) });
    return h("div", { class: "effect" },
      h("label", { class: "check" }, box, words(name), has ? h("small", {}, "the rover's") : null),
      h("p", { class: "hint" }, `${sentence(effect.summary ?? "")}.`),
      on && !has ? h("div", { class: "columns" }, (effect.parameters ?? []).map((p) => {
        const input = h("input", { id: `${id}-effect-${name}-${p.name}`, type: "number", step: "any", min: p.lowest, max: p.highest, value: asked?.parameters[p.name!] ?? p.initial, onchange: () => {
          const { [p.name!]: _, ...rest } = asked?.parameters ?? {};
          const value = Number(input.value);
          set(name, { parameters: input.value === "" || value === p.initial ? rest : { ...rest, [p.name!]: value } });
        } });
        return field(`${words(bareName(p.name!, p.unit))}${p.unit && p.unit !== "1" ? `, ${p.unit}` : ""}`, input, `${p.summary ? `${sentence(p.summary)}: ` : ""}${number(p.lowest)} to ${number(p.highest)}`);
      })) : null);
  });
  const wheels = (rover?.wheels ?? []).map((wheel) => {
    const name = wheel.name!;
    const states = { "": "drives", locked: "locked: it does not turn", free: "free: uncoupled", off: "off: its motor has no power" };
    const choice = select(Object.entries(states).map(([value, text]) => ({ value, text })), chosen.failedWheels[name] ?? "", (value) => {
      const { [name]: _, ...rest } = chosen.failedWheels;
      store.option({ failedWheels: value ? { ...rest, [name]: value as "locked" | "free" | "off" } : rest });
    });
    choice.id = `${id}-wheel-${name}`;
    return field(sentence(wheelWords(name)), choice);
  });
  return [
    h("p", { class: "hint" }, "What the simulator has besides wheels in soil: off unless the rover or you say so."),
    ...rows,
    wheels.length > 0 ? h("div", { class: "columns" }, wheels) : null,
  ];
}
