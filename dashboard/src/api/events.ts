// Work that is followed: the service tells every change; where a proxy or a busy service does not let it, it is asked once a second.
import { ask, hasEnded, ServiceError, type Job, type Problem } from "./client";

const first_event_ms = 4000; // a proxy that keeps events back has not passed one on by then

/**
 * Follows a job to its end: the service tells. While others are before it it is asked for, since its place in the queue changes without it.
 * What is lost on the way is asked for again: a restart of the service loses no job.
 */
export async function follow(id: string, seen: (job: Job) => void, signal: AbortSignal): Promise<Job> {
  const told = { id: "" };
  let listens = true;
  let waits = false;
  for (;;) {
    try {
      const job: Job | null = waits || !listens ? await poll(id, seen, signal, listens) : await listen(id, told, seen, signal);
      if (job && hasEnded(job)) return job;
      waits = job === null;
      if (job) continue;
    } catch (error) {
      if (signal.aborted || !(error instanceof ServiceError)) throw error;
      if (error instanceof NoEvents) listens = false;
      else if (error.status !== 0 && error.status < 500) throw error;
    }
    await pause(1000, signal);
  }
}

/** The events can't be had here; the job can. */
class NoEvents extends ServiceError {
  constructor() {
    super(503, { title: "no events", status: 503 } as Problem);
  }
}

/** The job's end, or null where the stream broke off before. */
async function listen(id: string, told: { id: string }, seen: (job: Job) => void, signal: AbortSignal): Promise<Job | null> {
  const stop = new AbortController();
  const abort = () => stop.abort();
  signal.addEventListener("abort", abort);
  const late = setTimeout(abort, first_event_ms);
  try {
    const response = await ask(`v1/jobs/${id}/events`, { signal: stop.signal, headers: { Accept: "text/event-stream", ...(told.id ? { "Last-Event-ID": told.id } : {}) } });
    if (response.status === 204 || !response.body) throw new NoEvents();
    const reader = response.body.pipeThrough(new TextDecoderStream()).getReader();
    let text = "";
    for (;;) {
      const { value, done } = await reader.read();
      if (done) return null;
      text += value;
      for (let end = text.indexOf("\n\n"); end >= 0; end = text.indexOf("\n\n")) {
        const event = readEvent(text.slice(0, end));
        text = text.slice(end + 2);
        if (!event) continue;
        clearTimeout(late);
        told.id = event.id;
        const job = JSON.parse(event.data) as Job;
        seen(job);
        if (hasEnded(job)) return job;
        if (job.state === "accepted" && (job.queue?.ahead ?? 0) > 0) return null;
      }
    }
  } catch (error) {
    if (signal.aborted) throw new DOMException("stopped", "AbortError");
    throw error instanceof ServiceError && error.status === 404 ? error : new NoEvents();
  } finally {
    clearTimeout(late);
    signal.removeEventListener("abort", abort);
    stop.abort();
  }
}

function readEvent(block: string): { id: string; data: string } | null {
  const lines = block.split("\n");
  const of = (name: string) => lines.filter((line) => line.startsWith(`${name}: `)).map((line) => line.slice(name.length + 2));
  const data = of("data").join("\n");
  return data ? { id: of("id").at(-1) ?? "", data } : null;
}

/** A request a second, most of them answered by "not changed": to the job's end, or until it has begun. */
async function poll(id: string, seen: (job: Job) => void, signal: AbortSignal, until_begun: boolean): Promise<Job> {
  let tag = "";
  for (;;) {
    const response = await ask(`v1/jobs/${id}`, { signal, headers: tag ? { "If-None-Match": tag } : {} });
    if (response.status === 304) await response.arrayBuffer();
    else {
      tag = response.headers.get("ETag") ?? "";
      const job = (await response.json()) as Job;
      seen(job);
      if (hasEnded(job) || (until_begun && job.state === "running")) return job;
    }
    await pause(document.hidden ? 3000 : 1000, signal);
  }
}

function pause(ms: number, signal: AbortSignal): Promise<void> {
  return new Promise((resolve, reject) => {
    const stopped = () => {
      clearTimeout(timer);
      reject(new DOMException("stopped", "AbortError"));
    };
    const timer = setTimeout(() => {
      signal.removeEventListener("abort", stopped);
      resolve();
    }, ms);
    if (signal.aborted) stopped();
    else signal.addEventListener("abort", stopped, { once: true });
  });
}
