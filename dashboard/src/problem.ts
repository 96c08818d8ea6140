// What went wrong, as the service said it: every fault with its place in the request.
import { ServiceError } from "./api/client";
import { button, h } from "./dom";
import { sentence, words } from "./format";

export function problemView(error: unknown, again?: () => void): HTMLElement {
  const service = error instanceof ServiceError ? error : null;
  const problem = service?.problem;
  const title = service?.status === 401 ? "This service asks for a token (401)" : service ? (service.status === 0 ? "The service can't be reached" : `${problem?.title ?? "Refused"} (${service.status})`) : typeof error === "string" ? "This can't be done so" : "Something went wrong in this page";
  const faults = problem?.faults ?? [];
  return h(
    "div",
    { class: "problem", role: "alert" },
    h("strong", {}, title),
    // A single fault is all that the detail says.
    !(faults.length === 1 && faults[0]!.message === problem?.detail) && h("p", {}, service?.status === 401 ? "Sign in with the one that its operator has given you." : service ? (problem?.detail ?? "") : String(error)),
    faults.length > 0 && h("ul", {}, faults.map((fault) => h("li", {}, h("strong", { title: fault.pointer }, placeWords(fault.pointer)), " ", fault.message))),
    service?.retryAfter_s ? h("p", {}, `It asks to wait ${service.retryAfter_s} s.`) : null,
    again && button("Try again", again),
  );
}

/** "/waypoints/0/x_m" is the first way point's x. */
const placeWords = (pointer: string): string => (pointer ? sentence(pointer.split("/").filter(Boolean).map((part) => (/^\d+$/.test(part) ? String(Number(part) + 1) : words(part))).join(" ")) : "The request");

export const loading = (what: string): HTMLElement => h("p", { class: "loading", role: "status" }, `${what} …`);
export const empty = (text: string): HTMLElement => h("p", { class: "empty" }, text);
