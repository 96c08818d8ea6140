#include "planner/search/propose.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>
#include <optional>

#include "core/parallel_for.h"
#include "core/random.h"
#include "planner/search/corridor_cells.h"
#include "planner/search/grid_search.h"
#include "planner/search/leg_search.h"
#include "planner/search/leg_setting.h"
#include "planner/search/planner_catalogue.h"
#include "planner/search/proposer.h"
#include "planner/search/smooth_route.h"

namespace slipway::planner {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kBandWidths = 2.0;  // half width of the band around a route, in rover widths
constexpr double kBandFactor = 1.0;  // the first round's extra cost in the band; doubles each round

// One route in the making: as it is smoothed under its guide's cost, and of guides with another objective
// than the request's also under the request's own.
struct Draft {
  Way guided;
  std::optional<Way> asked;
};

class NearProposer final : public Proposer {
 public:
  NearProposer(const PlanProblem& problem, std::span<const PlannerRow> planners, const TraverseMap& map,
               const GroundTables& tables, Progress& progress)
      : Proposer(problem, map, tables, progress), smoothing_cost_(asked_) {
    smoothing_cost_.penalise(penalties(0.0));
    for (const std::string& name : problem.planners) add_planner(*planner_named(name, planners));
    if (!planners_.empty()) return;
    for (const PlannerRow& row : planners)
      if (row.in_default_set) add_planner(row);
    if (const PlannerRow* const grid = planner_named(kGridPlanner, planners); grid && !grid->in_default_set)
      add_planner(*grid);
  }

  Proposal run() {
    propose();
    return std::move(proposal_);
  }

 private:
  void add_planner(const PlannerRow& row) { planners_.push_back({std::string(row.name), row.make()}); }

  // All guides with all planners, leg by leg.
  void search(std::vector<Guide>& guides, int round) override {
    for (Guide& guide : guides) guide.cost.penalise(std::move(guide.penalty));
    std::vector<std::optional<PoseSampler>> samplers(guides.size());  // of the leg in work
    // Of all guides by all planners.
    std::vector<Draft> drafts(guides.size() * planners_.size());
    for (std::size_t d = planners_.size(); d < drafts.size(); ++d) drafts[d].asked.emplace();
    for (std::size_t leg = 0; leg + 1 < places_.size() && !progress_.cancelled(); ++leg) {
      const Waypoint &from = places_[leg], &to = places_[leg + 1];
      parallel_for(guides.size(), problem_.threads, [&](std::size_t g) {
        if (progress_.cancelled()) return;
        const GridSearch grid(guides[g].cost);
        samplers[g].emplace(grid, map_, grid.cost_to_come(from.x_m, from.y_m),
                            grid.cost_to_go(to.x_m, to.y_m), from.x_m, from.y_m);
      });
      if (progress_.cancelled()) return;
      if (round == 0) {
        const std::vector<std::size_t>& way = samplers.front()->way();
        proposal_.grid_optimum += way.empty() ? kInfinity : cost_of_way(asked_, way);
        proposal_.grid_ways.push_back(way);
      }
      parallel_for(drafts.size(), problem_.threads, [&](std::size_t d) {
        const std::size_t g = d / planners_.size();
        if (drafts[d].guided.found) drive_leg(guides[g].cost, *samplers[g], leg, round, d, drafts[d]);
      });
    }
    if (progress_.cancelled()) return;
    for (std::size_t d = 0; d < drafts.size(); ++d) {
      if (!drafts[d].guided.found) continue;
      const std::string &planner = planner_of(d).name, &profile = guides[d / planners_.size()].profile;
      keep(asked_, route(std::move(drafts[d].guided.motions), planner, profile));
      if (drafts[d].asked) keep(asked_, route(std::move(drafts[d].asked->motions), planner, profile));
    }
    if (round == 0 && problem_.planners.empty()) keep(asked_, straight_line());
  }

  const NamedPlanner& planner_of(std::size_t draft) const { return planners_[draft % planners_.size()]; }

  void drive_leg(const MotionCost& cost, const PoseSampler& sampler, std::size_t leg, int round,
                 std::size_t number, Draft& draft) const {
    const Waypoint &from = places_[leg], &to = places_[leg + 1];
    draft.guided.found = std::isfinite(sampler.optimum());
    if (!draft.guided.found) return;
    if (leg == 0) {
      draft.guided.at = first_pose(map_, sampler);
      if (draft.asked) draft.asked->at = draft.guided.at;
    }
    const LegSearch search = leg_between(
        cost, sampler, draft.guided.at, from, to,
        random_key(random_key(random_key(kProposalSeed, leg), static_cast<std::uint64_t>(round)), number),
        cancelled_);
    std::vector<Pose2> poses = planner_of(number).planner->search(search);
    draft.guided.found = joins(poses, search);
    if (!draft.guided.found) return;
    draft.guided.add(smooth_leg(cost, poses, to.yaw_rad.has_value()));
    if (!draft.asked) return;
    poses.front() = draft.asked->at;
    draft.asked->add(smooth_leg(smoothing_cost_, poses, to.yaw_rad.has_value()));
  }

  // Of every cell.
  std::vector<float> penalties(double factor) const override {
    std::vector<float> penalty(map_.cells(), 0.0F);
    keep_off_rises(map_, penalty);
    const double reach = kBandWidths * problem_.rover->body_width_m;
    const dem::GridGeometry& g = map_.geometry();
    const int columns = static_cast<int>(std::ceil(reach / g.cell_x_m));
    const int rows = static_cast<int>(std::ceil(reach / g.cell_y_m));
    for (const Eigen::Vector2d& place : places_of_bands(map_.cell_m(), reach)) {
      for (int dr = -rows; dr <= rows; ++dr) {
        for (int dc = -columns; dc <= columns; ++dc) {
          const long long i = map_.index_at(place.x() + dc * g.cell_x_m, place.y() + dr * g.cell_y_m);
          if (i < 0 || std::hypot(dc * g.cell_x_m, dr * g.cell_y_m) > reach) continue;
          float& of_cell = penalty[static_cast<std::size_t>(i)];
          of_cell = std::max(of_cell, static_cast<float>(kBandFactor * factor));
        }
      }
    }
    return penalty;
  }

  MotionCost smoothing_cost_;  // the request's, dearer beside rises
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
  return NearProposer(problem, planners, map, tables, progress).run();
}

}  // namespace slipway::planner
