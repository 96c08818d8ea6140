#include "planner/search/proposer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/angle.h"
#include "planner/search/bottleneck.h"
#include "planner/search/leg_setting.h"
#include "planner/search/overlap.h"
#include "planner/search/profile.h"
#include "planner/search/smooth_route.h"
#include "planner/search/tell_found.h"

namespace slipway::planner {
namespace {

constexpr double kLineSpacing_m = 0.25;

}  // namespace

void Way::add(const std::vector<Motion>& leg) {
  found = !leg.empty();
  if (!found) return;
  motions.insert(motions.end(), leg.begin(), leg.end());
  at = motions.back().to;
}

Proposer::Proposer(const PlanProblem& problem, const TraverseMap& map, const GroundTables& tables,
                   Progress& progress)
    : problem_(problem),
      map_(map),
      tables_(tables),
      progress_(progress),
      cancelled_([&progress] { return progress.cancelled(); }),
      places_(problem.places()),
      asked_(problem, map, tables, problem.weights, problem.ranking.ranked_tail()),
      proposal_{.candidates = {}, .differences = Differences(problem.rover->body_width_m)} {}

void Proposer::propose() {
  std::vector<Guide> guides = guides_of_profiles();
  search(guides, 0);
  for (int round = 1; round <= kMaxRounds && found_any() && !enough() && !progress_.cancelled(); ++round) {
    guides.clear();
    guides.push_back({"apart_from_the_others", asked_, penalties(std::pow(2.0, round - 1))});
    search(guides, round);
  }
}

std::vector<Guide> Proposer::guides_of_profiles() const {
  std::vector<Guide> guides;
  for (const Profile& profile : profiles(problem_.ranking)) {
    const bool is_asked = profile.changed.empty() && !profile.by_mean;
    const double tail = profile.by_mean ? 1.0 : problem_.ranking.ranked_tail();
    guides.push_back(
        {std::string(profile.name),
         is_asked ? asked_ : MotionCost(problem_, map_, tables_, profile.weights(problem_.weights), tail),
         penalties(0.0)});
  }
  return guides;
}

std::vector<Eigen::Vector2d> Proposer::places_of_bands(double spacing_m, double reach_m) const {
  std::vector<Eigen::Vector2d> places;
  for (const std::size_t chosen : proposal_.different(wanted()))
    for (const Eigen::Vector2d& place : centreline(proposal_.candidates[chosen].motions, spacing_m))
      if (!is_near_place(places_, place, reach_m)) places.push_back(place);
  return places;
}

void Proposer::keep(const MotionCost& asked, Candidate found) {
  std::vector<Candidate>& candidates = proposal_.candidates;
  found.cost = fine_cost(asked, found.motions);
  if (std::isfinite(found.cost)) {
    if (tells_unjudged_ && std::none_of(candidates.begin(), candidates.end(),
                                        [&](const Candidate& other) { return other.cost <= found.cost; }))
      tell_found(progress_, found.motions, found.cost);
    proposal_.differences.add(centreline(found.motions, kLineSpacing_m));
    candidates.push_back(std::move(found));
  } else if (found.planner == kStraightPlanner) {
    return;  // nobody found it: it is there whatever lies on it
  } else if (const auto pose = first_hit(asked.map().keep_out(), found.motions)) {
    proposal_.in_keep_out.push_back(*pose);
  } else if (const auto closed = first_closed(problem_, asked, found.motions)) {
    proposal_.closed.push_back(fmt::format("{} found is closed at {}", found.planner, *closed));
  }
}

Candidate Proposer::route(std::vector<Motion> motions, std::string_view planner,
                          std::string_view profile) const {
  set_down_as_it_leaves(problem_.start, motions);
  return {std::move(motions), std::string(planner), std::string(profile)};
}

Candidate Proposer::straight_line() const {
  return route(straight_way(problem_), kStraightPlanner, kStraightPlanner);
}

Pose2 Proposer::first_pose(const TraverseMap& map, const PoseSampler& sampler) const {
  const Waypoint& start = problem_.start;
  const auto cell = static_cast<std::size_t>(map.index_at(start.x_m, start.y_m));
  return {start.x_m, start.y_m, wrapped_rad(start.yaw_rad.value_or(sampler.flow_rad(cell)))};
}

}  // namespace slipway::planner
