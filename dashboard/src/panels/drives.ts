// Campaigns of drives and what they show that the simulator lacks.
import { get, token, address, type Campaign, type Job } from "../api/client";
import { button, field, fill, h, select } from "../dom";
import { number, words } from "../format";
import { empty, loading, problemView } from "../problem";
import { store } from "../state";
import { keep, start } from "../work";
import { campaignUpload, takesUploads } from "./uploads";

interface DiagnosisAnswer {
  campaign?: string | { name?: string };
  verdict: string;
  reason?: string;
  effects?: { name: string; parameters?: Record<string, number> }[];
}

export function drivesPanel(target: HTMLElement): void {
  const list = h("div");
  const answer = h("div");
  const sending = h("div");
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
    let name = campaigns.find((c) => c.name === chosen)?.name ?? campaigns[0]!.name!;
    const about = h("div");
    const describe = () => {
      const campaign = campaigns.find((c) => c.name === name)!;
      const drives = campaign.drives ?? [];
      fill(
        about,
        h("p", {}, `${words(campaign.rover ?? "")}, ${drives.length} drives, ${number(campaign.gravity_m_s2)} m/s²; believed soil: ${(campaign.soils ?? []).map(words).join(", ")}.`),
        h("div", { class: "wide short", tabindex: 0, role: "region", "aria-label": "Drives" },
          h("table", {}, h("thead", {}, h("tr", {}, ["Drive", "Time, s", "Speed, m/s"].map((t) => h("th", { scope: "col" }, t)))),
            h("tbody", {}, drives.map((d) => h("tr", {}, h("th", { scope: "row" }, d.id), h("td", {}, number(d.duration_s)), h("td", {}, number(d.speed_m_s))))))),
        button("Diagnose these drives", () => void start("v1/diagnoses", { campaign: name }), { class: "primary", "data-do": "diagnose" }),
        h("p", { class: "hint" }, "A diagnosis asks which effects the simulator lacks. It takes minutes; other work goes on beside it."),
      );
    };
    fill(list, field("Campaign", select(campaigns.map((c) => ({ value: c.name!, text: words(c.name!) })), name, (value) => { name = value; describe(); })), about);
    describe();
  }
  store.on(["tab"], ({ tab, campaigns }) => {
    if (tab === "drives" && campaigns.length === 0) void load();
  });
  store.on(["job"], ({ job }) => {
    if (job?.kind === "diagnosis" && job.state === "successful") void showAnswer(job, answer);
  });
  fill(target, h("h2", {}, "Drives"), list, sending, answer);
}

async function showAnswer(job: Job, target: HTMLElement): Promise<void> {
  try {
    const document = await get<DiagnosisAnswer>(`v1/jobs/${job.id}/result`);
    const report = `v1/jobs/${job.id}/report`;
    fill(
      target,
      h("h3", {}, "Diagnosis"),
      h("p", { class: "banner unknown", "data-diagnosis": document.verdict }, words(document.verdict)),
      document.reason ? h("p", {}, document.reason) : null,
      h("ul", {}, (document.effects ?? []).map((effect) => h("li", {}, words(effect.name)))),
      token() ? button("Report", () => void keep(report, "diagnosis.html")) : h("a", { href: address(report), target: "_blank", rel: "noopener" }, "Report with its pictures"),
    );
  } catch (error) {
    fill(target, problemView(error));
  }
}
