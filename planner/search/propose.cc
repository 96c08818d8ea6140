#include "planner/search/propose.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>
#include <optional>

#include "core/angle.h"
#include "core/parallel_for.h"
#include "core/random.h"
#include "planner/search/bottleneck.h"
#include "planner/search/corridor_cells.h"
#include "planner/search/grid_search.h"
#include "planner/search/leg_search.h"
#include "planner/search/leg_setting.h"
#include "planner/search/overlap.h"
#include "planner/search/planner_catalogue.h"
#include "planner/search/pose_sampler.h"
#include "planner/search/profile.h"
#include "planner/search/smooth_route.h"
#include "planner/search/tell_found.h"

namespace slipway::planner {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kMaxRounds = 4;
constexpr double kBandWidths = 2.0;  // half width of the band around a route, in rover widths
constexpr double kBandFactor = 1.0;  // the first round's extra cost in the band; doubles each round
constexpr double kLineSpacing_m = 0.25;

// One objective with what guides the searches under it.
struct Guide {
  std::string profile;
  MotionCost cost;
  std::optional<PoseSampler> sampler;  // of the leg in work
};

struct NamedPlanner {
  std::string name;
  std::unique_ptr<LegPlanner> planner;
};

// A way in the making under one cost, leg by leg.
struct Way {
  Pose2 at;
  std::vector<Motion> motions;

  void add(const std::vector<Motion>& leg) {
    motions.insert(motions.end(), leg.begin(), leg.end());
    at = motions.back().to;
  }
};

// One route in the making: as it is smoothed under its guide's cost, and of guides with another objective
// than the request's also under the request's own.
struct Draft {
  std::size_t guide = 0;
  const NamedPlanner* by = nullptr;
  Way guided;
  std::optional<Way> asked;
  bool found = true;
};

class Proposer {
 public:
  Proposer(const PlanProblem& problem, std::span<const PlannerRow> planners, const TraverseMap& map,
           const GroundTables& tables, Progress& progress)
      : problem_(problem),
        map_(map),
        tables_(tables),
        progress_(progress),
        places_(problem.places()),
        asked_cost_(problem, map, tables, problem.weights, problem.ranking.ranked_tail()),
        smoothing_cost_(asked_cost_),
        proposal_{.candidates = {}, .differences = Differences(problem.rover->body_width_m)} {
    smoothing_cost_.penalise(off_rises());
    for (const std::string& name : problem.planners) add_planner(*planner_named(name, planners));
    if (!planners_.empty()) return;
    takes_default_set_ = true;
    for (const PlannerRow& row : planners)
      if (row.in_default_set) add_planner(row);
    if (const PlannerRow* const grid = planner_named(kGridPlanner, planners); grid && !grid->in_default_set)
      add_planner(*grid);
  }

  Proposal run() {
    std::vector<Guide> guides;
    for (const Profile& profile : profiles(problem_.ranking)) {
      const double tail = profile.by_mean ? 1.0 : problem_.ranking.ranked_tail();
      guides.push_back({std::string(profile.name),
                        MotionCost(problem_, map_, tables_, profile.weights(problem_.weights), tail),
                        std::nullopt});
    }
    for (Guide& guide : guides) guide.cost.penalise(off_rises());
    search(guides, 0);
    if (takes_default_set_ && !progress_.cancelled())
      keep(kStraightPlanner, kStraightPlanner, straight_way(problem_));
    if (proposal_.candidates.empty()) return std::move(proposal_);
    for (int round = 1; round <= kMaxRounds && !enough() && !progress_.cancelled(); ++round) {
      guides.clear();
      guides.push_back({"apart_from_the_others", asked_cost_, std::nullopt});
      guides.front().cost.penalise(bands(kBandFactor * std::pow(2.0, round - 1)));
      search(guides, round);
    }
    return std::move(proposal_);
  }

 private:
  void add_planner(const PlannerRow& row) { planners_.push_back({std::string(row.name), row.make()}); }

  bool enough() const { return proposal_.different(wanted()).size() >= wanted(); }
  std::size_t wanted() const { return static_cast<std::size_t>(problem_.routes); }

  // All guides with all planners, leg by leg.
  void search(std::vector<Guide>& guides, int round) {
    std::vector<Draft> drafts;
    for (std::size_t g = 0; g < guides.size(); ++g)
      for (const NamedPlanner& planner : planners_)
        drafts.push_back({.guide = g,
                          .by = &planner,
                          .guided = {},
                          .asked = round == 0 && g > 0 ? std::optional<Way>(Way{}) : std::nullopt});
    for (std::size_t leg = 0; leg + 1 < places_.size() && !progress_.cancelled(); ++leg) {
      parallel_for(guides.size(), problem_.threads, [&](std::size_t g) { look_ahead(guides[g], leg); });
      if (progress_.cancelled()) return;
      if (round == 0) {
        const std::vector<std::size_t>& way = guides.front().sampler->way();
        proposal_.grid_optimum += way.empty() ? kInfinity : cost_of_way(asked_cost_, way);
        proposal_.grid_ways.push_back(way);
      }
      parallel_for(drafts.size(), problem_.threads, [&](std::size_t d) {
        Draft& draft = drafts[d];
        if (draft.found) draft.found = drive_leg(guides[draft.guide], draft, leg, round, d);
      });
    }
    if (progress_.cancelled()) return;
    for (Draft& draft : drafts) {
      if (!draft.found) continue;
      const std::string& profile = guides[draft.guide].profile;
      keep(draft.by->name, profile, std::move(draft.guided.motions));
      if (draft.asked) keep(draft.by->name, profile, std::move(draft.asked->motions));
    }
  }

  void look_ahead(Guide& guide, std::size_t leg) const {
    if (progress_.cancelled()) return;
    const GridSearch grid(guide.cost);
    const CostField to_come = grid.cost_to_come(places_[leg].x_m, places_[leg].y_m);
    const CostField to_go = grid.cost_to_go(places_[leg + 1].x_m, places_[leg + 1].y_m);
    guide.sampler.emplace(grid, map_, to_come, to_go, places_[leg].x_m, places_[leg].y_m);
  }

  bool drive_leg(const Guide& guide, Draft& draft, std::size_t leg, int round, std::size_t number) const {
    const Waypoint& from = places_[leg];
    const Waypoint& to = places_[leg + 1];
    if (!std::isfinite(guide.sampler->optimum())) return false;
    if (leg == 0) {
      const auto cell = static_cast<std::size_t>(map_.index_at(from.x_m, from.y_m));
      draft.guided.at = {from.x_m, from.y_m,
                         wrapped_rad(from.yaw_rad.value_or(guide.sampler->flow_rad(cell)))};
      if (draft.asked) draft.asked->at = draft.guided.at;
    }
    LegSearch search = leg_between(
        guide.cost, *guide.sampler, draft.guided.at, from, to,
        random_key(random_key(random_key(kProposalSeed, leg), static_cast<std::uint64_t>(round)), number));
    search.cancelled = [this] { return progress_.cancelled(); };
    std::vector<Pose2> poses = draft.by->planner->search(search);
    if (!joins(poses, search)) return false;
    draft.guided.add(smooth_leg(guide.cost, poses, to.yaw_rad.has_value()));
    if (!draft.asked) return true;
    poses.front() = draft.asked->at;
    draft.asked->add(smooth_leg(smoothing_cost_, poses, to.yaw_rad.has_value()));
    return true;
  }

  void keep(std::string_view planner, std::string_view profile, std::vector<Motion> motions) {
    set_down_as_it_leaves(problem_.start, motions);
    const double cost = fine_cost(asked_cost_, motions);
    if (!std::isfinite(cost)) {
      // Nobody found the straight line, which is there whatever lies on it.
      if (planner != kStraightPlanner) note_closed(planner, motions);
      return;
    }
    proposal_.differences.add(centreline(motions, kLineSpacing_m));
    if (std::none_of(proposal_.candidates.begin(), proposal_.candidates.end(),
                     [&](const Candidate& other) { return other.cost <= cost; }))
      tell_found(progress_, motions, cost);
    proposal_.candidates.push_back({std::move(motions), std::string(planner), std::string(profile), cost});
  }

  void note_closed(std::string_view planner, const std::vector<Motion>& motions) {
    if (const auto pose = first_hit(map_.keep_out(), motions)) {
      proposal_.in_keep_out.push_back(*pose);
    } else if (const auto closed = first_closed(problem_, asked_cost_, motions)) {
      proposal_.closed.push_back(fmt::format("{} found is closed at {}", planner, *closed));
    }
  }

  std::vector<float> off_rises() const {
    std::vector<float> penalty(map_.cells(), 0.0F);
    keep_off_rises(map_, penalty);
    return penalty;
  }

  // The extra cost factor of every cell, with those near a route that differs so far.
  std::vector<float> bands(double factor) const {
    std::vector<float> penalty = off_rises();
    const double reach = kBandWidths * problem_.rover->body_width_m;
    const dem::GridGeometry& g = map_.geometry();
    const int columns = static_cast<int>(std::ceil(reach / g.cell_x_m));
    const int rows = static_cast<int>(std::ceil(reach / g.cell_y_m));
    for (const std::size_t chosen : proposal_.different(wanted())) {
      for (const Eigen::Vector2d& place : centreline(proposal_.candidates[chosen].motions, map_.cell_m())) {
        for (int dr = -rows; dr <= rows; ++dr) {
          for (int dc = -columns; dc <= columns; ++dc) {
            const long long i = map_.index_at(place.x() + dc * g.cell_x_m, place.y() + dr * g.cell_y_m);
            if (i >= 0 && std::hypot(dc * g.cell_x_m, dr * g.cell_y_m) <= reach &&
                !is_near_place(places_, place, reach))
              penalty[static_cast<std::size_t>(i)] =
                  std::max(penalty[static_cast<std::size_t>(i)], static_cast<float>(factor));
          }
        }
      }
    }
    return penalty;
  }

  const PlanProblem& problem_;
  const TraverseMap& map_;
  const GroundTables& tables_;
  Progress& progress_;
  std::vector<Waypoint> places_;
  MotionCost asked_cost_;
  MotionCost smoothing_cost_;  // the same, dearer beside rises
  std::vector<NamedPlanner> planners_;
  bool takes_default_set_ = false;
  Proposal proposal_;
};

}  // namespace

std::vector<std::size_t> Proposal::by_cost() const {
  std::vector<std::size_t> order(candidates.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return candidates[a].cost < candidates[b].cost; });
  return order;
}

std::vector<std::size_t> Proposal::different(std::size_t wanted) const {
  const std::vector<std::size_t> order = by_cost();
  std::vector<double> costs;
  for (const std::size_t i : order) costs.push_back(candidates[i].cost);
  return select_routes(differences, order, as_good_as_best(costs), wanted);
}

Proposal propose_routes(const PlanProblem& problem, std::span<const PlannerRow> planners,
                        const TraverseMap& map, const GroundTables& tables, Progress& progress) {
  return Proposer(problem, planners, map, tables, progress).run();
}

}  // namespace slipway::planner
