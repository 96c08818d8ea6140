// A plan while start, goal or a way point is dragged: asked for anew as the drag moves on, so that the first answer is there before it ends.
import { ask, hasEnded, submit } from "./api/client";
import { planRequest, question } from "./panels/request";
import { store } from "./state";
import { report, watch } from "./work";

const apart_ms = 150; // between two plans
const patience_ms = 700; // that a plan has for its first answer before a drag that moves on takes its place

let timer = 0;
let sending = false;
let sent = { job: "", rest: "", at: -Infinity, answered: true };
let settled = true; // the drag has ended

/** Asks for the plan of what is drawn, as soon as it may: `end` says that nothing is being dragged any more. */
export function planSoon(end: boolean): void {
  settled = end;
  clearTimeout(timer);
  const patience = settled || sent.answered ? apart_ms : patience_ms;
  timer = window.setTimeout(() => void send(), Math.max(0, sent.at + patience - performance.now()));
}

async function send(): Promise<void> {
  const request = planRequest();
  const asked = question("plan");
  if (sending || !request || (asked.rest === sent.rest && !store.state.error)) return; // what is being sent is looked at again when it is
  sending = true;
  cancelSent();
  sent = { job: "", rest: asked.rest, at: performance.now(), answered: false };
  try {
    const { job } = await submit("v1/plans", request);
    sent.job = job.id;
    void watch(job, asked, true);
  } catch (error) {
    sent.answered = true;
    report(error);
  }
  sending = false;
  if (question("plan").rest !== asked.rest) planSoon(settled);
}

/** Nobody waits any more for what was asked before. */
function cancelSent(): void {
  const { job } = store.state;
  if (sent.job && job?.id === sent.job && !hasEnded(job)) ask(`v1/jobs/${sent.job}`, { method: "DELETE" }).catch(() => undefined); // it may have ended meanwhile
}

store.on(["job"], ({ job }) => {
  if (!job || job.id !== sent.job || sent.answered || !(job.best_so_far || hasEnded(job))) return;
  sent.answered = true;
  if (question("plan").rest !== sent.rest) planSoon(settled);
});
