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
#include "planner/search/leg_bound.h"
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

// The grid of a leg under one cost, with its cheapest way; where planners look that draw samples, if there
// are any.
struct LegGround {
  LegGround(const MotionCost& cost, const Waypoint& from, const Waypoint& to)
      : grid(cost),
        to_go(grid.cost_to_go(to.x_m, to.y_m)),
        way(grid, cost.map(), to_go, from.x_m, from.y_m) {}

  GridSearch grid;
  CostField to_go;
  PoseSampler way;
  std::optional<PoseSampler> samples = {};
};

// One route in the making: as it is smoothed under its guide's cost, and of guides with another objective
// than the request's also under the request's own.
struct Draft {
  Way guided;
  std::optional<Way> asked;
  bool is_searched = false;  // on one leg at least, by its own planner
};

class NearProposer final : public Proposer {
 public:
  NearProposer(const PlanProblem& problem, std::span<const PlannerRow> planners, const TraverseMap& map,
               const GroundTables& tables, Progress& progress, const FirstLook& first_look)
      : Proposer(problem, map, tables, progress), smoothing_cost_(asked_), first_look_(first_look) {
    smoothing_cost_.penalise(penalties(0.0));
    for (const std::string& name : problem.planners) add_planner(*planner_named(name, planners));
    if (!planners_.empty()) return;
    for (const PlannerRow& row : planners)
      if (row.in_default_set) add_planner(row);
    if (const PlannerRow* const grid = planner_named(kGridPlanner, planners); grid && !grid->in_default_set)
      add_planner(*grid);
    for (std::size_t k = 0; k < planners_.size(); ++k)
      if (planners_[k].name == kGridPlanner) grid_ = k;
  }

  Proposal run() {
    look_first();
    propose();
    // Where too few routes differ, planners that could gain no cost may still find others.
    if (std::find(left_out_.begin(), left_out_.end(), true) != left_out_.end() && !enough() &&
        !progress_.cancelled()) {
      std::vector<Guide> guides = guides_of_profiles();
      searches_left_out_ = true;
      search(guides, 0);
    }
    return std::move(proposal_);
  }

 private:
  void add_planner(const PlannerRow& row) { planners_.push_back({std::string(row.name), row.make()}); }

  // The grid's cheapest way and the straight line, before all else.
  void look_first() {
    if (!first_look_ || !grid_) return;
    Draft draft;
    for (std::size_t leg = 0; leg + 1 < places_.size() && !progress_.cancelled(); ++leg) {
      first_grounds_.emplace_back(smoothing_cost_, places_[leg], places_[leg + 1]);
      if (draft.guided.found)
        drive_leg(smoothing_cost_, first_grounds_.back().way, leg, 0, *grid_, *grid_, draft);
      first_drafts_.push_back(draft);
    }
    if (progress_.cancelled()) return;
    if (draft.guided.found) look(route(std::move(draft.guided.motions), kGridPlanner, kGridPlanner));
    look(straight_line());
  }

  void look(const Candidate& candidate) {
    if (!std::isfinite(fine_cost(asked_, candidate.motions))) return;
    tells_unjudged_ = false;
    first_look_(candidate);
  }

  // All guides with all planners, leg by leg.
  void search(std::vector<Guide>& guides, int round) override {
    for (Guide& guide : guides) guide.cost.penalise(std::move(guide.penalty));
    // Of all guides by all planners.
    std::vector<Draft> drafts(guides.size() * planners_.size());
    for (std::size_t d = planners_.size(); d < drafts.size(); ++d) drafts[d].asked.emplace();
    if (searches_left_out_)
      for (std::size_t d = 0; d < drafts.size(); ++d) drafts[d].guided.found = left_out_[d];
    const bool is_first = round == 0 && !searches_left_out_;
    for (std::size_t leg = 0; leg + 1 < places_.size() && !progress_.cancelled(); ++leg)
      search_leg(guides, leg, round, drafts);
    if (progress_.cancelled()) return;
    if (is_first) left_out_.assign(drafts.size(), false);
    for (std::size_t d = 0; d < drafts.size(); ++d) {
      if (!drafts[d].guided.found) continue;
      if (!drafts[d].is_searched) {
        if (is_first) left_out_[d] = true;
        continue;
      }
      const std::string &planner = planner_of(d).name, &profile = guides[d / planners_.size()].profile;
      keep(asked_, route(std::move(drafts[d].guided.motions), planner, profile));
      if (drafts[d].asked) keep(asked_, route(std::move(drafts[d].asked->motions), planner, profile));
    }
    if (is_first && problem_.planners.empty()) keep(asked_, straight_line());
  }

  // The grid's ways first: they tell whether another planner may do better, and only then it is begun. Where
  // it is not, its route goes on as the grid's does.
  void search_leg(const std::vector<Guide>& guides, std::size_t leg, int round, std::vector<Draft>& drafts) {
    const Waypoint &from = places_[leg], &to = places_[leg + 1];
    const bool is_first = round == 0 && !searches_left_out_;
    std::vector<std::optional<LegGround>> grounds(guides.size());
    std::vector<char> may_gain(guides.size(), 1);
    parallel_for(guides.size(), problem_.threads, [&](std::size_t g) {
      if (progress_.cancelled()) return;
      const MotionCost& cost = guides[g].cost;
      const bool is_known = is_first && g == 0 && leg < first_grounds_.size();
      if (is_known)
        grounds[g].emplace(std::move(first_grounds_[leg]));
      else
        grounds[g].emplace(cost, from, to);
      if (grid_ && !searches_left_out_) {
        Draft& draft = drafts[g * planners_.size() + *grid_];
        const std::size_t before = draft.guided.motions.size();
        if (is_known)
          draft = first_drafts_[leg];
        else if (draft.guided.found)
          drive_leg(cost, grounds[g]->way, leg, round, *grid_, g * planners_.size() + *grid_, draft);
        may_gain[g] = may_gain_over(cost, *grounds[g], leg, draft, before) ? 1 : 0;
      }
      if (may_gain[g] != 0 && planners_.size() > (grid_ ? 1U : 0U))
        grounds[g]->samples.emplace(grounds[g]->grid, map_, grounds[g]->grid.cost_to_come(from.x_m, from.y_m),
                                    grounds[g]->to_go, from.x_m, from.y_m);
    });
    if (progress_.cancelled()) return;
    if (is_first) {
      const std::vector<std::size_t>& way = grounds.front()->way.way();
      proposal_.grid_optimum += way.empty() ? kInfinity : cost_of_way(asked_, way);
      proposal_.grid_ways.push_back(way);
    }
    parallel_for(drafts.size(), problem_.threads, [&](std::size_t d) {
      const std::size_t g = d / planners_.size(), planner = d % planners_.size();
      if (planner == grid_ || !drafts[d].guided.found) return;
      if (may_gain[g] != 0)
        drive_leg(guides[g].cost, *grounds[g]->samples, leg, round, planner, d, drafts[d]);
      else if (drafts[d].is_searched)
        drive_leg(guides[g].cost, grounds[g]->way, leg, round, *grid_, d, drafts[d]);
      else
        go_on_as(drafts[g * planners_.size() + *grid_], drafts[d]);
    });
  }

  static void go_on_as(const Draft& other, Draft& draft) {
    draft = other;
    draft.is_searched = false;
  }

  // Whether any way of the leg may be cheaper than what the grid's draft has of it, which begins with the
  // motion `before`, by more than routes that are tied differ.
  bool may_gain_over(const MotionCost& cost, const LegGround& ground, std::size_t leg, const Draft& draft,
                     std::size_t before) const {
    if (!problem_.planners.empty() || !draft.guided.found) return true;
    const std::vector<Motion>& all = draft.guided.motions;
    const std::vector<Motion> motions(all.begin() + static_cast<std::ptrdiff_t>(before), all.end());
    const double enough = fine_cost(cost, motions) / (1.0 + kTiedShare);
    // The bound is less than the grid's optimum: where that is too little there is no need to search for it.
    return enough > ground.way.optimum() ||
           enough > least_cost_of_leg(cost, ground.to_go, places_[leg], places_[leg + 1]);
  }

  const NamedPlanner& planner_of(std::size_t draft) const { return planners_[draft % planners_.size()]; }

  void drive_leg(const MotionCost& cost, const PoseSampler& sampler, std::size_t leg, int round,
                 std::size_t planner, std::size_t number, Draft& draft) const {
    const Waypoint &from = places_[leg], &to = places_[leg + 1];
    draft.guided.found = std::isfinite(sampler.optimum());
    if (!draft.guided.found) return;
    draft.is_searched |= planner == number % planners_.size();
    if (leg == 0) {
      draft.guided.at = first_pose(map_, sampler);
      if (draft.asked) draft.asked->at = draft.guided.at;
    }
    const LegSearch search = leg_between(
        cost, sampler, draft.guided.at, from, to,
        random_key(random_key(random_key(kProposalSeed, leg), static_cast<std::uint64_t>(round)), number),
        cancelled_);
    std::vector<Pose2> poses = planners_[planner].planner->search(search);
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

  MotionCost smoothing_cost_;  // the request's, dearer beside rises: that of the first guide
  const FirstLook& first_look_;
  std::optional<std::size_t> grid_;  // of the planners, in the default set
  std::vector<LegGround> first_grounds_;
  std::vector<Draft> first_drafts_;  // up to each leg's end
  std::vector<bool> left_out_;       // of the first round's drafts, since they could gain nothing
  bool searches_left_out_ = false;
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
                        const TraverseMap& map, const GroundTables& tables, Progress& progress,
                        const FirstLook& first_look) {
  return NearProposer(problem, planners, map, tables, progress, first_look).run();
}

}  // namespace slipway::planner
