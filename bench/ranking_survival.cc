// Whether the best route of a plan stays the best: on pairs of places where Curiosity stopped, the candidates
// of one search are ranked by few draws of the ground, by many, and under other seeds of the draws.
//
//   ranking_survival [pairs [seeds]]        24 pairs and 5 seeds where nothing is given

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <string>
#include <vector>

#include "bench/gale_site.h"
#include "planner/judge/rank.h"
#include "planner/judge/route_stations.h"
#include "planner/problem/terrain_ground.h"
#include "planner/search/propose.h"
#include "planner/search/search_window.h"

namespace {

using namespace slipway;           // NOLINT: a program, not a header
using namespace slipway::planner;  // NOLINT

constexpr int kFew = 24, kFirst = 32, kMany = 300;  // draws; the service's first are kFirst
constexpr std::size_t kCandidates = 6;
constexpr double kMinApart_m = 40.0, kMaxApart_m = 110.0;

// The candidates that differ, with all draws under each seed.
struct Candidates {
  std::vector<std::vector<Route>> by_seed;
};

Candidates candidates_of(PlanProblem problem, int seeds) {
  const KeepOut keep_out(problem.keep_out, *problem.rover);
  const GroundTables tables = build_ground_tables(problem);
  const TraverseMap map(problem, keep_out, search_extent(problem, 2.0));
  NoProgress progress;
  const Proposal proposal = propose_routes(problem, planner_catalogue(), map, tables, progress);
  const TerrainGround ground(problem.terrain, problem.soil_map);
  Candidates found;
  problem.risk.draws = kMany;
  for (int seed = 1; seed <= seeds; ++seed) {
    problem.risk.seed = static_cast<std::uint64_t>(seed);
    std::vector<Route>& routes = found.by_seed.emplace_back();
    for (const std::size_t i : proposal.different(kCandidates)) {
      const auto stations =
          route_stations(proposal.candidates[i].motions, sim::max_station_spacing_m(*problem.rover));
      auto drive = sim::predict_drive(*problem.rover, problem.gravity_m_s2, ground, problem.beliefs, stations,
                                      problem.limits, problem.risk, 0, progress);
      if (!drive || drive->immobilised) continue;
      Route& route = routes.emplace_back();
      route.prediction = std::move(*drive);
      judge(problem, route);
    }
  }
  return found;
}

double cost_of(const Route& route, int draws, const Ranking& ranking) {
  const std::vector<WeightedCost> first(route.drawn_costs.begin(), route.drawn_costs.begin() + draws);
  return conditional_value_at_risk(first, ranking.ranked_tail());
}

std::size_t best_of(const std::vector<Route>& routes, int draws, const Ranking& ranking) {
  std::size_t best = 0;
  for (std::size_t i = 1; i < routes.size(); ++i)
    if (cost_of(routes[i], draws, ranking) < cost_of(routes[best], draws, ranking)) best = i;
  return best;
}

CostDifference difference(const Route& a, const Route& b, int draws, const Ranking& ranking) {
  std::vector<WeightedCost> first(a.drawn_costs.begin(), a.drawn_costs.begin() + draws);
  return difference_of(first, b.drawn_costs, ranking.ranked_tail());
}

// As a plan of the service does it: the first two get more draws until these tell which is first, or call
// them tied.
std::size_t raced(const std::vector<Route>& routes, int most, const Ranking& ranking) {
  std::vector<int> draws(routes.size(), kFirst);
  for (;;) {
    std::vector<std::size_t> order(routes.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto cost = [&](std::size_t i) { return cost_of(routes[i], draws[i], ranking); };
    std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return cost(a) < cost(b); });
    if (order.size() < 2) return order.front();
    const std::size_t a = order[0], b = order[1];
    const int least = std::min(draws[a], draws[b]);
    const bool tied = cost(b) <= 1.03 * cost(a);
    if (tied || least >= most || difference(routes[a], routes[b], least, ranking).decided()) return a;
    draws[a] = draws[b] = std::min(most, 2 * std::max(draws[a], draws[b]));
  }
}

struct Tally {
  int few = 0, race = 0, seeds = 0, told = 0, few_told = 0, all = 0;
};

void count(const Candidates& found, const Ranking& ranking, Tally& tally, std::string& line) {
  const std::vector<Route>& reference = found.by_seed.front();
  const std::size_t best = best_of(reference, kMany, ranking);
  const std::size_t few = best_of(reference, kFew, ranking), race = raced(reference, 272, ranking);
  const std::size_t first = raced(reference, kMany, ranking);
  ++tally.all;
  tally.few += few == best ? 1 : 0;
  tally.race += race == best ? 1 : 0;
  // Where few draws choose another, do they call the two alike?
  tally.few_told +=
      few == best || !difference(reference[best], reference[few], kFew, ranking).decided() ? 1 : 0;
  int same = 0, told = 0;
  for (const std::vector<Route>& routes : found.by_seed) {
    const std::size_t chosen = raced(routes, 272, ranking);
    same += chosen == first ? 1 : 0;
    told += chosen == best || !difference(routes[best], routes[chosen], 272, ranking).decided() ? 1 : 0;
  }
  const int seeds = static_cast<int>(found.by_seed.size());
  tally.seeds += same == seeds ? 1 : 0;
  tally.told += told == seeds ? 1 : 0;
  double gap = 1e300;
  for (std::size_t i = 0; i < reference.size(); ++i)
    if (i != best)
      gap = std::min(gap, cost_of(reference[i], kMany, ranking) - cost_of(reference[best], kMany, ranking));
  line += fmt::format(" | {:8}: best {} at {:7.2f}, next {:+6.2f}; 24 draws {}, race {}, seeds {}/{}",
                      describe(ranking.by), best, cost_of(reference[best], kMany, ranking),
                      reference.size() > 1 ? gap : 0.0, few, race, same, seeds);
}

void print(const char* name, const Tally& t) {
  fmt::print(
      "{}: of {} pairs the best route of {} draws is the best\n"
      "  under the first {} draws                                    {} ({} with those called alike)\n"
      "  under 32 draws, and up to 272 for the first two             {}\n"
      "  under the latter, the same is first with every seed         {} ({} with those not told apart)\n",
      name, t.all, kMany, kFew, t.few, t.few_told, t.race, t.seeds, t.told);
}

}  // namespace

int main(int argc, char** argv) {
  const std::size_t wanted = argc > 1 ? static_cast<std::size_t>(std::atoi(argv[1])) : 24;
  const int seeds = argc > 2 ? std::atoi(argv[2]) : 5;
  bench::Site site = bench::gale();
  Tally by_mean, by_tail;
  std::vector<double> shares(cost_catalogue().size(), 0.0);
  std::size_t pairs = 0;
  for (std::size_t apart = 1; apart < site.stops.size() && pairs < wanted; ++apart) {
    for (std::size_t i = 0; i + apart < site.stops.size() && pairs < wanted; i += apart) {
      const api::Stop &from = site.stops[i], &to = site.stops[i + apart];
      const double length = std::hypot(to.x_m - from.x_m, to.y_m - from.y_m);
      if (length < kMinApart_m || length > kMaxApart_m) continue;
      site.problem.start = {from.x_m, from.y_m, std::nullopt};
      site.problem.goal = {to.x_m, to.y_m, std::nullopt};
      const Candidates found = candidates_of(site.problem, seeds);
      if (found.by_seed.front().size() < 2) continue;
      ++pairs;
      const Route& best = found.by_seed.front()[best_of(found.by_seed.front(), kMany, {})];
      for (std::size_t k = 0; k < shares.size(); ++k) shares[k] += best.shares[k].cost / best.cost;
      std::string line =
          fmt::format("{:2} {:5.1f} m, {} candidates", pairs, length, found.by_seed.front().size());
      count(found, {RankBy::kExpected, 0.1}, by_mean, line);
      count(found, {RankBy::kCvar, 0.1}, by_tail, line);
      fmt::print("{}\n", line);
      std::fflush(stdout);
    }
  }
  print("expected", by_mean);
  print("cvar", by_tail);
  fmt::print("share of the best route's cost, mean over the pairs:");
  for (std::size_t k = 0; k < shares.size(); ++k)
    fmt::print(" {} {:.0f} %", cost_catalogue()[k].name, 100.0 * shares[k] / static_cast<double>(pairs));
  fmt::print("\n");
  return 0;
}
