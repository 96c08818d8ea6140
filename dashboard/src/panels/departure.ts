// When the drive may begin and what must hold on the way: what the form asks of the day.
import { button, field, h } from "../dom";
import type { Sol } from "../sky";
import { store, type Departure, type SkyTable, type State } from "../state";

interface Asked {
  key: string;
  words: string;
  lowest: number;
  highest: number;
  usual?: string;
}
const numbers: Asked[] = [
  { key: "charge_percent", words: "Battery at first, %", lowest: 0, highest: 100, usual: "100" },
  { key: "min_charge_percent", words: "Battery never below, %", lowest: 0, highest: 100 },
  { key: "min_sun_deg", words: "Sun never below, °", lowest: -90, highest: 90 },
  { key: "min_earth_deg", words: "Earth never below, °", lowest: -90, highest: 90 },
  { key: "light_left_h", words: "Light left after, h", lowest: 0, highest: 1000 },
  { key: "optical_depth", words: "Dust, optical depth", lowest: 0, highest: 20, usual: "0" },
  { key: "coldest_c", words: "Coldest air, °C", lowest: -273, highest: 200 },
  { key: "warmest_c", words: "Warmest air, °C", lowest: -273, highest: 200 },
  { key: "every_min", words: "Listed every, min", lowest: 0.1, highest: 100_000, usual: "15" },
];

/** The table of the opened request, if that was about this terrain. */
export const skyTable = ({ options, terrain }: State): SkyTable | null => (options.sky && options.sky.terrain === terrain?.terrain?.name ? options.sky : null);

/** Elsewhere than on Mars a request brings a sky of its own, which can't be typed into a form. */
export const hasSky = (state: State): boolean => state.terrain?.terrain?.body === "Mars" || skyTable(state) !== null;

/** Of which the windows may be asked. */
export const solOnMap = ({ sol }: State): Sol | null => (sol && !sol.refused ? sol : null);

export function departureFields(state: State, id: string, change: (departure: Departure) => void): (HTMLElement | null)[] {
  const { departure } = state.options;
  if (!hasSky(state)) return [h("p", { class: "hint", "data-no-departure": true }, "The sun's direction is computed on Mars alone; for other ground a request over the API brings a table of it.")];
  const set = (key: string, value: string) => {
    const { [key]: _, ...others } = store.state.options.departure;
    change(value === "" ? others : { ...others, [key]: value });
  };
  const time = (key: string, words: string) => {
    const input = h("input", { type: "datetime-local", id: `${id}-${key}`, value: (departure[key] ?? "").slice(0, 16), onchange: () => set(key, input.value && `${input.value.slice(0, 16)}:00Z`) });
    return field(words, input);
  };
  const sol = solOnMap(state);
  const table = skyTable(state);
  return [
    table && h("p", { class: "hint", "data-sky-table": true }, "Sun and Earth come from the table of the request that was opened, which is sent again as it is. ",
      state.terrain?.terrain?.body === "Mars" ? button("Compute them instead", () => store.option({ sky: null }), { class: "quiet", "data-do": "no-sky-table" }) : null),
    state.options.startError ? h("p", { class: "hint" }, `The start of a plan may be wrong by ${state.options.startError.position_m ?? 0} m and ${state.options.startError.heading_deg ?? 0}° (1 sigma), as in the request that was opened. `,
      button("Take it as it is", () => store.option({ startError: null }), { class: "quiet" })) : null,
    time("from", "From (UTC)"),
    time("to", "To (UTC)"),
    sol && button("The sol on the map", () => store.option({ departure: { ...store.state.options.departure, from: minute(sol.from_ms), to: minute(sol.to_ms) } }), { class: "quiet", "data-do": "this-sol" }),
    h("div", { class: "columns" }, ...numbers.map(({ key, words, lowest, highest, usual }) => {
      const input = h("input", { type: "number", id: `${id}-${key}`, step: "any", min: lowest, max: highest, placeholder: usual ?? "not asked", value: departure[key] ?? "", onchange: () => {
        if (input.reportValidity()) set(key, input.value);
      } });
      return field(words, input);
    })),
    time("arrive_by", "Arrived by (UTC)"),
    h("p", { class: "hint" }, "What is left empty is not asked, and nothing of the day as long as From is. Sun and Earth must be over the ground's horizon too."),
  ];
}

const minute = (at_ms: number): string => `${new Date(at_ms).toISOString().slice(0, 16)}:00Z`;
