// The one way to the service: its public API, under the path that the page came from.
import type { components, paths } from "./types";

type Schemas = components["schemas"];
export type Terrain = NonNullable<Schemas["Terrains"]["terrains"]>[number];
export type TerrainDocument = Schemas["TerrainDocument"];
export type Rover = NonNullable<Schemas["Rovers"]["rovers"]>[number];
export type RuleSet = NonNullable<Schemas["Rules"]["rules"]>[number];
export type CostTerm = NonNullable<Schemas["Planners"]["cost_terms"]>[number];
export type Campaign = NonNullable<Schemas["DriveCampaigns"]["campaigns"]>[number];
export type Job = Schemas["Job"];
export type Problem = Schemas["Problem"];
export type Ground = Schemas["Ground"];
export type Effect = NonNullable<Schemas["Effects"]["effects"]>[number];
export type Diagnosis = Schemas["Diagnosis"];
export type Watch = Schemas["Watch"];
export type MapDocument = Schemas["Map"];

/** What the service refused, as it said it; status 0: it was not reached. */
export class ServiceError extends Error {
  constructor(
    readonly status: number,
    readonly problem: Problem,
    readonly retryAfter_s: number | null = null,
  ) {
    super(problem.detail ?? problem.title ?? "refused");
  }
}

// The page lies at PREFIX/dashboard/, the API at PREFIX/.
const base = new URL("../", document.baseURI);
const tokenKey = "slipway-token";
const listeners = new Set<() => void>();

/** Addresses in the service's documents begin with a slash; behind a proxy they lie under its path. */
export function address(path: string): string {
  return new URL(path.replace(/^\//, ""), base).toString();
}

export function token(): string {
  return sessionStorage.getItem(tokenKey) ?? "";
}

export function setToken(value: string): void {
  if (value) sessionStorage.setItem(tokenKey, value);
  else sessionStorage.removeItem(tokenKey);
}

/** Called where the service wants a token, or another one. */
export function onUnauthorized(listener: () => void): void {
  listeners.add(listener);
}

export async function ask(path: string, init: RequestInit = {}): Promise<Response> {
  const headers = new Headers(init.headers);
  if (token()) headers.set("Authorization", `Bearer ${token()}`);
  let response: Response;
  try {
    response = await fetch(address(path), { ...init, headers });
  } catch (error) {
    if (error instanceof DOMException && error.name === "AbortError") throw error;
    throw new ServiceError(0, { title: "not reached", status: 0, detail: "It may be restarting. What is shown stays, and jobs that it has accepted are kept." } as Problem);
  }
  if (response.ok || response.status === 304) return response;
  const retry = Number(response.headers.get("Retry-After") ?? NaN);
  const problem = await problemOf(response);
  if (response.status === 401) for (const listener of listeners) listener();
  throw new ServiceError(response.status, problem, Number.isFinite(retry) ? retry : null);
}

async function problemOf(response: Response): Promise<Problem> {
  try {
    return (await response.json()) as Problem;
  } catch {
    return { title: response.statusText, status: response.status, detail: `The answer was ${response.status} without a reason.` } as Problem;
  }
}

export async function get<T>(path: string, signal?: AbortSignal): Promise<T> {
  return (await (await ask(path, signal ? { signal } : {})).json()) as T;
}

const kept = new Map<string, { tag: string; document: unknown }>();

/** What is asked for again and again: read anew only where it has changed. */
export async function getAgain<T>(path: string): Promise<T> {
  const known = kept.get(path);
  const response = await ask(path, known ? { headers: { "If-None-Match": known.tag } } : {});
  if (response.status === 304 && known) return known.document as T;
  const document = (await response.json()) as T;
  const tag = response.headers.get("ETag");
  if (tag) kept.set(path, { tag, document });
  return document;
}

export type PlanRequest = Schemas["PlanRequest"];
export type CheckRequest = Schemas["CheckRequest"];
export type MapRequest = Schemas["MapRequest"];
export type Limits = Schemas["DriveLimits"];

/** What the API document says is sent to each address that work is asked of. */
type Sent = { [P in keyof paths as paths[P]["post"] extends { requestBody: { content: { "application/json": unknown } } } ? (P extends `/${infer Name}` ? Name : never) : never]: NonNullable<paths[P]["post"]> extends { requestBody: { content: { "application/json": infer Body } } } ? Body : never };
export type Asked = "v1/plans" | "v1/checks" | "v1/maps" | "v1/diagnoses" | "v1/watches" | "v1/terrains" | "v1/drive-campaigns";
export type RequestOf<P extends Asked> = Sent[P];

export interface Submitted {
  id: string;
  job: Job;
}

/** Asks for work; the answer is the job. */
export async function submit<P extends Asked>(path: P, request: RequestOf<P>): Promise<Submitted> {
  const response = await ask(path, {
    method: "POST",
    headers: { "Content-Type": "application/json", Prefer: "respond-async", "Idempotency-Key": crypto.randomUUID?.() ?? String(Math.random()) },
    body: JSON.stringify(request),
  });
  const job = (await response.json()) as Job;
  return { id: job.id, job };
}

const ended = ["successful", "failed", "dismissed"];
export const hasEnded = (job: Job): boolean => ended.includes(job.state);

/** The request as a command that gives the same job. */
export function asCurl(path: string, request: unknown): string {
  const json = JSON.stringify(request).replaceAll("'", "'\\''");
  const header = token() ? ` -H "Authorization: Bearer $SLIPWAY_TOKEN"` : "";
  return `curl -s ${address(path)}${header} -H 'Content-Type: application/json' -H 'Prefer: wait=30' -d '${json}'`;
}
