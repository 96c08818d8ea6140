#include "planner/maps/way_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "core/parallel_for.h"
#include "planner/maps/cell_map.h"
#include "planner/maps/map_kind.h"
#include "planner/problem/keep_out.h"
#include "planner/search/grid_search.h"
#include "planner/search/ground_tables.h"
#include "planner/search/metre.h"
#include "planner/search/motion_cost.h"
#include "planner/search/traverse_map.h"

namespace slipway::planner {
namespace {

// What is summed along a way.
struct UsedUp {
  double energy_j = 0.0, hours = 0.0, stops = 0.0;
  bool over_unknown = false;
};

const char* in_words(Passage passage) {
  switch (passage) {
    case Passage::kSteep:
      return "the ground is steeper than the tilt limit";
    case Passage::kRough:
      return "the ground under the body rises above the belly";
    case Passage::kNoData:
      return "elevation is missing near it, or the map ends there";
    default:
      return "it lies in an area that the rover must keep out of, or the soil there holds the rover";
  }
}

// The grid and its search, over all of the problem's terrain.
class Ways {
 public:
  Ways(const PlanProblem& problem, const Waypoint& place, Progress& progress)
      : problem_(with_place(problem, place)),
        keep_out_(problem_.keep_out, *problem_.rover, problem_.keep_in),
        tables_(build_ground_tables(problem_, progress)),
        place_(place) {
    if (progress.cancelled()) return;
    progress.report("reading the ground", 0.1);
    const dem::GridGeometry& terrain = problem_.terrain->geometry();
    map_ = in_finest_cells(terrain, terrain.extent())
               ? std::make_unique<TraverseMap>(problem_, keep_out_, terrain.extent())
               : std::make_unique<TraverseMap>(problem_, keep_out_, kMaxWayCells, progress);
  }

  // Nothing where the rover may stand there.
  std::optional<Error> fault_of_place(const char* pointer) const {
    const long long cell = map_->index_at(place_.x_m, place_.y_m);
    const Passage passage = cell < 0 ? Passage::kNoData : map_->cell(static_cast<std::size_t>(cell)).passage;
    if (is_open(passage)) return std::nullopt;
    return Error{ErrorCode::kInvalidRequest,
                 "No way leads to or from the place.",
                 {{pointer, fmt::format("the rover may not stand at ({}, {}): {}", place_.x_m, place_.y_m,
                                        in_words(passage))}}};
  }

  CostField field(const Weights& weights, bool to_go, const Progress& progress) const {
    const MotionCost cost(problem_, *map_, tables_, weights);
    const GridSearch grid(cost);
    const SpreadEnd end{-1, [&progress] { return progress.cancelled(); }};
    return to_go ? grid.cost_to_go(place_.x_m, place_.y_m, end)
                 : grid.cost_to_come(place_.x_m, place_.y_m, end);
  }

  // What the ways of a field that leads from the place use up, to each cell that has one. Of no use where it
  // was cancelled.
  std::vector<UsedUp> used_up(const CostField& field, const Progress& progress) const {
    // First of each cell's last step, then of its whole way.
    std::vector<UsedUp> sums(map_->cells());
    const auto columns = static_cast<std::size_t>(geometry().columns);
    parallel_for(static_cast<std::size_t>(geometry().rows), problem_.threads, [&](std::size_t row) {
      if (progress.cancelled()) return;
      for (std::size_t i = row * columns; i < (row + 1) * columns; ++i)
        sums[i] = field.step[i] < 0 ? UsedUp{.over_unknown = map_->cell(i).soil == kUnknownSoil}
                                    : edge(cell_before(i, field.step[i]), i, field.step[i]);
    });
    std::vector<char> done(map_->cells(), 0);
    std::vector<std::size_t> chain;
    for (std::size_t i = 0; i < map_->cells() && !progress.cancelled(); ++i) {
      std::size_t at = i;
      for (; done[at] == 0 && field.step[at] >= 0; at = cell_before(at, field.step[at])) chain.push_back(at);
      done[at] = 1;
      for (; !chain.empty(); chain.pop_back()) {
        const UsedUp& from = sums[cell_before(chain.back(), field.step[chain.back()])];
        UsedUp& way = sums[chain.back()];
        way = {from.energy_j + way.energy_j, from.hours + way.hours, from.stops + way.stops,
               from.over_unknown || way.over_unknown};
        done[chain.back()] = 1;
      }
    }
    return sums;
  }

  const dem::GridGeometry& geometry() const { return map_->geometry(); }

 private:
  static PlanProblem with_place(PlanProblem problem, const Waypoint& place) {
    problem.start = problem.goal = place;
    problem.waypoints.clear();
    return problem;
  }

  std::size_t cell_before(std::size_t cell, int step) const {
    return static_cast<std::size_t>(cell_beyond(*map_, map_->place_of(cell), opposite(step)));
  }

  UsedUp metre_in(std::size_t cell, int step) const {
    const GroundCell& ground = map_->cell(cell);
    const double heading = GridSearch::heading_rad(step), c = std::cos(heading), s = std::sin(heading);
    const double uphill = c * ground.gradient_x + s * ground.gradient_y;
    const double leftward = -s * ground.gradient_x + c * ground.gradient_y;
    const bool unknown = ground.soil == kUnknownSoil;
    const GroundTable& table = unknown ? *tables_.unknown : *tables_.known[ground.soil];
    const double limit = table.mean.limit_rad();
    const auto metre = expected_metre(
        problem_, table, unknown, std::clamp(-std::atan(uphill), -limit, limit),
        std::clamp(std::asin(leftward / std::sqrt(1.0 + uphill * uphill + leftward * leftward)), -limit,
                   limit));
    constexpr double kEndless = std::numeric_limits<double>::infinity();
    if (!metre) return {kEndless, kEndless, kEndless, unknown};
    return {metre->figures.energy_j, metre->figures.duration_s / 3600.0, metre->figures.expected_stops,
            unknown};
  }

  UsedUp edge(std::size_t from, std::size_t to, int step) const {
    const GridStep& s = kGridDirections[static_cast<std::size_t>(step)];
    const double half = 0.5 * std::hypot(s.right * geometry().cell_x_m, s.up * geometry().cell_y_m);
    const UsedUp a = metre_in(from, step), b = metre_in(to, step);
    return {half * (a.energy_j + b.energy_j), half * (a.hours + b.hours), half * (a.stops + b.stops),
            a.over_unknown || b.over_unknown};
  }

  PlanProblem problem_;
  KeepOut keep_out_;
  GroundTables tables_;
  Waypoint place_;
  std::unique_ptr<TraverseMap> map_;
};

tl::unexpected<Error> cancelled() {
  return fail(ErrorCode::kCancelled, "the map was given up");
}

double sols_of(const UsedUp& used, double driving_hours_per_sol) {
  return used.hours / driving_hours_per_sol + used.stops;
}

// What a way costs is the share of the budget that it uses up.
Weights weights_of(const PlanProblem& problem, const WayBudget& budget) {
  Weights weights = problem.weights;
  for (std::size_t row = 0; row < weights.terms().size(); ++row) weights[row] = 0.0;
  constexpr double kJoulesOfUnit = 360'000.0;  // of the catalogue's 100 Wh
  if (budget.energy_j) weights.set("energy", kJoulesOfUnit / *budget.energy_j);
  if (budget.sols) {
    weights.set("duration", 1.0 / (budget.driving_hours_per_sol * *budget.sols));
    weights.set("stops", 1.0 / *budget.sols);
  }
  return weights;
}

}  // namespace

Result<WayMap> cost_to_go_map(const PlanProblem& problem, const Waypoint& place, const char* pointer,
                              Progress& progress) {
  const Ways ways(problem, place, progress);
  if (progress.cancelled()) return cancelled();
  if (auto fault = ways.fault_of_place(pointer)) return fail(*std::move(fault));
  progress.report("searching ways", 0.5);
  WayMap map{ways.geometry(), ways.field(problem.weights, true, progress).cost};
  for (float& value : map.values)
    if (!std::isfinite(value)) value = kNoMapValue;
  if (progress.cancelled()) return cancelled();
  return map;
}

Result<WayMap> reachable_map(const PlanProblem& problem, const Waypoint& place, const WayBudget& budget,
                             const char* pointer, Progress& progress) {
  const Ways ways(problem, place, progress);
  if (progress.cancelled()) return cancelled();
  if (auto fault = ways.fault_of_place(pointer)) return fail(*std::move(fault));
  progress.report("searching ways", 0.5);
  const CostField field = ways.field(weights_of(problem, budget), false, progress);
  if (progress.cancelled()) return cancelled();
  progress.report("adding up ways", 0.7);
  const std::vector<UsedUp> used = ways.used_up(field, progress);
  if (progress.cancelled()) return cancelled();
  WayMap map{ways.geometry(), std::vector<float>(used.size(), map_class::kNotReachable)};
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (!std::isfinite(field.cost[i])) continue;
    const bool within = (!budget.energy_j || used[i].energy_j <= *budget.energy_j) &&
                        (!budget.sols || sols_of(used[i], budget.driving_hours_per_sol) <= *budget.sols);
    if (within)
      map.values[i] =
          static_cast<float>(used[i].over_unknown ? map_class::kReachableOverUnknown : map_class::kReachable);
  }
  return map;
}

}  // namespace slipway::planner
