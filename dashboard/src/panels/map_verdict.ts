// The verdict on the map, where the eyes are while something is dragged: of what is asked, or pale where it is of what was asked before.
import { hasEnded } from "../api/client";
import { fill, h } from "../dom";
import { metres, share } from "../format";
import { isAboutRoutes, verdictWords } from "../result";
import { store } from "../state";

export function mapVerdict(target: HTMLElement): void {
  store.on(["job", "result", "route", "stale", "tab"], ({ job, result, route: index, stale, tab }) => {
    const asking = job && isAboutRoutes(job.kind) && !hasEnded(job);
    const best = asking && job.state === "running" ? job.best_so_far : undefined;
    const route = result?.routes[index];
    const belongs = tab === "plan" ? result?.kind === "plan" : tab === "check" && result !== null && result.kind !== "plan";
    target.className = "map-verdict";
    if (best) {
      target.classList.add(best.verdict ?? "open");
      fill(target, h("strong", { "data-first": best.verdict ?? "" }, best.verdict ? verdictWords[best.verdict] : "First way"), h("span", {}, `${metres(best.length_m)}, ${best.verdict ? "first answer" : "not judged yet"}; the whole follows`));
    } else if (asking) {
      target.classList.add("asking");
      fill(target, h("span", {}, "Asking …"));
    } else if (belongs && result) {
      if (stale) target.classList.add("asking");
      else target.classList.add(route?.verdict ?? "no_go");
      const verdict = route ? verdictWords[route.verdict] : "NO ROUTE";
      fill(target, h("strong", { "data-on-map": stale ? "" : (route?.verdict ?? "none") }, stale ? `${verdict} before` : verdict), h("span", {}, stale === "all" ? "asked differently since" : stale === "limits" ? "by the limits as asked" : route ? `a halt in ${share(route.outcomes.stop.value)}` : ""));
    } else fill(target);
  });
}
