// Where a piece of work is: place in the queue, stage, moving progress, an end.
import type { Job } from "../api/client";
import { hasEnded } from "../api/client";
import { button, fill, h } from "../dom";
import { duration, metres, number, sentence, words } from "../format";
import { problemView } from "../problem";
import { verdictWords } from "../result";
import { store } from "../state";
import { cancel } from "../work";

export function jobLine(job: Job): string {
  if (job.state === "accepted") {
    const queue = job.queue;
    const ahead = queue?.ahead ?? 0;
    const wait = (queue as { estimated_wait_s?: number } | undefined)?.estimated_wait_s;
    return `waits, ${ahead === 0 ? "next in line" : `${ahead} before it`}${wait ? `, likely to begin in ${duration(wait)}` : ""}`;
  }
  if (job.state === "running") return job.stage || "running";
  return { successful: "done", failed: "failed", dismissed: "cancelled" }[job.state as string] ?? String(job.state);
}

/** The best route that a running plan has found until now: dotted on the map. */
function bestSoFar(best: NonNullable<Job["best_so_far"]>): string {
  return `Best so far (dotted): ${metres(best.length_m)}, cost ${number(best.cost)}${best.verdict ? `, ${verdictWords[best.verdict]}` : ""}`;
}

export function jobView(target: HTMLElement): void {
  store.on(["job", "error", "tab"], ({ job, error, tab }) => {
    const parts: HTMLElement[] = [];
    // The list of jobs has it already.
    if (job && job.state !== "successful" && tab !== "jobs") {
      const running = !hasEnded(job);
      parts.push(
        h(
          "div",
          { class: `job ${job.state}` },
          h("div", { class: "job-head" }, h("strong", {}, sentence(words(job.kind ?? ""))), h("span", { role: "status", "data-stage": job.stage }, jobLine(job))),
          running && h("progress", { max: 1, value: job.progress ?? 0, "aria-label": "Share of the work that is done" }),
          running && h("div", { class: "row" }, h("span", {}, `${Math.round(100 * (job.progress ?? 0))} %`), button("Cancel", () => void cancel(job.id!), { class: "quiet", "data-do": "cancel" })),
          running && job.best_so_far ? h("p", { class: "hint", "data-best": true }, bestSoFar(job.best_so_far)) : null,
          job.interrupted && h("p", {}, `The last attempt ended before its time: ${job.interrupted}`),
        ),
      );
    }
    if (error) parts.push(problemView(error));
    fill(target, parts);
  });
}
