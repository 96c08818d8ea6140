#include "planner/judge/rank.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "core/angle.h"
#include "planner/judge/drawn_cost.h"
#include "planner/judge/drive_verdict.h"
#include "planner/problem/weights.h"
#include "planner/search/select_routes.h"

namespace slipway::planner {
namespace {

constexpr double kMin_m = 0.5;  // differences in length below this are not worth words

// "a 14 deg climb", "a 9 deg descent", "a 12 deg side slope", "ground within 2 deg of level".
std::string slope_in_words(const Attitude& attitude) {
  const double climb = -deg_from_rad(attitude.pitch_rad);
  const double side = std::abs(deg_from_rad(attitude.roll_rad));
  if (std::max(std::abs(climb), side) < 2.0) return "ground within 2 deg of level";
  if (side > std::abs(climb)) return fmt::format("a {:.0f} deg side slope", side);
  return climb > 0.0 ? fmt::format("a {:.0f} deg climb", climb) : fmt::format("a {:.0f} deg descent", -climb);
}

std::string largest_slip(const sim::DrivePrediction& drive) {
  const sim::Peak& peak = drive.max_slip_ratio;
  const auto at =
      std::find_if(drive.stations.begin(), drive.stations.end(), [&](const sim::StationPrediction& s) {
        return s.station.distance_m >= peak.distance_m && std::abs(s.state.slip_ratio) >= peak.value - 1e-12;
      });
  if (drive.stations.empty()) return fmt::format("largest slip {:.2f}", peak.value);
  const sim::StationPrediction& station = at == drive.stations.end() ? drive.stations.back() : *at;
  return fmt::format("largest slip {:.2f} at {:.0f} m on {}", peak.value, peak.distance_m,
                     slope_in_words(station.attitude));
}

// "GO: ...", with the reason that decides.
std::string verdict_reason(const Route& route) {
  const std::string_view verdict = verdict_words(describe(route.verdict()));
  return route.decision.reasons.empty() ? std::string(verdict)
                                        : fmt::format("{}: {}", verdict, route.decision.reasons.front());
}

// What the dynamic simulation adds to a route that it does not refute.
std::string confirmation(const Route& route) {
  const DynamicVerification& dynamic = *route.dynamic;
  const sim::Peak &slip = dynamic.extremes.max_slip_ratio, &balanced = route.prediction.max_slip_ratio;
  return fmt::format(
      "driven to its end in the dynamic simulation within every limit: largest slip {:.2f} at {:.0f} m "
      "(balance: "
      "{:.2f} at {:.0f} m), {:.0f} s (balance: {:.0f} s)",
      slip.value, slip.distance_m, balanced.value, balanced.distance_m, dynamic.duration_s,
      route.prediction.duration_s);
}

// 1 in the draws that break a limit.
std::vector<WeightedCost> broken_limits(const Route& route) {
  std::vector<WeightedCost> broken;
  for (const sim::DrawFigures& draw : route.prediction.drawn)
    broken.push_back({draw.breaks_a_limit ? 1.0 : 0.0, draw.weight});
  return broken;
}

// Of the route with the least risk: whether the draws tell its risk from the next one's. Else nothing.
std::string against_the_next_safest(const Route& route, const std::vector<Route>& routes) {
  const Route* next = nullptr;
  for (const Route& other : routes) {
    if (&other == &route || other.prediction.immobilised) continue;
    if (!next || other.prediction.risk < next->prediction.risk) next = &other;
  }
  if (!next || route.prediction.risk >= next->prediction.risk) return {};
  const CostDifference less = difference_of(broken_limits(*next), broken_limits(route), 1.0);
  const std::string risks =
      fmt::format("risk {:.0f} % against {:.0f} % of route {}", 100.0 * route.prediction.risk,
                  100.0 * next->prediction.risk, next->rank);
  if (!less.decided())
    return fmt::format("alike in risk: {}, which {} draws do not tell apart", risks, less.draws);
  return fmt::format("safest: {}, 90 % interval of the difference {:.0f} to {:.0f} %", risks,
                     100.0 * less.low, 100.0 * less.high);
}

// What this route has that no other has; nothing where it stands alone.
std::vector<std::string> superlatives(const Route& route, const std::vector<Route>& routes) {
  std::vector<std::string> words;
  const auto compare = [&](std::string_view name, auto value, auto text) {
    const Route* next = nullptr;
    for (const Route& other : routes) {
      if (&other == &route || other.prediction.immobilised) continue;
      if (!next || value(other) < value(*next)) next = &other;
    }
    if (next && value(route) < value(*next))
      words.push_back(
          fmt::format("{}: {} against {} of route {}", name, text(route), text(*next), next->rank));
  };
  if (route.prediction.immobilised) return words;
  if (std::string safety = against_the_next_safest(route, routes); !safety.empty())
    words.push_back(std::move(safety));
  compare(
      "least slip", [](const Route& r) { return std::round(1000.0 * r.prediction.mean_slip_ratio); },
      [](const Route& r) { return fmt::format("mean {:.3f}", r.prediction.mean_slip_ratio); });
  compare(
      "shortest", [](const Route& r) { return std::round(r.prediction.length_m); },
      [](const Route& r) { return fmt::format("{:.0f} m", r.prediction.length_m); });
  // The energy on ground that is known by a slip curve alone is in no route's figure.
  if (std::any_of(routes.begin(), routes.end(), [](const Route& r) { return r.prediction.by_slip_curve; }))
    return words;
  compare(
      "least energy", [](const Route& r) { return std::round(r.prediction.energy_j / 3600.0); },
      [](const Route& r) { return fmt::format("{:.0f} Wh", r.prediction.energy_j / 3600.0); });
  return words;
}

// An immobilised drive is cheap because it ends early: it comes last, the furthest first.
int group_of(const Route& route) {
  if (route.prediction.immobilised) return 2;
  return route.verdict() == Verdict::kNoGo ? 1 : 0;
}

// Why it does not stand one place higher: the terms in which it is dearer and those that make up for some of
// it.
std::string against_the_one_before(const Route& route, const Route& before, const Ranking& ranking) {
  if (group_of(route) != group_of(before))
    return fmt::format("behind route {} because a limit is broken", before.rank);
  std::string terms;
  for (std::size_t k = 0; k < route.shares.size(); ++k) {
    const double more = route.shares[k].cost - before.shares[k].cost;
    if (std::abs(more) >= 0.005)
      terms += fmt::format("{}{} {:+.2f}", terms.empty() ? "" : ", ", route.shares[k].name, more);
  }
  const bool tied = order_of(before, route, ranking) == RankOrder::kTied;
  return fmt::format(
      "{} route {}: cost {:.2f} against {:.2f}{}{}", tied ? "tied with" : "behind", before.rank, route.cost,
      before.cost,
      route.drawn_costs.empty() ? "" : " " + ranking.in_words(static_cast<int>(route.drawn_costs.size())),
      terms.empty() ? std::string() : " (" + terms + ")");
}

// Why the first route leads.
std::string against_the_second(const Route& route, const Route& next, const Ranking& ranking) {
  if (group_of(route) != group_of(next)) return "best: in route 2 a limit is broken";
  const CostDifference less = ranked_difference(next, route, ranking);
  if (less.draws == 0)
    return fmt::format("best: cost {:.2f} against {:.2f} of route 2", route.cost, next.cost);
  const bool dearer = less.value < 0.0;
  const std::string figures =
      fmt::format("costs {:.2f} {} than route 2 {}, 90 % interval {:.2f} to {:.2f}", std::abs(less.value),
                  dearer ? "more" : "less", ranking.in_words(less.draws), dearer ? -less.high : less.low,
                  dearer ? -less.low : less.high);
  switch (order_of(route, next, ranking)) {
    case RankOrder::kTold:
      return (dearer ? "first: " : "best: ") + figures;
    case RankOrder::kTied:
      return "tied with route 2: " + figures;
    case RankOrder::kUndecided:
      break;
  }
  return "first, which the draws do not decide: " + figures;
}

}  // namespace

void judge(const PlanProblem& problem, Route& route) {
  const sim::DrivePrediction& drive = route.prediction;
  route.cost = 0.0;
  route.shares.clear();
  const DriveFigures figures = figures_of(drive);
  const std::span<const CostTerm> terms = problem.weights.terms();
  for (std::size_t row = 0; row < terms.size(); ++row) {
    CostShare share{.name = std::string(terms[row].name),
                    .value = terms[row].value(figures),
                    .unit = std::string(terms[row].unit)};
    share.weight = problem.weights[row];
    share.cost = share.weight * share.value;
    route.cost += share.cost;
    route.shares.push_back(std::move(share));
  }
  cost_draws(problem, route);
  judge_outcome(problem, route);
}

void judge_outcome(const PlanProblem& problem, Route& route) {
  route.decision =
      judge_drive(problem, route.prediction, {.dynamic = route.dynamic ? &*route.dynamic : nullptr});
}

bool is_no_go(const Route& route) {
  return route.verdict() == Verdict::kNoGo;
}

bool ranks_before(const Route& a, const Route& b) {
  if (group_of(a) != group_of(b)) return group_of(a) < group_of(b);
  if (a.prediction.immobilised) return a.prediction.length_m > b.prediction.length_m;
  return a.cost < b.cost;
}

std::vector<std::size_t> ranked_order(const std::vector<Route>& routes) {
  std::vector<std::size_t> order(routes.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return ranks_before(routes[a], routes[b]); });
  return order;
}

bool dominates(const Route& a, const Route& b) {
  if (a.prediction.immobilised) return false;
  if (b.prediction.immobilised) return true;
  // Part of the energy is not known where the ground is known by a slip curve alone.
  const bool energy_known = !a.prediction.by_slip_curve && !b.prediction.by_slip_curve;
  const auto figures = [energy_known](const Route& route) {
    const sim::DrivePrediction& p = route.prediction;
    return std::array{p.duration_s, energy_known ? p.energy_j : 0.0, p.outcomes.expected_stops,
                      p.outcomes.embedding.share};
  };
  const auto of_a = figures(a), of_b = figures(b);
  bool better = false;
  for (std::size_t k = 0; k < of_a.size(); ++k) {
    if (of_a[k] > of_b[k]) return false;
    better |= of_a[k] < of_b[k];
  }
  return better;
}

void mark_pareto_front(std::vector<Route>& routes) {
  for (Route& route : routes)
    route.pareto = std::none_of(routes.begin(), routes.end(),
                                [&](const Route& other) { return dominates(other, route); });
}

CostDifference ranked_difference(const Route& a, const Route& b, const Ranking& ranking) {
  return difference_of(a.drawn_costs, b.drawn_costs, ranking.ranked_tail());
}

RankOrder order_of(const Route& a, const Route& b, const Ranking& ranking) {
  if (group_of(a) != group_of(b) || a.prediction.immobilised) return RankOrder::kTold;
  const CostDifference difference = ranked_difference(a, b, ranking);
  if (difference.draws == 0 || difference.decided()) return RankOrder::kTold;
  const bool close = std::abs(a.cost - b.cost) <= kTiedShare * std::min(a.cost, b.cost);
  return close ? RankOrder::kTied : RankOrder::kUndecided;
}

void explain(std::vector<Route>& routes, const Ranking& ranking) {
  double shortest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < routes.size(); ++i) {
    routes[i].rank = static_cast<int>(i) + 1;
    if (!routes[i].prediction.immobilised) shortest = std::min(shortest, routes[i].prediction.length_m);
  }
  for (std::size_t i = 0; i < routes.size(); ++i) {
    Route& route = routes[i];
    route.reasons = {verdict_reason(route)};
    if (i > 0) route.reasons.push_back(against_the_one_before(route, routes[i - 1], ranking));
    if (i == 0 && routes.size() > 1) route.reasons.push_back(against_the_second(route, routes[1], ranking));
    if (route.dynamic && route.dynamic->end && !route.dynamic->refutes())
      route.reasons.push_back(confirmation(route));
    for (std::string& words : superlatives(route, routes)) route.reasons.push_back(std::move(words));
    std::string line = largest_slip(route.prediction);
    const double longer = route.prediction.length_m - shortest;
    if (!route.prediction.immobilised && longer >= kMin_m)
      line += fmt::format("; {:.0f} m longer than the shortest", longer);
    route.reasons.push_back(std::move(line));
  }
}

}  // namespace slipway::planner
