// What recorded drives showed, taken up from the jobs that found it.
import { get, type Diagnosis, type Job, type Watch } from "./api/client";
import { store } from "./state";

/** The ground with the largest gap is shown first. */
function shown(d: Diagnosis) {
  const windows = [...d.where.windows].sort((a, b) => (b.nominal ?? 0) - (a.nominal ?? 0));
  return { rung: "nominal" as const, terrain: windows[0]?.terrain ?? "", drive: "", window: null };
}

export async function openDiagnosis(job: Job): Promise<void> {
  const document = await get<Diagnosis>(`v1/jobs/${job.id}/result`);
  store.follow({ watch: null, diagnosis: { job: job.id, document }, ...shown(document) });
}

/** With the diagnosis that followed its alarm. */
export async function openWatch(job: Job): Promise<void> {
  const document = await get<Watch>(`v1/jobs/${job.id}/result`);
  const { diagnosis } = document;
  store.follow({ watch: { job: job.id, document }, ...(diagnosis ? { diagnosis: { job: job.id, document: diagnosis }, ...shown(diagnosis) } : { diagnosis: null, terrain: "", drive: "", window: null }) });
}
