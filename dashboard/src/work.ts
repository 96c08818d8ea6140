// One piece of work at a time: asked for, followed, shown.
import { ask, follow, get, hasEnded, ServiceError, submit, type Job } from "./api/client";
import { isAboutRoutes, readResult, type Result } from "./result";
import { store, type Place, type Ring } from "./state";

/** What was asked for becomes what is drawn. */
function takeRequest({ request, rover }: Result): void {
  const asked = request as { start?: Place; goal?: Place; waypoints?: Place[]; path?: Place[]; keep_out?: Ring[]; keep_in?: Ring[] };
  const place = (p: Place | undefined): Place | null => (p ? { x_m: p.x_m, y_m: p.y_m } : null);
  const { drawn, options } = store.state;
  store.set({
    drawn: { ...drawn, start: place(asked.start) ?? drawn.start, goal: place(asked.goal) ?? drawn.goal, waypoints: asked.waypoints ?? drawn.waypoints, path: asked.path ?? drawn.path, keep_out: asked.keep_out ?? [], keep_in: asked.keep_in ?? [] },
    options: { ...options, rover: rover || options.rover },
  });
}

let following: AbortController | null = null;

/** Asks for work and follows it; what goes wrong is in the state. */
export async function start(path: string, request: unknown): Promise<void> {
  store.set({ error: null });
  try {
    const { job } = await submit(path, request);
    await watch(job);
  } catch (error) {
    report(error);
  }
}

/** Follows a job and shows its answer. */
export async function watch(job: Job): Promise<void> {
  following?.abort();
  const mine = (following = new AbortController());
  store.set({ job, error: null });
  try {
    const end = hasEnded(job) ? job : await follow(job.id, (seen) => store.set({ job: seen }), mine.signal);
    if (mine.signal.aborted) return;
    store.set({ job: end });
    if (end.state === "failed" && end.problem) throw new ServiceError(end.problem.status ?? 500, end.problem);
    if (end.state === "successful" && isAboutRoutes(end.kind)) {
      const result = await readResult(end);
      const route = store.state.route < result.routes.length ? store.state.route : 0;
      store.set({ result, route, compared: null, hover_m: null });
    }
  } catch (error) {
    report(error);
  }
}

/** Shows a job's answer again, with what was asked for in the form. */
export async function reopen(id: string): Promise<void> {
  try {
    const job = await get<Job>(`v1/jobs/${id}`);
    if (isAboutRoutes(job.kind ?? "")) store.set({ tab: job.kind === "plan" ? "plan" : "check" });
    await watch(job);
    const result = store.state.result;
    if (result?.job === id) takeRequest(result);
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

/** A page or a table of a job's, opened or kept as a file: a token can't go with a link. */
export async function keep(path: string, name: string, accept?: string): Promise<void> {
  try {
    const response = await ask(path, accept ? { headers: { Accept: accept } } : {});
    const url = URL.createObjectURL(await response.blob());
    const link = document.createElement("a");
    link.href = url;
    link.download = name;
    link.click();
    setTimeout(() => URL.revokeObjectURL(url), 10_000);
  } catch (error) {
    report(error);
  }
}
