// All work that the service knows: reopened, cancelled.
import { getAgain, hasEnded, type Job } from "../api/client";
import { button, fill, h } from "../dom";
import { sentence, words } from "../format";
import { empty, loading, problemView } from "../problem";
import { isAboutRoutes } from "../result";
import { store } from "../state";
import { cancel, keep, reopen } from "../work";
import { jobLine } from "./job_view";

const seconds = 5;

export function jobsPanel(target: HTMLElement): void {
  const list = h("div");
  let timer = 0;
  async function load(): Promise<void> {
    clearTimeout(timer);
    try {
      const { jobs } = await getAgain<{ jobs: Job[] }>("v1/jobs?limit=100");
      store.set({ jobs });
    } catch (error) {
      fill(list, problemView(error, () => void load()));
      return;
    }
    // Only while it is looked at.
    if (store.state.tab === "jobs") timer = window.setTimeout(() => void load(), seconds * 1000);
  }
  store.on(["tab"], ({ tab }) => {
    if (tab === "jobs") void load();
  });
  store.on(["jobs"], ({ jobs }) => {
    if (!jobs) fill(list, loading("Asking for the jobs"));
    else if (jobs.length === 0) fill(list, empty("Nothing has been asked for yet. Plan a drive or check one."));
    else fill(list, h("ul", { class: "plain jobs" }, jobs.map((job) => jobRow(job, () => void load()))));
  });
  fill(target, h("h2", {}, "Jobs"), list);
}

function jobRow(job: Job, again: () => void): HTMLElement {
  const when = new Date(job.created ?? "");
  const running = !hasEnded(job);
  return h(
    "li",
    { class: `job ${job.state}`, "data-job": job.id },
    h("div", { class: "job-head" }, h("strong", {}, sentence(words(job.kind ?? ""))), h("span", { class: `badge ${job.state}` }, jobLine(job))),
    running && h("progress", { max: 1, value: job.progress ?? 0, "aria-label": "Share of the work that is done" }),
    h("small", {}, Number.isNaN(when.getTime()) ? "" : when.toLocaleString("en-GB")),
    job.problem && problemView(`${job.problem.title}: ${job.problem.detail}`),
    h(
      "div",
      { class: "row" },
      (isAboutRoutes(job.kind) || ["diagnosis", "watch"].includes(job.kind) || running) && job.state !== "failed" && job.state !== "dismissed" && button(running ? "Follow" : "Open", () => void reopen(job.id!), { class: "quiet", "data-do": "open" }),
      job.state === "successful" && job.kind === "diagnosis" && button("Report", () => void keep(`v1/jobs/${job.id}/report`, "diagnosis.html"), { class: "quiet" }),
      job.state === "successful" && job.kind === "map" && button("GeoTIFF", () => void keep(`v1/jobs/${job.id}/map.tif`, "map.tif"), { class: "quiet" }),
      running && button("Cancel", () => void cancel(job.id!).then(again), { class: "quiet" }),
    ),
  );
}
