// What recorded drives show that the simulator lacks: verdict, ladder, effects, where, and the way back to planning.
import { address, token, type Diagnosis, type TerrainDocument } from "../api/client";
import { button, field, fill, h, select, swatch } from "../dom";
import { number, roverWords, sentence, share, words } from "../format";
import { gapLabels } from "../map/gap_layer";
import { store, type Rung, type State } from "../state";
import { keep } from "../work";

type Value = { value: number; interval_90?: number[] };
type ChannelGap = Diagnosis["gap"]["channels"][number];
type Regime = Diagnosis["where"]["regimes"][number];

export const rungs: [keyof ChannelGap & string, string][] = [
  ["nominal", "as believed before"],
  ["retuned", "re-tuned"],
  ["with_effects", "with the effects"],
  ["with_discrepancy", "with discrepancy"],
  ["noise_floor", "floor of the noise"],
];

const verdictText: Record<Diagnosis["verdict"], string> = {
  no_gap: "no gap",
  not_detected: "no gap detected",
  parameters: "parameters were off, no effect is missing",
  effects: "effects are missing",
  effect_set: "something is missing; several explanations are alike",
  unknown: "something is missing that no known effect explains",
  insufficient: "too few drives or channels to say",
};

const interval = (v: Value | undefined): string => (v ? `${number(v.value)}${v.interval_90 ? ` (${number(v.interval_90[0])} to ${number(v.interval_90[1])})` : ""}` : "–");

function bar(share_of: number, from?: number, to?: number): HTMLElement {
  const filled = h("span", { class: "fill" });
  filled.style.width = `${Math.min(100, Math.max(0, 100 * share_of))}%`;
  const range = from !== undefined && to !== undefined ? h("span", { class: "range" }) : null;
  if (range) {
    range.style.left = `${Math.min(100, Math.max(0, 100 * from!))}%`;
    range.style.width = `${Math.max(0, 100 * (Math.min(to!, 1) - from!))}%`;
  }
  return h("span", { class: "bar", "aria-hidden": "true" }, filled, range);
}

const table = (label: string, head: string[], rows: (Node | string)[][]): HTMLElement =>
  h("div", { class: "wide", tabindex: 0, role: "region", "aria-label": label },
    h("table", {}, h("thead", {}, h("tr", {}, head.map((t) => h("th", { scope: "col" }, t)))), h("tbody", {}, rows.map(([first, ...rest]) => h("tr", {}, h("th", { scope: "row" }, first), rest.map((cell) => h("td", {}, cell)))))));

/** Of each channel how far prediction is off on drives that no fit had seen, rung by rung. */
function ladder(d: Diagnosis): HTMLElement {
  const rows = d.gap.channels.flatMap((channel) => {
    const values = rungs.map(([key, title]) => ({ title, key, v: channel[key] as Value | undefined })).filter((r) => r.v);
    const most = Math.max(...values.map((r) => r.v!.interval_90?.[1] ?? r.v!.value));
    return values.map(({ title, key, v }, i) =>
      h("tr", { class: i === 0 ? "first" : "", "data-rung": key },
        i === 0 ? h("th", { scope: "rowgroup", rowspan: values.length }, words(channel.channel), channel.unit === "1" ? null : h("small", {}, channel.unit), channel.closed_fraction ? h("small", {}, `closed ${share(channel.closed_fraction.value)}`) : null) : null,
        h("td", {}, title), h("td", { class: "bar-cell" }, bar(v!.value / most, (v!.interval_90?.[0] ?? v!.value) / most, (v!.interval_90?.[1] ?? v!.value) / most)), h("td", {}, number(v!.value), v!.interval_90 ? h("small", {}, `${number(v!.interval_90[0], 2)} to ${number(v!.interval_90[1], 2)}`) : null)));
  });
  return h("div", { class: "wide", tabindex: 0, role: "region", "aria-label": "How far the gap closes" },
    h("table", { class: "ladder" }, h("thead", {}, h("tr", {}, ["Channel", "Model", "Prediction less measurement, rms", "90 %"].map((t) => h("th", { scope: "col" }, t)))), h("tbody", {}, rows)));
}

function marginals(d: Diagnosis): HTMLElement {
  const shown = d.marginals.filter((m, i) => i < 5 || m.probability > 0.01 || m.closed_share > 0.05);
  return h("div", {},
    table("Effects and their probabilities", ["Effect", "", "Probability", "Closes of the gap"], shown.map((m) => [words(m.name), bar(m.probability), probability(m.probability), share(m.closed_share)])),
    d.marginals.length > shown.length ? h("p", { class: "hint" }, `${d.marginals.length - shown.length} other effects are below 1 % and close below 5 %.`) : "");
}

const probability = (p: number): string => (p > 0.995 ? "> 0.99" : p < 0.005 ? "< 0.01" : p.toFixed(2));

const variableWords: Record<string, string> = { slope_deg: "slope, deg", temperature_c: "motors' temperature, °C", slip: "slip", pitch_deg: "pitch, deg", roll_deg: "roll, deg", speed_m_s: "speed, m/s" };

function condition(regime: Regime): string {
  return regime.condition
    .map(({ variable, from, to }) => {
      const name = variableWords[variable] ?? words(variable);
      if (from === undefined) return `${name} below ${number(to)}`;
      return to === undefined ? `${name} above ${number(from)}` : `${name} ${number(from)} to ${number(to)}`;
    })
    .join(" and ");
}

function where(d: Diagnosis): (HTMLElement | null)[] {
  const { regimes_of_effect: of_effect, regimes_retuned: of_rest, regimes } = d.where;
  const shown = of_effect.length > 0 ? of_effect : of_rest.length > 0 ? of_rest : regimes;
  const of = of_effect.length > 0 ? "What the effects do" : of_rest.length > 0 ? "What re-tuning leaves" : "The gap before re-tuning";
  const significant = d.where.channels.filter((c) => (c.significance ?? 1) < 0.05);
  return [
    shown.length > 0 ? h("p", {}, `${of} lies most in:`) : h("p", {}, "No condition holds more of the gap than its share."),
    shown.length > 0 ? h("ul", {}, shown.map((r) => h("li", {}, `${words(r.channel)}: ${condition(r)} – ${share(r.share_of_gap)} of it in ${share(r.share_of_data)} of the drives (p ${number(r.significance, 2)})`))) : null,
    significant.length > 0
      ? h("details", {}, h("summary", {}, `Channels that are off (${significant.length})`),
          table("Channels that are off", ["Channel", "Off by (rms)", "Scatter makes", "Measured less predicted"], significant.map((c) => [`${words(c.channel)}${c.wheel ? `, ${c.wheel}` : ""}`, `${number(c.gap)}${c.unit === "1" ? "" : ` ${c.unit}`}`, number(c.noise), number(c.bias)])))
      : null,
  ];
}

/** Which rung, ground and drive the map and the charts show. */
function mapControls(state: State): HTMLElement {
  const { followed, palette, terrains: known } = state;
  const { document: d } = followed.diagnosis!;
  const { windows } = d.where;
  const terrains = [...new Set(windows.map((w) => w.terrain))];
  const drives = [...new Set(windows.filter((w) => w.terrain === followed.terrain).map((w) => w.drive))];
  const choices: [Rung, string][] = [["nominal", "as believed"], ["retuned", "re-tuned"], ["with_effects", "with effects"]];
  const ground = select(terrains.map((t) => ({ value: t, text: words(t) })), followed.terrain, (terrain) => store.follow({ terrain, drive: "", window: null }));
  const drive = select([{ value: "", text: "all" }, ...drives.map((name) => ({ value: name, text: name }))], followed.drive, (value) => store.follow({ drive: value, window: null }));
  ground.id = "gap-ground";
  drive.id = "gap-drive";
  const pointed = followed.window === null ? undefined : windows[followed.window];
  return h("details", { open: true }, h("summary", {}, "Map of the gap"),
    h("div", { class: "row wrap", role: "group", "aria-label": "Which model the map of the gap is of" }, choices.map(([value, text]) => h("button", { type: "button", class: "chip", "data-rung": value, "aria-pressed": String(followed.rung === value), onclick: () => store.follow({ rung: value }) }, text))),
    h("div", { class: "columns" }, field("Ground", ground), field("Drive", drive)),
    h("p", { class: "hint" }, "Prediction less measurement where it was driven, in deviations of the noise; 1 is as well as can be."),
    h("ul", { class: "legend" }, gapLabels.map((text, k) => h("li", {}, swatch(palette[k]!, k >= 3 ? "square" : "round"), text))),
    h("p", { class: "hint" }, pointed ? `Drive ${pointed.drive}, ${number(pointed.start_s)} s: ${number(pointed[followed.rung])} deviations.` : known.some((t) => t.name === followed.terrain) ? "A click on a mark chooses its drive." : `The service has no map of ${words(followed.terrain)}: the drives lie on empty ground. A click on a mark chooses its drive.`));
}

/** Which windows are shown, beside the map that shows them. */
export function gapControls(target: HTMLElement): void {
  store.on(["followed", "palette", "tab", "terrains"], (state) => {
    const active = document.activeElement?.id;
    const shown = state.tab === "drives" && state.followed.diagnosis !== null && state.followed.terrain !== "";
    fill(target, shown ? mapControls(state) : null);
    if (active?.startsWith("gap-")) document.getElementById(active)?.focus();
  });
}

const modelVerdicts = new Set(["parameters", "effects", "effect_set", "unknown"]);

/** The way back to planning: whose rover it is, and which ground of the terrain is the campaign's. */
function replan(job: string, d: Diagnosis): HTMLElement {
  if (!d.model) return h("p", { class: "hint" }, modelVerdicts.has(d.verdict) ? "No corrected model is offered: it would not predict drives held out better." : "There is nothing to correct, so that no corrected model is offered.");
  const { nominal, campaign } = d.model;
  const box = h("div", { class: "replan" });
  const show = (terrain: TerrainDocument | null) => {
    const soil = terrain?.terrain?.soil;
    const legend = soil?.other_legends?.find((l) => l.name === store.state.options.legend)?.legend ?? soil?.legend ?? [];
    const known = [...new Set(legend.map((entry) => entry.soil).filter((s): s is string => !!s))];
    const same = known.some((s) => nominal.soils.includes(s));
    const boxes = known.map((name) => ({ name, box: h("input", { type: "checkbox", value: name, "data-ground": name }) }));
    const may_choose = nominal.soils.length === 1 && !same;
    fill(box,
      h("h3", {}, "Plan with what was found"),
      h("p", {}, `The corrected rover (${roverWords(nominal.rover)}) drives, and ground that the campaign called ${nominal.soils.map(words).join(", ")} is the corrected one.`),
      may_choose && known.length === 0 ? h("p", { class: "hint" }, `${terrain?.terrain?.title ?? "The terrain"} has no map of soils, so that the rover and its motors alone are corrected: choose another terrain above for its ground.`) : null,
      may_choose && known.length > 0 ? h("fieldset", {}, h("legend", {}, `Which ground of ${terrain?.terrain?.title ?? "the terrain"} is that ground?`), boxes.map((b) => h("label", { class: "check" }, b.box, words(b.name))), h("p", { class: "hint" }, "None: only the rover and its motors are corrected.")) : null,
      button("Plan with the corrected model", () => {
        store.option({ rover: nominal.rover, model: { diagnosis: job, campaign, rover: nominal.rover, ground: boxes.filter((b) => b.box.checked).map((b) => b.name) } });
        store.set({ tab: "plan" });
      }, { class: "primary", "data-do": "replan" }));
  };
  show(store.state.terrain);
  return box;
}

function details(d: Diagnosis): HTMLElement[] {
  const fields = (effect: string) => store.state.effects.find((e) => e.name === effect)?.parameters ?? [];
  const found = d.effects.map((e) => h("li", {}, `${words(e.name)} (probability ${probability(e.probability)})`,
    h("ul", {}, Object.entries(e.parameters).map(([name, v]) => {
      const field = fields(e.name).find((p) => p.name === name);
      return h("li", {}, `${field?.summary ?? words(name)}: ${interval(v)}${field?.unit && field.unit !== "1" ? ` ${field.unit}` : ""}`);
    }))));
  return [
    ...(found.length > 0 ? [h("ul", { class: "found" }, found)] : []),
    ...(d.residual.length > 0 ? [h("p", {}, `Left over: ${d.residual.map((r) => r.text ?? `${words(r.entry)} that depends on ${words(r.variable)}`).join("; ")}.`)] : []),
  ];
}

function more(d: Diagnosis): HTMLElement[] {
  const parts: HTMLElement[] = [];
  parts.push(h("details", {}, h("summary", {}, "Explanations that were compared"), table("Explanations", ["Explanation", "Probability"], d.candidates.slice(0, 8).map((c) => [c.effects.length > 0 ? c.effects.map(words).join(" and ") : "nothing is missing", probability(c.probability)]))));
  parts.push(h("details", {}, h("summary", {}, "What was re-tuned"), table("Re-tuned parameters", ["Parameter", "Re-tuned (90 %)", "Believed within"], d.retuned.map((r) => [words(r.name), `${interval(r)}${r.determined ? "" : ", hardly told"}`, `± ${number(r.prior_std)}`]))));
  if ((d.measurements ?? []).length > 0) parts.push(h("details", {}, h("summary", {}, "What to measure, to see effects that re-tuning hides"), h("ul", {}, d.measurements.map((m) => h("li", {}, `${words(m.effect)}: ${m.measure.join("; ")} (shows by ${number(m.deviations_then, 2)} deviations then, ${number(m.deviations_now, 2)} now)`)))));
  if (d.look_alikes.length > 0) parts.push(h("details", {}, h("summary", {}, "What these drives can't tell apart"), h("ul", {}, d.look_alikes.map((l) => h("li", {}, `${words(l.effect)} looks like ${l.like === "parameters" ? `re-tuned ${(l.parameters ?? []).map(words).join(", ")}` : words(l.like)} (${number(l.angle_deg, 2)}°)`)))));
  if (d.next_drives.length > 0) parts.push(h("details", {}, h("summary", {}, "Drives that would tell most"), table("Next drives", ["Tilt", "Heading", "Speed", "Motors", "Bits"], d.next_drives.map((n) => [`${number(n.tilt_deg)}°`, `${number(n.heading_deg)}°`, `${number(n.speed_m_s)} m/s`, `${number(n.motor_temp_c)} °C`, number(n.expected_information_bits)]))));
  else if (d.verdict !== "insufficient") parts.push(h("p", { "data-of": "next_drives" }, "No further drive on a plane is expected to tell much more."));
  if (d.notes.length > 0) parts.push(h("details", {}, h("summary", {}, "Notes"), h("ul", {}, d.notes.map((n) => h("li", {}, n)))));
  return parts;
}

/** What was found, in a sentence that can be read out. */
export function leadOf(d: Diagnosis): string {
  const named = d.effects.map((e) => store.state.effects.find((one) => one.name === e.name)?.summary ?? words(e.name));
  const closed = d.gap.channels.filter((c) => c.closed_fraction).sort((a, b) => b.closed_fraction!.value - a.closed_fraction!.value)[0];
  const closes = closed ? ` With ${named.length > 1 ? "them" : "it"}, ${share(closed.closed_fraction!.value)} of the gap in ${words(closed.channel)} closes on drives that no fit had seen.` : "";
  const drives = `Drives of ${words(d.campaign)}`;
  switch (d.verdict) {
    case "effects":
      return `The simulator leaves out what these drives show: ${named.join("; ")}.${closes}`;
    case "effect_set":
      return `These drives show something that the simulator leaves out, but not which of ${d.candidates.length > 1 ? "several explanations" : "its explanations"} is right.`;
    case "parameters":
      return "The simulator has all that these drives show: some of its numbers were off, and are told below.";
    case "unknown":
      return "These drives show something that no effect known to the simulator explains.";
    case "insufficient":
      return `${drives} are too few, or measured too little, to say what the simulator lacks.`;
    default:
      return `${drives} went as the simulator predicts: nothing is missing that they could show.`;
  }
}

/** Draws the diagnosis that is followed. */
export function diagnosisView(target: HTMLElement): void {
  let drawn = "";
  store.on(["followed", "terrain"], (state) => {
    const { diagnosis } = state.followed;
    if (!diagnosis) {
      fill(target);
      drawn = "";
      return;
    }
    const now = `${diagnosis.job}/${state.terrain?.terrain?.name}`;
    if (drawn === now) return;
    drawn = now;
    const { document: d, job } = diagnosis;
    const report = `v1/jobs/${job}/report`;
    fill(target,
      h("h2", {}, `Diagnosis of ${words(d.campaign)}`),
      h("p", { class: "lead", "data-lead": true }, leadOf(d)),
      h("p", { class: "banner small unknown", "data-diagnosis": d.verdict }, verdictText[d.verdict]),
      h("p", {}, `${sentence(words(d.reason))}.`), h("p", { class: "hint" }, `What would change it: ${words(d.overturned_by)}.`),
      ...details(d),
      h("h3", {}, "How far the gap closes"), h("p", { class: "hint" }, "On drives that no fit had seen: shorter is better. The floor is what sensors and the drives' own scatter make."), ladder(d),
      h("h3", {}, "Which effects"), marginals(d),
      h("h3", {}, "Where"), ...where(d),
      replan(job, d),
      ...more(d),
      h("div", { class: "row wrap" },
        state.followed.watch?.job !== job ? (token() ? button("Report", () => void keep(report, "diagnosis.html"), { class: "quiet" }) : h("a", { href: address(report), target: "_blank", rel: "noopener" }, "Report with its pictures")) : null,
        button("JSON", () => void keep(`v1/jobs/${job}/result`, "diagnosis.json"), { class: "quiet" })));
  });
}
