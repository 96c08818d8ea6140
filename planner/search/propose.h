#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/progress.h"
#include "planner/problem/motion.h"
#include "planner/problem/problem.h"
#include "planner/search/ground_tables.h"
#include "planner/search/motion_cost.h"
#include "planner/search/planner_catalogue.h"
#include "planner/search/select_routes.h"

namespace slipway::planner {

// Candidates that every plan has by its default set of planners, whatever that is: the straight way from
// place to place, and the grid's cheapest one.
constexpr std::string_view kStraightPlanner = "straight", kGridPlanner = "grid";

// A route that a planner found, before it is simulated.
struct Candidate {
  std::vector<Motion> motions;
  std::string planner;
  std::string profile;
  double cost = 0.0;  // under the request's weights and ranking, by the slip tables
};

struct Proposal {
  std::vector<Candidate> candidates;
  Differences differences;    // of the candidates
  double grid_optimum = 0.0;  // of all legs, under the request's weights; infinite where a leg has no way
  // Where routes that planners found would have taken the body into a keep-out: these are no candidates.
  std::vector<Pose2> in_keep_out = {};
  // Where else routes that planners found are not allowed, in words: these are no candidates either.
  std::vector<std::string> closed = {};
  // The cells of the grid's cheapest way of each leg, under the request's weights.
  std::vector<std::vector<std::size_t>> grid_ways = {};
  // The cheapest first.
  std::vector<std::size_t> by_cost() const;
  // Of these the ones that differ, see select_routes().
  std::vector<std::size_t> different(std::size_t wanted) const;
};

// Is told of the grid's cheapest way and of the straight line, where they can be driven, before other
// planners begin. They are candidates of the proposal too.
using FirstLook = std::function<void(const Candidate&)>;

// Searches each profile with each planner that the problem names (none: the default set of `planners`, the
// grid and the straight line), smoothed under the profile and under what the request asks for, then in rounds
// with the bands around the routes so far made dear, until `problem.routes` routes differ or the rounds are
// used up. In the default set the others are begun where they may gain more over the grid's way than routes
// that are tied differ by (least_cost_of_leg()), or where too few routes differ. Searches run in parallel;
// the outcome doesn't depend on it. Empty candidates where there is no way (then grid_optimum is infinite)
// and where it was cancelled.
Proposal propose_routes(const PlanProblem& problem, std::span<const PlannerRow> planners,
                        const TraverseMap& map, const GroundTables& tables, Progress& progress,
                        const FirstLook& first_look = {});

}  // namespace slipway::planner
