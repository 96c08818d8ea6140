// How good the first route of a plan is: on random pairs of places of the shipped terrain, how often it is
// dearer by over 3 % than (a) another route of its own plan, (b) the straight line, (c) the grid's cheapest
// way, each driven as its commands on the same draws; and how many routes a plan has and how often it turns
// in place.
//
//   first_route [pairs [seed]]        45 pairs where nothing is given

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <string>
#include <vector>

#include "bench/gale_site.h"
#include "core/random.h"
#include "planner/judge/deciding_draws.h"
#include "planner/judge/rank.h"
#include "planner/judge/route_commands.h"
#include "planner/make_plan.h"
#include "planner/predict_path.h"
#include "planner/search/leg_setting.h"
#include "planner/search/planner_catalogue.h"

namespace {

using namespace slipway;           // NOLINT: a program, not a header
using namespace slipway::planner;  // NOLINT

constexpr double kDearer = 1.03;
constexpr double kMinApart_m = 25.0, kMaxApart_m = 90.0;

struct Tally {
  int pairs = 0, no_plan = 0, own = 0, line = 0, grid = 0, routes = 0, turns = 0;
};

// A route driven as its commands on so many draws; nothing where it can't be, or is a NO-GO.
std::optional<Route> driven(PlanProblem problem, const DriveSteps& steps, int draws) {
  problem.risk.draws = draws;
  problem.risk.max_draws = 0;
  NoProgress progress;
  auto drive = predict_motions(problem, command_motions(steps.start, steps.steps), progress);
  if (!drive) return std::nullopt;
  Route route;
  route.prediction = std::move(*drive);
  judge(problem, route);
  if (is_no_go(route)) return std::nullopt;
  return route;
}

// The grid's own plan: what it is held against.
std::optional<Route> by_grid(PlanProblem problem, int draws) {
  problem.planners = {"grid"};
  problem.routes = 1;
  NoProgress progress;
  const auto plan = make_plan(problem, progress);
  if (!plan || plan->routes.empty()) return std::nullopt;
  return driven(problem, plan->routes.front().commands, draws);
}

void count(const PlanProblem& problem, Tally& tally, std::string& line) {
  NoProgress progress;
  const auto plan = make_plan(problem, progress);
  if (!plan || plan->routes.empty()) {
    ++tally.no_plan;
    line += " no plan";
    return;
  }
  ++tally.pairs;
  const Route& first = plan->routes.front();
  tally.routes += static_cast<int>(plan->routes.size());
  for (const DriveStep& step : first.commands.steps) tally.turns += step.turn_rad != 0.0 ? 1 : 0;
  line +=
      fmt::format(" {} {} {:.1f} m cost {:.3f}, {} routes", first.planner, describe(first.decision.verdict),
                  first.prediction.length_m, first.cost, plan->routes.size());
  const bool own = std::any_of(plan->routes.begin(), plan->routes.end(),
                               [&](const Route& other) { return first.cost > kDearer * other.cost; });
  tally.own += own ? 1 : 0;
  const int draws = static_cast<int>(first.drawn_costs.size());
  const auto compare = [&](const char* name, const std::optional<Route>& other, int& dearer) {
    if (!other) return;
    const bool is_dearer = first.cost > kDearer * other->cost;
    dearer += is_dearer ? 1 : 0;
    line += fmt::format(", {} {:.3f}{}", name, other->cost, is_dearer ? " CHEAPER" : "");
  };
  std::vector<Motion> straight = straight_way(problem);
  set_down_as_it_leaves(problem.start, straight);
  compare("line", driven(problem, route_commands(problem, straight), draws), tally.line);
  compare("grid", by_grid(problem, draws), tally.grid);
}

}  // namespace

int main(int argc, char** argv) {
  const int wanted = argc > 1 ? std::atoi(argv[1]) : 45;
  const auto seed = static_cast<std::uint64_t>(argc > 2 ? std::atoi(argv[2]) : 1);
  bench::Site site = bench::gale();
  site.problem.risk.draws = kFirstDraws;
  site.problem.risk.max_draws = kMostDraws;
  const auto place = [&](std::uint64_t key) {
    const auto stop =
        static_cast<std::size_t>(random_uniform(key, 0) * static_cast<double>(site.stops.size()));
    const api::Stop& at = site.stops[std::min(stop, site.stops.size() - 1)];
    return Waypoint{at.x_m + 40.0 * (random_uniform(key, 1) - 0.5),
                    at.y_m + 40.0 * (random_uniform(key, 2) - 0.5), std::nullopt};
  };
  Tally tally;
  for (std::uint64_t key = 0; tally.pairs < wanted && key < 4000; ++key) {
    site.problem.start = place(random_key(seed, 2 * key));
    site.problem.goal = place(random_key(seed, 2 * key + 1));
    const double apart = std::hypot(site.problem.goal.x_m - site.problem.start.x_m,
                                    site.problem.goal.y_m - site.problem.start.y_m);
    if (apart < kMinApart_m || apart > kMaxApart_m) continue;
    std::string line = fmt::format("{:2} {:5.1f} m:", tally.pairs + 1, apart);
    count(site.problem, tally, line);
    fmt::print("{}\n", line);
    std::fflush(stdout);
  }
  fmt::print(
      "of {} first routes dearer by over 3 % than another of the plan {}, than the straight line {}, than "
      "the "
      "grid's way {}; {:.1f} routes a plan, {:.1f} turns in place in the first; {} pairs without a plan\n",
      tally.pairs, tally.own, tally.line, tally.grid, static_cast<double>(tally.routes) / tally.pairs,
      static_cast<double>(tally.turns) / tally.pairs, tally.no_plan);
  return 0;
}
