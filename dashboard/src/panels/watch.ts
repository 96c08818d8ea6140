// A watch over drives in their order: has something changed since healthy ones, at which drive, and what?
import type { Campaign } from "../api/client";
import { button, field, fill, h, select } from "../dom";
import { number, share, words } from "../format";
import { store } from "../state";
import { keep, start } from "../work";

/** The form of a watch of a campaign. */
export function watchForm(campaigns: Campaign[], campaign: Campaign): HTMLElement {
  const others = campaigns.filter((c) => c.name !== campaign.name && c.rover === campaign.rover);
  let reference = "";
  const usual = Math.min(12, Math.max(1, Math.floor((campaign.drives?.length ?? 2) / 2)));
  const learn = h("input", { type: "number", min: 1, max: Math.max(1, (campaign.drives?.length ?? 2) - 1), value: usual });
  const learnField = field("First drives taken as healthy", learn);
  const choice = select([{ value: "", text: "its own first drives" }, ...others.map((c) => ({ value: c.name, text: words(c.name) }))], "", (value) => {
    reference = value;
    learnField.hidden = value !== "";
  });
  const diagnose = h("input", { type: "checkbox", checked: true, "data-watch": "diagnose" });
  const ask = () => void start("v1/watches", { campaign: campaign.name, ...(reference ? { reference } : { learn: Number(learn.value) || usual }), ...(diagnose.checked ? {} : { diagnose: false }) });
  return h("details", {}, h("summary", {}, "Watch these drives for a change"),
    field("Healthy drives", choice, "The watch says, drive after drive, whether something has changed since these, and diagnoses what has."),
    learnField, h("label", { class: "check" }, diagnose, "after an alarm, diagnose what has changed"), button("Watch", ask, { "data-do": "watch" }));
}

export function watchView(target: HTMLElement): void {
  store.on(["followed"], ({ followed }) => {
    if (!followed.watch) {
      fill(target);
      return;
    }
    const { document: w, job } = followed.watch;
    const last = w.drives.at(-1);
    fill(target,
      h("h2", {}, `Watch over ${words(w.campaign)}`),
      w.alarm
        ? h("p", { class: "banner small no_go", "data-alarm": w.alarm.drive, role: "status" }, `ALARM at drive ${w.alarm.drive}`, h("small", {}, `most probably since ${w.alarm.since}: ${w.alarm.delay_drives} drives`))
        : h("p", { class: "banner small unknown", "data-alarm": "", role: "status" }, "no alarm", h("small", {}, !w.drives.some((d) => d.windows !== 0)
          ? "nothing can be said: no drive has a window of use"
          : w.awaits_another ? "the evidence stands above the limit at the last drive: another must confirm it" : "nothing has changed as far as these drives show")),
      h("p", {}, `${w.drives.length} drives against ${w.reference.drives} healthy ones of ${words(w.reference.campaign)}; evidence 10^${number(last?.log10_evidence, 2)} at the last. A false alarm has a probability of ${share(w.alpha)}, however long one watches.`),
      h("h3", {}, w.alarm ? "Shares of the evidence at the alarm" : "Shares of the evidence at the last drive"),
      h("ul", {}, w.causes.filter((c, i) => i === 0 || c.share > 0.01).slice(0, 5).map((c) => h("li", {}, `${words(c.name)} ${share(c.share)}`))),
      h("details", {}, h("summary", {}, "Evidence drive by drive"),
        h("div", { class: "wide short", tabindex: 0, role: "region", "aria-label": "Evidence drive by drive" },
          h("table", {}, h("thead", {}, h("tr", {}, ["Drive", "log10 of the evidence", "Alarm"].map((t) => h("th", { scope: "col" }, t)))),
            h("tbody", {}, w.drives.map((d) => h("tr", { class: d.alarm ? "trips" : "" }, h("th", { scope: "row" }, d.id), h("td", {}, number(d.log10_evidence)), h("td", {}, d.alarm ? "yes" : ""))))))),
      w.alarm && !w.diagnosis && w.reference.campaign !== w.campaign
        ? button("Diagnose what has changed", () => void start("v1/diagnoses", { campaign: w.campaign, reference: w.reference.campaign }), { "data-do": "diagnose-change" })
        : null,
      button("JSON of the watch", () => void keep(`v1/jobs/${job}/result`, "watch.json"), { class: "quiet" }));
  });
}
