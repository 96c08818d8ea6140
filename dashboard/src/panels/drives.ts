// Campaigns of recorded drives: sent, watched, diagnosed.
import { get, type Campaign } from "../api/client";
import { button, field, fill, h, select } from "../dom";
import { number, roverWords, words } from "../format";
import { empty, loading, problemView } from "../problem";
import { store } from "../state";
import { start } from "../work";
import { diagnosisView } from "./diagnosis";
import { campaignUpload, takesUploads } from "./uploads";
import { watchForm, watchView } from "./watch";

export function drivesPanel(target: HTMLElement): void {
  const list = h("div");
  const sending = h("div");
  const watch = h("div");
  const diagnosis = h("div", { class: "diagnosis" });
  async function load(chosen?: string): Promise<void> {
    fill(list, loading("Asking for the campaigns"));
    try {
      const { campaigns } = await get<{ campaigns: Campaign[] }>("v1/drive-campaigns");
      store.set({ campaigns });
      show(campaigns, chosen);
      if (sending.childElementCount === 0 && (await takesUploads())) campaignUpload(sending, (name) => void load(name));
    } catch (error) {
      fill(list, problemView(error, () => void load()));
    }
  }
  function show(campaigns: Campaign[], chosen?: string): void {
    if (campaigns.length === 0) {
      fill(list, empty("The service has no drives yet."));
      return;
    }
    let name = campaigns.find((c) => c.name === chosen)?.name ?? campaigns[0]!.name;
    const about = h("div");
    const describe = () => fill(about, describeCampaign(campaigns, campaigns.find((c) => c.name === name)!));
    fill(list, field("Campaign", select(campaigns.map((c) => ({ value: c.name, text: campaignTitle(c) })), name, (value) => { name = value; describe(); })), about);
    describe();
  }
  store.on(["tab"], ({ tab, campaigns }) => {
    if (tab === "drives" && campaigns.length === 0) void load();
  });
  watchView(watch);
  diagnosisView(diagnosis);
  fill(target, h("h2", {}, "Recorded drives"), list, sending, h("div", { class: "answers" }, watch, diagnosis));
}

/** One that was sent has a name of the service's making. */
export function campaignTitle(c: Campaign): string {
  return c.sent_at ? `sent ${c.sent_at.slice(0, 16).replace("T", " ")}: ${roverWords(c.rover)}, ${c.drives.length} drives` : words(c.name);
}

function describeCampaign(campaigns: Campaign[], campaign: Campaign): HTMLElement[] {
  const { drives } = campaign;
  return [
    h("p", {}, `${roverWords(campaign.rover)}, ${drives.length} drives, ${number(campaign.gravity_m_s2)} m/s²; believed soil: ${campaign.soils.map(words).join(", ")}.`),
    h("details", {}, h("summary", {}, "Its drives"),
      h("div", { class: "wide short", tabindex: 0, role: "region", "aria-label": "Drives" },
        h("table", {}, h("thead", {}, h("tr", {}, ["Drive", "Ground", "Time, s", "Speed, m/s"].map((t) => h("th", { scope: "col" }, t)))),
          h("tbody", {}, drives.map((d) => h("tr", {}, h("th", { scope: "row" }, d.id), h("td", {}, words(d.terrain)), h("td", {}, number(d.duration_s)), h("td", {}, number(d.speed_m_s)))))))),
    button("Diagnose these drives", () => void start("v1/diagnoses", { campaign: campaign.name }), { class: "primary", "data-do": "diagnose" }),
    h("p", { class: "hint" }, "A diagnosis asks which effects the simulator lacks, and how far off it is. It takes up to a minute or so; other work goes on beside it."),
    watchForm(campaigns, campaign),
    ...(campaign.sent_at ? [appendForm(campaign)] : []),
  ];
}

/** What the rover has driven since: a drive with its telemetry, behind those that were sent. */
function appendForm({ name, drives, terrains }: Campaign): HTMLElement {
  const note = h("div");
  const last = drives.at(-1);
  const id = h("input", { autocomplete: "off", "data-append": "id" });
  const number_of = (value: number | undefined, key: string) => h("input", { type: "number", step: "any", value: value ?? "", "data-append": key });
  const [speed, curvature, duration] = [number_of(last?.speed_m_s, "speed"), number_of(0, "curvature"), number_of(last?.duration_s, "duration")];
  let terrain = last?.terrain ?? terrains[0] ?? "";
  const ground = select(terrains.map((t) => ({ value: t, text: words(t) })), terrain, (value) => (terrain = value));
  const file = h("input", { type: "file", accept: ".csv", "data-append": "csv" });
  const append = async (): Promise<void> => {
    const csv = await file.files?.[0]?.text();
    if (!csv || id.value.trim() === "") {
      fill(note, problemView("A drive needs a name and the file of its telemetry."));
      return;
    }
    fill(note);
    const commanded = { speed_m_s: Number(speed.value), curvature_1_m: Number(curvature.value), turn_in_place: false, duration_s: Number(duration.value) };
    await start("v1/drive-campaigns", { follows: name, drives: [{ id: id.value.trim(), terrain, commanded, csv }] });
  };
  return h("details", {}, h("summary", {}, "Append a drive"),
    h("div", { class: "columns" }, field("Name", id), field("Ground", ground)),
    h("div", { class: "columns" }, field("Commanded speed, m/s", speed), field("Curvature, 1/m", curvature)),
    field("Commanded time, s", duration),
    field("Telemetry (CSV)", file, "Its columns are those of the campaign's other files."),
    note, button("Append", () => void append(), { "data-do": "append" }));
}
