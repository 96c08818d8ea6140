#include "planner/make_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <utility>

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
#include "planner/search/overlap.h"
#include "planner/search/plan_faults.h"
#include "planner/search/propose.h"
#include "planner/search/search_window.h"
#include "planner/search/stage_progress.h"
#include "planner/search/tell_found.h"

namespace slipway::planner {
namespace {

constexpr std::size_t kMaxSimulated = 6;  // unless more routes are asked for
// Where in the whole work the candidates' simulation begins and ends, and where it ends when routes are
// verified after it.
constexpr double kSimulating = 0.5, kSimulated = 0.98, kSimulatedUnverified = 0.7;
constexpr double kLineSpacing_m = 0.25;
// Of routes that compete for the first place: three times the first draws halve the interval nearly.
constexpr int kContenderDraws = 96;
// Stations times draws of one route beyond the first draws: a drive of 5 km gets 30 draws, one of 12 km the
// first alone. What these don't decide they leave open.
constexpr double kMaxStationDraws = 300'000.0;
// First draws of a route over a kilometre and more.
constexpr int kFirstLongDraws = 16;
// A candidate that shares more of its length than this with one that is simulated anyway adds nothing.
constexpr double kSameRoute = 0.9;

tl::unexpected<Error> cancelled() {
  return fail(ErrorCode::kCancelled, "the plan was cancelled");
}

// The candidates to simulate: those that differ, then the cheapest others that are no copies of these.
std::vector<std::size_t> shortlist(const Proposal& proposal, std::size_t wanted, bool with_spare) {
  const std::vector<std::size_t> order = proposal.by_cost();
  std::vector<std::size_t> list = select_routes(proposal.differences, order, wanted);
  const std::size_t most = std::max(kMaxSimulated, wanted);
  if (!with_spare && list.size() == wanted) return list;
  const std::size_t spare = wanted > list.size() ? most : std::min(most, list.size() + 1);
  for (const std::size_t i : order) {
    const bool copy = std::any_of(list.begin(), list.end(), [&](std::size_t other) {
      return other == i || proposal.differences.shared(i, other) > kSameRoute;
    });
    if (!copy && list.size() < spare) list.push_back(i);
  }
  return list;
}

class Planning {
 public:
  Planning(const PlanProblem& problem, std::span<const PlannerRow> planners, Progress& progress)
      : problem_(problem),
        planners_(planners),
        progress_(progress),
        ground_(problem.terrain, problem.soil_map),
        keep_out_(problem.keep_out, *problem.rover, problem.keep_in) {}

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
    const Result<void> verified = verify(*proposal, plan);
    if (!verified) return fail(verified.error());
    progress_.report("ranking", 0.98);
    mark_pareto_front(plan.routes);
    explain(plan.routes, problem_.ranking);
    plan.scout = scout_of(plan.routes);
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
    if (!is_far_) return propose_routes(problem_, planners_, *map_, tables, stage);
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
      plan.fewer_because.emplace_back(
          "a way exists on the grid of cells, but no planner found motions of arcs and turns through it");
      if (!proposal.in_keep_out.empty())
        plan.fewer_because.push_back(dropped_for_keep_outs(problem_, proposal.in_keep_out));
      if (!proposal.closed.empty())
        plan.fewer_because.push_back(fmt::format("of {} such routes the first, which {}",
                                                 proposal.closed.size(), proposal.closed.front()));
      for (const std::vector<std::size_t>& way : proposal.grid_ways)
        plan.fewer_because.push_back(hardest_place(*map_, way));
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

  Result<void> simulate(const Proposal& proposal, Plan& plan) {
    const std::vector<std::size_t> list =
        shortlist(proposal, static_cast<std::size_t>(problem_.routes), !is_long());
    std::vector<Route> routes;
    std::vector<std::size_t> candidate_of;
    Differences differences(problem_.rover->body_width_m);
    std::vector<Error> unpredicted;
    std::vector<Pose2> in_keep_out = proposal.in_keep_out;
    for (std::size_t k = 0; k < list.size(); ++k) {
      const Candidate& candidate = proposal.candidates[list[k]];
      const double end = problem_.verify > 0 ? kSimulatedUnverified : kSimulated;
      const double share = (end - kSimulating) / static_cast<double>(list.size());
      StageProgress stage(progress_, fmt::format("simulating route {} of {}", k + 1, list.size()),
                          kSimulating + share * static_cast<double>(k),
                          kSimulating + share * static_cast<double>(k + 1));
      const auto stations = stations_of(candidate);
      if (const auto pose = inside_keep_out(candidate.motions, stations)) {
        in_keep_out.push_back(*pose);
        continue;
      }
      Result<sim::DrivePrediction> drive = predict(list[k], stations, first_draws(), stage);
      if (progress_.cancelled()) return cancelled();
      if (!drive) {
        // Mostly a wheel that the body's circle does not cover met a missing cell.
        unpredicted.push_back(drive.error());
        continue;
      }
      Route route;
      route.planner = candidate.planner;
      route.profile = candidate.profile;
      route.prediction = std::move(*drive);
      judge(problem_, route);
      differences.add(centreline(candidate.motions, kLineSpacing_m));
      if (std::none_of(routes.begin(), routes.end(),
                       [&](const Route& other) { return ranks_before(other, route); }))
        tell_found(progress_, candidate.motions, route.ranked_cost, describe(route.verdict()));
      routes.push_back(std::move(route));
      candidate_of.push_back(list[k]);
    }
    if (auto drawn = draw_contenders(proposal, candidate_of, routes); !drawn) return drawn;
    choose(std::move(routes), candidate_of, differences, plan);
    if (auto drawn = draw_until_decided(proposal, plan); !drawn) return drawn;
    if (plan.routes.size() < static_cast<std::size_t>(problem_.routes))
      say_why_fewer(proposal, unpredicted, in_keep_out, list.front(), plan);
    return {};
  }

  std::vector<sim::PathStation> stations_of(const Candidate& candidate) const {
    return route_stations(candidate.motions, sim::max_station_spacing_m(*problem_.rover));
  }

  bool is_long() const {
    const std::vector<Waypoint> places = problem_.places();
    double length = 0.0;
    for (std::size_t i = 1; i < places.size(); ++i)
      length += std::hypot(places[i].x_m - places[i - 1].x_m, places[i].y_m - places[i - 1].y_m);
    return length >= kLongDrive_m;
  }

  // As many as are asked for; of a long drive that may have more later, fewer.
  int first_draws() const {
    const bool may_have_more = problem_.deciding_draws > problem_.risk.draws;
    return may_have_more && is_long() ? std::min(kFirstLongDraws, problem_.risk.draws) : problem_.risk.draws;
  }

  // Goes on from the candidate's draws so far.
  Result<sim::DrivePrediction> predict(std::size_t candidate, const std::vector<sim::PathStation>& stations,
                                       int draws, Progress& progress) {
    sim::RiskOptions risk = problem_.risk;
    risk.draws = draws;
    if (risk.segment_m <= 0.0 && is_long()) risk.segment_m = kSegment_m;
    return sim::predict_drive(*problem_.rover, problem_.gravity_m_s2, ground_, problem_.beliefs, stations,
                              problem_.limits, risk, problem_.threads, progress, problem_.conditions,
                              &drawn_[candidate]);
  }

  // The first draws rank the candidates. The best one, and the next of those that they do not tell from it,
  // as many as routes are asked for, get kContenderDraws: the first are the same ground again, for all of
  // them.
  Result<void> draw_contenders(const Proposal& proposal, const std::vector<std::size_t>& candidate_of,
                               std::vector<Route>& routes) {
    if (problem_.deciding_draws <= problem_.risk.draws || routes.size() < 2) return {};
    std::vector<std::size_t> contenders = ranked_order(routes, problem_.ranking);
    const Route& best = routes[contenders.front()];
    contenders.erase(
        std::remove_if(contenders.begin() + 1, contenders.end(),
                       [&](std::size_t i) { return clearly_apart(best, routes[i], problem_.ranking); }),
        contenders.end());
    if (contenders.size() < 2) return {};
    contenders.resize(std::min(contenders.size(), 1 + static_cast<std::size_t>(problem_.routes)));
    for (const std::size_t i : contenders)
      if (auto drawn = draw_more(proposal, candidate_of[i],
                                 std::min(kContenderDraws, problem_.deciding_draws), routes[i]);
          !drawn)
        return drawn;
    return {};
  }

  // The routes that are given out get as many draws as their verdicts need.
  Result<void> draw_until_decided(const Proposal& proposal, Plan& plan) {
    if (problem_.deciding_draws <= problem_.risk.draws) return {};
    for (std::size_t i = 0; i < plan.routes.size(); ++i) {
      if (problem_.risk.bars.decide(plan.routes[i].prediction.outcomes)) continue;
      if (auto drawn = draw_more(proposal, chosen_[i], problem_.deciding_draws, plan.routes[i]); !drawn)
        return drawn;
    }
    rank(plan);
    return {};
  }

  Result<void> draw_more(const Proposal& proposal, std::size_t candidate, int draws, Route& route) {
    if (is_long())
      draws = std::min(draws, static_cast<int>(kMaxStationDraws /
                                               static_cast<double>(route.prediction.stations.size() + 1)));
    if (route.prediction.draws >= draws) return {};
    StageProgress stage(progress_, "comparing routes", kSimulated, kSimulated);
    Result<sim::DrivePrediction> drive =
        predict(candidate, stations_of(proposal.candidates[candidate]), draws, stage);
    if (progress_.cancelled()) return cancelled();
    if (!drive) return fail(drive.error());
    route.prediction = std::move(*drive);
    judge(problem_, route);
    return {};
  }

  // What is given out is tested itself, whatever the search has tested: every station, and all that the body
  // sweeps between them.
  std::optional<Pose2> inside_keep_out(const std::vector<Motion>& motions,
                                       const std::vector<sim::PathStation>& stations) const {
    if (keep_out_.empty()) return std::nullopt;
    for (const sim::PathStation& station : stations)
      if (keep_out_.hits(station.pose)) return station.pose;
    return first_hit(keep_out_, motions);
  }

  void choose(std::vector<Route> routes, const std::vector<std::size_t>& candidate_of,
              const Differences& differences, Plan& plan) {
    const std::vector<std::size_t> order = ranked_order(routes, problem_.ranking);
    for (const std::size_t i : select_routes(differences, order, static_cast<std::size_t>(problem_.routes))) {
      plan.routes.push_back(std::move(routes[i]));
      chosen_.push_back(candidate_of[i]);
    }
  }

  // Drives the best-ranked routes in the dynamic simulation. A route that it refutes is judged and ranked
  // anew, and what is best then is driven too, until the best one has been.
  Result<void> verify(const Proposal& proposal, Plan& plan) {
    if (problem_.verify == 0) return {};
    const std::size_t all = plan.routes.size();
    const std::size_t asked = std::min(all, static_cast<std::size_t>(problem_.verify));
    for (std::size_t i = 0; i < asked; ++i)
      if (auto driven = verify_one(proposal, i, i, plan.routes[i]); !driven) return driven;
    rank(plan);
    for (std::size_t done = asked; done < all && !plan.routes.front().dynamic; ++done) {
      if (auto driven = verify_one(proposal, 0, done, plan.routes.front()); !driven) return driven;
      rank(plan);
    }
    return {};
  }

  // The route at a place of the present order, as the `done`-th that is verified.
  Result<void> verify_one(const Proposal& proposal, std::size_t place, std::size_t done, Route& route) {
    // Half of what is left for each: nobody knows how many there will be.
    const double left = kSimulated - kSimulatedUnverified;
    const double from = kSimulated - left * std::pow(0.5, static_cast<double>(done));
    StageProgress stage(progress_, fmt::format("verifying by dynamics, route {}", done + 1), from,
                        0.5 * (from + kSimulated));
    Result<DynamicVerification> verified =
        verify_route(problem_, proposal.candidates[chosen_[place]].motions, {}, route.prediction, stage);
    if (!verified) return fail(verified.error());
    route.dynamic = std::move(*verified);
    judge(problem_, route);
    return {};
  }

  // Orders the routes, and the candidates behind them with them.
  void rank(Plan& plan) {
    const std::vector<std::size_t> order = ranked_order(plan.routes, problem_.ranking);
    std::vector<Route> routes;
    std::vector<std::size_t> chosen;
    for (const std::size_t i : order) {
      routes.push_back(std::move(plan.routes[i]));
      chosen.push_back(chosen_[i]);
    }
    plan.routes = std::move(routes);
    chosen_ = std::move(chosen);
  }

  void say_why_fewer(const Proposal& proposal, const std::vector<Error>& unpredicted,
                     const std::vector<Pose2>& in_keep_out, std::size_t best, Plan& plan) const {
    const std::size_t all = proposal.candidates.size();
    const std::size_t refused = unpredicted.size() + in_keep_out.size() - proposal.in_keep_out.size();
    if (plan.routes.size() + refused < all)
      plan.fewer_because.push_back(too_alike(problem_, all - refused, plan.routes.size()));
    if (!in_keep_out.empty()) plan.fewer_because.push_back(dropped_for_keep_outs(problem_, in_keep_out));
    for (std::string& words : unpredicted_in_words(unpredicted, all))
      plan.fewer_because.push_back(std::move(words));
    // A corridor knows of no ways beside it.
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
  std::vector<std::string> no_way_;               // of a far search
  std::map<std::size_t, sim::DrawsSoFar> drawn_;  // by candidate
  std::vector<std::size_t> chosen_;  // the candidate behind each of the plan's routes, in their order
};

}  // namespace

Result<Plan> make_plan(const PlanProblem& problem, Progress& progress, std::span<const PlannerRow> planners) {
  return Planning(problem, planners, progress).run();
}

}  // namespace slipway::planner
