#include "planner/make_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>
#include <numeric>
#include <optional>
#include <utility>

#include "planner/candidate_drives.h"
#include "planner/judge/advice.h"
#include "planner/judge/displaced_starts.h"
#include "planner/judge/fewer_routes.h"
#include "planner/judge/plan_scout.h"
#include "planner/judge/rank.h"
#include "planner/judge/route_stations.h"
#include "planner/judge/verify_route.h"
#include "planner/problem/terrain_ground.h"
#include "planner/search/bottleneck.h"
#include "planner/search/far_search.h"
#include "planner/search/grid_search.h"
#include "planner/search/only_way.h"
#include "planner/search/plan_faults.h"
#include "planner/search/propose.h"
#include "planner/search/search_window.h"
#include "planner/search/stage_progress.h"
#include "planner/timing/departures.h"

namespace slipway::planner {
namespace {

// Where in the whole work the candidates' simulation begins and ends, and where it ends when routes are
// verified after it.
constexpr double kSimulating = 0.5, kSimulated = 0.98, kSimulatedUnverified = 0.7;

tl::unexpected<Error> cancelled() {
  return fail(ErrorCode::kCancelled, "the plan was cancelled");
}

class Planning {
 public:
  Planning(const PlanProblem& problem, std::span<const PlannerRow> planners, Progress& progress)
      : problem_(problem),
        planners_(planners),
        progress_(progress),
        ground_(problem.terrain, problem.soil_map),
        keep_out_(problem.keep_out, *problem.rover, problem.keep_in),
        drives_(problem_, ground_, keep_out_) {}

  Result<Plan> run() {
    progress_.report("reading the ground", 0.0);
    if (std::optional<Error> error = faults_of(problem_, planners_, keep_out_, ground_))
      return fail(std::move(*error));
    const GroundTables tables = build_ground_tables(problem_, progress_);
    if (progress_.cancelled()) return cancelled();
    open_window(tables);
    if (progress_.cancelled()) return cancelled();
    Plan plan;
    plan.needs_wider_terrain = needs_wider_terrain_;
    if (needs_wider_terrain_) return plan;
    std::optional<Proposal> proposal = propose(tables);
    if (progress_.cancelled()) return cancelled();
    plan.needs_wider_terrain = needs_wider_terrain_;
    if (needs_wider_terrain_) return plan;
    plan.candidates = static_cast<int>(proposal->candidates.size());
    if (proposal->candidates.empty()) {
      say_why_none(*proposal, tables, plan);
      return plan;
    }
    const Result<void> simulated = simulate(*proposal, plan);
    if (!simulated) return fail(simulated.error());
    judge_day_and_start(plan);
    const Result<void> verified = verify(plan);
    if (!verified) return fail(verified.error());
    if (progress_.cancelled()) return cancelled();
    say_why_fewer(*proposal, plan);
    progress_.report("ranking", 0.98);
    mark_pareto_front(plan.routes);
    explain(plan.routes, problem_.ranking);
    plan.scout = scout_of(plan.routes);
    advise_first(plan);
    progress_.report("ranking", 1.0);
    return plan;
  }

 private:
  // Doubles the room around the places until the grid's best ways keep clear of the window's edge or the
  // window is the whole map. Where a window would need larger cells than the finest, the search is one over
  // any distance, in the finest cells of a corridor.
  void open_window(const GroundTables& tables) {
    for (double rooms = 1.0; !progress_.cancelled(); rooms *= 2.0) {
      const dem::Extent extent = search_extent(problem_, rooms);
      if (!in_finest_cells(problem_.terrain->geometry(), extent)) {
        is_far_ = true;
        return;
      }
      map_ = std::make_unique<TraverseMap>(problem_, keep_out_, extent);
      const bool is_whole = covers(*map_, *problem_.terrain);
      // Of the whole terrain it matters only where the map goes on beyond it.
      if (is_whole && problem_.terrain_is_whole_map) return;
      const WindowFit fit = window_fit(problem_, *map_, tables);
      if (fit == WindowFit::kInside) return;
      if (is_whole) {
        needs_wider_terrain_ = true;
        return;
      }
    }
  }

  Proposal propose(const GroundTables& tables) {
    StageProgress stage(progress_, "proposing routes", 0.1, 0.5);
    if (!is_far_)
      return propose_routes(problem_, planners_, *map_, tables, stage, [this](const Candidate& candidate) {
        StageProgress first(progress_, "proposing routes", 0.1, 0.1);
        drives_.look(candidate, first);
      });
    FarProposal far = propose_far_routes(problem_, planners_, keep_out_, tables, stage);
    // What the map has beyond the terrain decides where there is no way, or the best comes to its edge.
    needs_wider_terrain_ = !problem_.terrain_is_whole_map &&
                           (!std::isfinite(far.proposal.grid_optimum) ||
                            (far.map && come_to_edge(problem_, *far.map, far.proposal.grid_ways)));
    map_ = std::move(far.map);
    no_way_ = std::move(far.no_way);
    return std::move(far.proposal);
  }

  void say_why_none(const Proposal& proposal, const GroundTables& tables, Plan& plan) const {
    if (std::isfinite(proposal.grid_optimum)) {
      say_what_planners_met(proposal, plan);
      return;
    }
    if (is_far_) {
      plan.fewer_because = no_way_;
      return;
    }
    const MotionCost cost(problem_, *map_, tables, problem_.weights);
    const std::vector<Waypoint> places = problem_.places();
    const GridSearch grid(cost);
    for (std::size_t leg = 0; leg + 1 < places.size(); ++leg) {
      const Waypoint &from = places[leg], &to = places[leg + 1];
      if (grid.way(grid.cost_to_go(to.x_m, to.y_m), from.x_m, from.y_m).empty()) {
        std::string why = no_way(*map_, from.x_m, from.y_m, to.x_m, to.y_m);
        if (const auto narrowest = bottleneck(problem_, cost, from, to)) why += "; " + *narrowest;
        plan.fewer_because.push_back(std::move(why));
      }
    }
  }

  // There is a way on the grid: a zone is on it, or it is too narrow for motions.
  void say_what_planners_met(const Proposal& proposal, Plan& plan) const {
    std::vector<std::string>& words = plan.fewer_because;
    for (const std::vector<std::size_t>& way : proposal.grid_ways)
      if (auto zone = zone_on_way(problem_, *map_, way)) words.push_back(*std::move(zone));
    if (words.empty())
      words.emplace_back(
          "a way exists on the grid of cells, but no planner found motions of arcs and turns through it");
    if (!proposal.in_keep_out.empty()) words.push_back(dropped_for_keep_outs(problem_, proposal.in_keep_out));
    if (!proposal.closed.empty())
      words.push_back(fmt::format("of {} such routes the first, which {}", proposal.closed.size(),
                                  proposal.closed.front()));
    for (const std::vector<std::size_t>& way : proposal.grid_ways) words.push_back(hardest_place(*map_, way));
  }

  Result<void> simulate(const Proposal& proposal, Plan& plan) {
    const auto wanted = static_cast<std::size_t>(problem_.routes);
    std::vector<std::size_t> list = shortlist(proposal, wanted, !is_long());
    const double end = problem_.verify > 0 ? kSimulatedUnverified : kSimulated;
    const double share = (end - kSimulating) / static_cast<double>(list.size());
    for (std::size_t k = 0; k < list.size(); ++k) {
      StageProgress stage(progress_, fmt::format("simulating route {} of {}", k + 1, list.size()),
                          kSimulating + share * static_cast<double>(k),
                          kSimulating + share * static_cast<double>(k + 1));
      if (auto driven = drives_.drive(proposal.candidates[list[k]], stage); !driven) return driven;
    }
    StageProgress stage(progress_, "comparing routes", end, end);
    while (!is_long() && !drives_.enough()) {
      const auto next = next_candidate(proposal, list);
      if (!next) break;
      list.push_back(*next);
      if (auto driven = drives_.drive(proposal.candidates[*next], stage); !driven) return driven;
    }
    auto routes = drives_.choose(stage);
    if (!routes) return fail(routes.error());
    plan.routes = std::move(*routes);
    return {};
  }

  bool is_long() const {
    const std::vector<double> legs = problem_.leg_lengths_m();
    return std::accumulate(legs.begin(), legs.end(), 0.0) >= kLongDrive_m;
  }

  // When each route may be driven, and what becomes of it from other starts; one that a departure does not
  // allow, or that hangs on its start, is ranked behind the others.
  void judge_day_and_start(Plan& plan) {
    if (!problem_.departure && !problem_.start_error) return;
    const double end = problem_.verify > 0 ? kSimulatedUnverified : kSimulated;
    StageProgress stage(progress_, "looking at its day and its start", end, end);
    for (Route& route : plan.routes) {
      add_departures(problem_, route.prediction, route.decision, stage);
      if (!problem_.start_error) continue;
      route.decision.starts =
          drive_from_displaced_starts(problem_, route.commands, *problem_.start_error, stage);
      if (route.decision.starts) judge_starts(*route.decision.starts, problem_.risk.bars, route.decision);
    }
    rank(plan);
  }

  // Drives the best-ranked routes in the dynamic simulation. A route that it refutes is judged and ranked
  // anew, and what is best then is driven too, until the best one has been.
  Result<void> verify(Plan& plan) {
    if (problem_.verify == 0) return {};
    const std::size_t all = plan.routes.size();
    const std::size_t asked = std::min(all, static_cast<std::size_t>(problem_.verify));
    for (std::size_t i = 0; i < asked; ++i)
      if (auto driven = verify_one(i, plan.routes[i]); !driven) return driven;
    rank(plan);
    for (std::size_t done = asked; done < all && !plan.routes.front().dynamic; ++done) {
      if (auto driven = verify_one(done, plan.routes.front()); !driven) return driven;
      rank(plan);
    }
    return {};
  }

  // A route as the `done`-th that is verified.
  Result<void> verify_one(std::size_t done, Route& route) {
    // Half of what is left for each: nobody knows how many there will be.
    const double left = kSimulated - kSimulatedUnverified;
    const double from = kSimulated - left * std::pow(0.5, static_cast<double>(done));
    StageProgress stage(progress_, fmt::format("verifying by dynamics, route {}", done + 1), from,
                        0.5 * (from + kSimulated));
    const auto motions = command_motions(route.commands.start, route.commands.steps);
    Result<DynamicVerification> verified = verify_route(problem_, motions, {}, route.prediction, stage);
    if (!verified) return fail(verified.error());
    route.dynamic = std::move(*verified);
    judge_anew(route);
    return {};
  }

  // By its draws and its drive in motion, and by what is known of its day and its starts.
  void judge_anew(Route& route) const {
    const DriveVerdict before = std::move(route.decision);
    judge_outcome(problem_, route);
    DriveVerdict& decision = route.decision;
    decision.departures = before.departures;
    decision.starts = before.starts;
    if (decision.departures) judge_departures(*decision.departures, decision);
    if (decision.starts) judge_starts(*decision.starts, problem_.risk.bars, decision);
  }

  // What would make the first route better; only what was tried.
  void advise_first(Plan& plan) const {
    if (plan.routes.empty()) return;
    Route& first = plan.routes.front();
    StageProgress stage(progress_, "ranking", kSimulated, 1.0);
    const auto stations = route_stations(command_motions(first.commands.start, first.commands.steps),
                                         sim::max_station_spacing_m(*problem_.rover));
    advise(
        {other_route(plan.routes), shorter_drive(problem_, stations, first.prediction, first.decision, stage),
         scout_drive(problem_, first.prediction, first.decision)},
        first.prediction.draws, first.decision);
  }

  static void rank(Plan& plan) {
    std::vector<Route> routes;
    for (const std::size_t i : ranked_order(plan.routes)) routes.push_back(std::move(plan.routes[i]));
    plan.routes = std::move(routes);
  }

  // Routes that are NO-GO are not given out beside one that is not; how many of all that were simulated they
  // are, and why the best of them is one, in words. Empty where there are none.
  std::string leave_out_no_go(Plan& plan) const {
    std::size_t left_out = drives_.no_go();
    const Route* best = drives_.best_no_go();
    const auto first = std::stable_partition(plan.routes.begin(), plan.routes.end(),
                                             [](const Route& route) { return !is_no_go(route); });
    if (first == plan.routes.begin()) return {};
    const std::vector<Route> refuted(std::make_move_iterator(first),
                                     std::make_move_iterator(plan.routes.end()));
    plan.routes.erase(first, plan.routes.end());
    left_out += refuted.size();
    if (!refuted.empty()) best = &refuted.front();
    return best == nullptr ? std::string() : left_out_as_no_go(left_out, best->decision.reasons.front());
  }

  void say_why_fewer(const Proposal& proposal, Plan& plan) const {
    std::string no_go = leave_out_no_go(plan);
    if (plan.routes.size() >= static_cast<std::size_t>(problem_.routes)) return;
    const std::size_t all = proposal.candidates.size();
    const std::size_t refused =
        drives_.unpredicted().size() + drives_.in_keep_out().size() + (no_go.empty() ? 0 : drives_.no_go());
    if (!no_go.empty()) plan.fewer_because.push_back(std::move(no_go));
    if (plan.routes.size() + refused < all)
      plan.fewer_because.push_back(too_alike(problem_, all - refused, plan.routes.size()));
    std::vector<Pose2> in_keep_out = proposal.in_keep_out;
    in_keep_out.insert(in_keep_out.end(), drives_.in_keep_out().begin(), drives_.in_keep_out().end());
    if (!in_keep_out.empty()) plan.fewer_because.push_back(dropped_for_keep_outs(problem_, in_keep_out));
    for (std::string& words : unpredicted_in_words(drives_.unpredicted(), all))
      plan.fewer_because.push_back(std::move(words));
    // A corridor knows of no ways beside it.
    const std::size_t best = proposal.by_cost().front();
    if (const auto gap = is_far_ ? std::nullopt : only_way(*map_, proposal.candidates[best].motions))
      plan.fewer_because.push_back(*gap);
    if (plan.fewer_because.empty()) {
      plan.fewer_because.push_back(fmt::format("only {} of the searches found a route", all));
    }
  }

  const PlanProblem& problem_;
  std::span<const PlannerRow> planners_;
  Progress& progress_;
  TerrainGround ground_;
  KeepOut keep_out_;
  std::unique_ptr<TraverseMap> map_;
  bool is_far_ = false;  // the map is of the cells about the candidates alone
  bool needs_wider_terrain_ = false;
  std::vector<std::string> no_way_;  // of a far search
  CandidateDrives drives_;
};

}  // namespace

Result<Plan> make_plan(const PlanProblem& problem, Progress& progress, std::span<const PlannerRow> planners) {
  return Planning(problem, planners, progress).run();
}

}  // namespace slipway::planner
