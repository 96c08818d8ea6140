// One piece of work at a time: asked for, followed, shown.
import { ask, get, hasEnded, ServiceError, submit, type Asked, type CheckRequest, type Job, type PlanRequest, type RequestOf } from "./api/client";
import { follow } from "./api/events";
import { openDiagnosis, openWatch } from "./followed";
import { formOf, planRequest, question, skyOf, type Question } from "./panels/request";
import { isAboutRoutes, readResult, roverOf, type Result } from "./result";
import { store, type Place, type Ring } from "./state";

/** What was asked for becomes what is drawn and what the form has. */
function takeRequest({ request, rover: driven }: Result): void {
  const asked = request as Partial<PlanRequest & CheckRequest>;
  const place = (p: Place | undefined): Place | null => (p ? { x_m: p.x_m, y_m: p.y_m } : null);
  const { drawn, options, rovers, costTerms } = store.state;
  const usual = (term: string) => costTerms.find((t) => t.name === term)?.weight?.initial;
  const rover = roverOf({ rover: driven }, rovers)?.name ?? options.rover;
  store.set({
    tool: "look",
    drawn: { ...drawn, start: place(asked.start) ?? drawn.start, goal: place(asked.goal) ?? drawn.goal, waypoints: asked.waypoints ?? drawn.waypoints, path: asked.path ?? drawn.path, keep_out: (asked.keep_out as Ring[] | undefined) ?? [], keep_in: (asked.keep_in as Ring[] | undefined) ?? [] },
    options: {
      ...options,
      rover,
      effects: (asked.effects ?? []).map((e) => ({ name: e.name, on: e.on ?? true, parameters: e.parameters ?? {} })),
      failedWheels: asked.failed_wheels ?? {},
      confidence: asked.confidence ?? null,
      unknownSoil: asked.unknown_soil ?? "",
      draws: asked.draws ?? null,
      departure: formOf(asked.departure),
      sky: skyOf({ terrain: asked.terrain ?? "", departure: asked.departure }),
      startError: asked.start_error ?? null,
      legend: asked.legend ?? options.legend,
      routes: asked.routes ?? options.routes,
      seed: asked.seed ?? options.seed,
      weights: asked.weights ? Object.fromEntries(Object.entries(asked.weights).filter(([term, weight]) => weight !== usual(term))) : options.weights,
      model: asked.model ? { diagnosis: asked.model.diagnosis, campaign: options.model?.diagnosis === asked.model.diagnosis ? options.model.campaign : "", rover, ground: asked.model.ground ?? [] } : null,
    },
  });
}

let following: AbortController | null = null;

/** Asks for work and follows it; what goes wrong is in the state. */
export async function start<P extends Asked>(path: P, request: RequestOf<P>): Promise<void> {
  const { result, other, options } = store.state;
  // A plan with a corrected model stands beside the one that was made without it.
  const beside = path === "v1/plans" && options.model !== null && result?.kind === "plan" && !("model" in result.request) && result.terrain === store.state.terrain?.terrain?.name;
  store.set({ error: null, other: beside ? result : other });
  const asked = question(path === "v1/plans" ? "plan" : "check");
  try {
    const { job } = await submit(path, request);
    await watch(job, asked);
  } catch (error) {
    report(error);
  }
}

/** Asks for the plan of what is drawn, if that is enough for one. */
export function planNow(): void {
  const request = planRequest();
  if (request) void start("v1/plans", request);
}

/** Follows a job and shows its answer, which is one to what the form asked. */
export async function watch(job: Job, asked: Question, quiet = false): Promise<void> {
  following?.abort();
  const mine = (following = new AbortController());
  store.set({ job, error: null });
  try {
    const end = hasEnded(job) ? job : await follow(job.id, (seen) => store.set({ job: seen }), mine.signal);
    if (mine.signal.aborted) return;
    store.set({ job: end });
    if (end.state === "failed" && end.problem) throw new ServiceError(end.problem.status ?? 500, end.problem);
    if (end.state === "successful" && isAboutRoutes(end.kind)) {
      const result = await readResult(end, asked, quiet);
      if (mine.signal.aborted) return;
      const route = store.state.route < result.routes.length ? store.state.route : 0;
      store.set({ result, route, compared: null, hover_m: null });
    }
    if (end.state === "successful" && end.kind === "diagnosis") await openDiagnosis(end);
    if (end.state === "successful" && end.kind === "watch") await openWatch(end);
  } catch (error) {
    report(error);
  }
}

/** Shows a job's answer again, with what was asked for in the form. */
export async function reopen(id: string): Promise<void> {
  try {
    const job = await get<Job>(`v1/jobs/${id}`);
    if (isAboutRoutes(job.kind)) store.set({ tab: job.kind === "plan" ? "plan" : "check" });
    else if (job.kind === "diagnosis" || job.kind === "watch") store.set({ tab: "drives" });
    await watch(job, question(job.kind));
    const { result } = store.state;
    if (result?.job !== id) return;
    takeRequest(result);
    store.set({ result: { ...result, asked: question(result.kind) } });
  } catch (error) {
    report(error);
  }
}

export async function cancel(id: string): Promise<void> {
  try {
    const job = (await (await ask(`v1/jobs/${id}`, { method: "DELETE" })).json()) as Job;
    if (store.state.job?.id === id) {
      following?.abort();
      store.set({ job });
    }
  } catch (error) {
    report(error);
  }
}

export function report(error: unknown): void {
  if (error instanceof DOMException && error.name === "AbortError") return;
  store.set({ error });
}

/** All stations of an answer as one table, however many pages the service keeps them in. */
export async function keepStations(job: string, name: string): Promise<void> {
  try {
    let text = "";
    for (let page = 1, more = true; more; ++page) {
      const response = await ask(`v1/jobs/${job}/stations?page=${page}`);
      text += await response.text();
      more = /rel="next"/.test(response.headers.get("Link") ?? "");
    }
    keepBlob(new Blob([text], { type: "text/csv" }), name);
  } catch (error) {
    report(error);
  }
}

function keepBlob(blob: Blob, name: string): void {
  const url = URL.createObjectURL(blob);
  const link = document.createElement("a");
  link.href = url;
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(url), 10_000);
}

/** A page or a table of a job's, opened or kept as a file: a token can't go with a link. */
export async function keep(path: string, name: string, accept?: string): Promise<void> {
  try {
    const response = await ask(path, accept ? { headers: { Accept: accept } } : {});
    keepBlob(await response.blob(), name);
  } catch (error) {
    report(error);
  }
}
