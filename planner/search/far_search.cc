#include "planner/search/far_search.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>

#include "core/parallel_for.h"
#include "core/random.h"
#include "planner/search/corridor.h"
#include "planner/search/corridor_cells.h"
#include "planner/search/grid_search.h"
#include "planner/search/leg_search.h"
#include "planner/search/leg_setting.h"
#include "planner/search/long_leg.h"
#include "planner/search/overlap.h"
#include "planner/search/proposer.h"
#include "planner/search/stage_progress.h"
#include "planner/search/tell_found.h"

namespace slipway::planner {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::size_t kBlockArea = static_cast<std::size_t>(kBlockCells) * kBlockCells;
// How wide the first corridor is, in blocks: of the request's own objective, on which the optimum is stated,
// and of the others.
constexpr double kOwnWidth = 24.0, kOtherWidth = 10.0;
constexpr std::size_t kFewestBlocks = 400;
// How often a corridor that has a way becomes twice as wide because the way comes to its edge.
constexpr int kOwnWidenings = 2;
// Half width of the band around a route: of the leg, at least so many blocks.
constexpr double kBandOfLeg = 0.01, kMinBand_blocks = 2.0;
constexpr double kBandFactor = 0.5;  // the first round's extra cost in the band; doubles each round
// So many blocks to each side of the way planners that sample see.
constexpr int kPieceReach = 3;

// What is in the making under one guide's cost.
struct Drafts {
  std::vector<Way> by_planners;
  std::vector<std::vector<Eigen::Vector2d>> grid_ways;  // of each leg
  double optimum = 0.0;
};

class FarProposer final : public Proposer {
 public:
  // `nowhere`: a map without cells.
  FarProposer(const PlanProblem& problem, std::span<const PlannerRow> planners, const TraverseMap& nowhere,
              const GroundTables& tables, const BlockMap& blocks, Progress& progress)
      : Proposer(problem, nowhere, tables, progress), blocks_(blocks) {
    planners_.push_back({std::string(kGridPlanner), nullptr});
    for (const std::string& name : problem.planners)
      if (name != kGridPlanner) planners_.push_back({name, planner_named(name, planners)->make()});
    by_grid_ = problem.planners.empty() || planners_.size() <= problem.planners.size();
  }

  FarProposal run() {
    if (!progress_.cancelled() && !blocks_.is_damaged() && find_nodes()) propose();
    return {std::move(proposal_), std::move(around_), std::move(no_way_)};
  }

 private:
  // The nodes of the places; false where no way joins two of them.
  bool find_nodes() {
    for (const Waypoint& place : places_) {
      const auto node = blocks_.node_at(place.x_m, place.y_m);
      if (!node) {
        no_way_.push_back(fmt::format("no way from ({:.1f}, {:.1f}): the search's cell there is closed",
                                      place.x_m, place.y_m));
        proposal_.grid_optimum = kInfinity;
        return false;
      }
      nodes_.push_back(*node);
    }
    return true;
  }

  void search(std::vector<Guide>& guides, int round) override {
    if (round == 0) work_ = static_cast<int>(guides.size()) + kMaxRounds;
    std::vector<Drafts> drafts(guides.size());
    parallel_for(guides.size(), problem_.threads, [&](std::size_t g) {
      if (progress_.cancelled()) return;
      const bool is_own = round == 0 && g == 0;  // the request's own objective
      NodeCosts costs(blocks_, guides[g].cost);
      drafts[g].by_planners.resize(planners_.size());
      for (std::size_t leg = 0; leg + 1 < places_.size() && drafts[g].optimum < kInfinity; ++leg)
        if (!drive_leg(guides[g], is_own, costs, leg, g, drafts[g])) drafts[g].optimum = kInfinity;
      // What there is if nothing better comes.
      const Way& by_grid = drafts[g].by_planners.front();
      if (is_own && by_grid_ && by_grid.found && drafts[g].optimum < kInfinity)
        tell_found(progress_, by_grid.motions, drafts[g].optimum);
      progress_.report("", std::min(1.0, static_cast<double>(++done_) / work_));
    });
    if (progress_.cancelled()) return;
    if (round == 0) {
      proposal_.grid_optimum = drafts.front().optimum;
      ways_ = drafts.front().grid_ways;
      if (!(proposal_.grid_optimum < kInfinity)) say_why();
    }
    for (std::size_t g = 0; g < guides.size(); ++g) {
      if (!(drafts[g].optimum < kInfinity)) continue;
      for (std::size_t k = by_grid_ ? 0 : 1; k < planners_.size(); ++k) {
        Way& way = drafts[g].by_planners[k];
        if (way.found) found_.push_back(route(std::move(way.motions), planners_[k].name, guides[g].profile));
      }
    }
    if (round == 0 && problem_.planners.empty() && !found_.empty()) found_.push_back(straight_line());
    judge();
  }

  bool found_any() const override { return !found_.empty(); }

  // The way on the grid, and along it all planners; false where there is none.
  bool drive_leg(const Guide& guide, bool is_own, NodeCosts& costs, std::size_t leg, std::size_t number,
                 Drafts& drafts) const {
    const Waypoint &from = places_[leg], &to = places_[leg + 1];
    const Corridor corridor(blocks_, costs, guide.penalty, nodes_[leg], nodes_[leg + 1], cancelled_);
    if (!corridor.leads() || progress_.cancelled()) return false;
    const dem::GridGeometry& g = blocks_.geometry();
    const double across = std::hypot((to.x_m - from.x_m) / g.cell_x_m, (to.y_m - from.y_m) / g.cell_y_m);
    std::size_t least = std::max(
        kFewestBlocks, static_cast<std::size_t>((is_own ? kOwnWidth : kOtherWidth) * across / kBlockCells));
    for (int widened = 0;; ++widened, least *= 2) {
      least = std::min(least, kMaxCorridorCells / kBlockArea);
      const TraverseMap map(problem_, map_.keep_out(), corridor.blocks(least), progress_);
      MotionCost cost = guide.cost.on(map);
      cost.penalise(cell_penalties(map, guide.penalty));
      const GridSearch grid(cost);
      const CostField to_go = grid.cost_to_go(to.x_m, to.y_m, {map.index_at(from.x_m, from.y_m), cancelled_});
      const PoseSampler sampler(grid, map, to_go, from.x_m, from.y_m);
      if (progress_.cancelled()) return false;
      const bool is_last = least >= corridor.most() || least >= kMaxCorridorCells / kBlockArea;
      if (!is_last && (sampler.way().empty() ||
                       (is_own && widened < kOwnWidenings && comes_to_edge(blocks_, map, sampler.way()))))
        continue;
      if (sampler.way().empty()) return false;
      drafts.optimum += cost_of_way(guide.cost.on(map), sampler.way());
      std::vector<Eigen::Vector2d>& way = drafts.grid_ways.emplace_back();
      for (const std::size_t cell : sampler.way()) way.push_back(map.centre_m(cell));
      for (std::size_t k = 0; k < planners_.size(); ++k) {
        Way& draft = drafts.by_planners[k];
        if (leg == 0) draft.at = first_pose(map, sampler);
        if (!draft.found) continue;
        if (k > 0) {
          drive_in_pieces(guide, cost, way, leg, number, k, draft);
          continue;
        }
        draft.add(drive_long_way(leg_between(cost, sampler, draft.at, from, to, 0, cancelled_)));
      }
      return true;
    }
  }

  // From place to place on the grid's way, on the cells about it.
  void drive_in_pieces(const Guide& guide, const MotionCost& whole, const std::vector<Eigen::Vector2d>& way,
                       std::size_t leg, std::size_t number, std::size_t planner, Way& draft) const {
    const Waypoint& last = places_[leg + 1];
    std::vector<Pose2> poses{draft.at};
    Pose2 at = draft.at;
    for (std::size_t begin = 0, piece = 0; begin + 1 < way.size(); ++piece) {
      const std::size_t end = piece_end(way, begin);
      const Waypoint from{at.x_m, at.y_m, {}};
      Waypoint to{way[end].x(), way[end].y(), {}};
      if (end + 1 == way.size()) to = last;
      const std::vector<Eigen::Vector2d> part(way.begin() + static_cast<std::ptrdiff_t>(begin),
                                              way.begin() + static_cast<std::ptrdiff_t>(end) + 1);
      const TraverseMap map(problem_, map_.keep_out(), blocks_around(blocks_.geometry(), part, kPieceReach),
                            progress_);
      MotionCost cost = guide.cost.on(map);
      cost.penalise(cell_penalties(map, guide.penalty));
      const GridSearch grid(cost);
      const PoseSampler sampler(grid, map, grid.cost_to_come(from.x_m, from.y_m, {-1, cancelled_}),
                                grid.cost_to_go(to.x_m, to.y_m, {-1, cancelled_}), from.x_m, from.y_m);
      const std::uint64_t key = random_key(random_key(kProposalSeed, leg), piece);
      const LegSearch search = leg_between(cost, sampler, at, from, to,
                                           random_key(random_key(key, number), planner - 1), cancelled_);
      const std::vector<Pose2> found = planners_[planner].planner->search(search);
      draft.found = joins(found, search);
      if (!draft.found) return;
      poses.insert(poses.end(), found.begin() + 1, found.end());
      at = found.back();
      begin = end;
    }
    draft.add(smooth_long_leg(whole, poses, last.yaw_rad.has_value(), cancelled_));
  }

  // Of every block.
  std::vector<float> penalties(double factor) const override {
    const dem::GridGeometry& g = blocks_.geometry();
    std::vector<float> penalty(blocks_.blocks(), 0.0F);
    const std::vector<double> legs = problem_.leg_lengths_m();
    const double longest = *std::max_element(legs.begin(), legs.end());
    const double block = kBlockCells * std::max(g.cell_x_m, g.cell_y_m);
    const double reach = std::max(kMinBand_blocks * block, kBandOfLeg * longest);
    for (const std::uint32_t b :
         blocks_around(g, places_of_bands(0.5 * block, reach), static_cast<int>(std::ceil(reach / block))))
      penalty[b] = static_cast<float>(kBandFactor * factor);
    return penalty;
  }

  // Costs all that was found under the request's own objective, on the cells around it.
  void judge() {
    std::vector<Eigen::Vector2d> lines;
    for (const std::vector<Eigen::Vector2d>& way : ways_) lines.insert(lines.end(), way.begin(), way.end());
    for (const Candidate& found : found_) {
      const auto line = centreline(found.motions, 0.5 * kBlockCells * map_.cell_m());
      lines.insert(lines.end(), line.begin(), line.end());
    }
    around_ = std::make_unique<TraverseMap>(problem_, map_.keep_out(),
                                            blocks_around(blocks_.geometry(), lines, 2), progress_);
    const MotionCost cost = asked_.on(*around_);
    for (; judged_ < found_.size(); ++judged_) keep(cost, found_[judged_]);
    proposal_.grid_ways.clear();
    for (const std::vector<Eigen::Vector2d>& way : ways_) {
      std::vector<std::size_t>& cells = proposal_.grid_ways.emplace_back();
      for (const Eigen::Vector2d& p : way)
        cells.push_back(static_cast<std::size_t>(around_->index_at(p.x(), p.y())));
    }
  }

  void say_why() {
    for (std::size_t leg = 0; leg + 1 < places_.size(); ++leg) {
      const Waypoint &from = places_[leg], &to = places_[leg + 1];
      const Reach reach = reach_of(blocks_, nodes_[leg], nodes_[leg + 1]);
      std::string words =
          fmt::format("from ({:.1f}, {:.1f}) to ({:.1f}, {:.1f})", from.x_m, from.y_m, to.x_m, to.y_m);
      if (!reach.leads)
        no_way_.push_back(fmt::format(
            "no way {} on the whole map: from the start {:.0f} m2 can be reached, and the ground from which "
            "the goal can be is nearest {:.0f} m away, between ({:.1f}, {:.1f}) and ({:.1f}, {:.1f})",
            words, reach.area_m2, reach.gap_m, reach.here.x(), reach.here.y(), reach.there.x(),
            reach.there.y()));
      else
        no_way_.push_back(fmt::format(
            "no drivable way {}: no cell closes it, but the slopes between them immobilise the rover on the "
            "mean soils in the directions that lead to the goal, on all ways of at most {} cells that were "
            "searched",
            words, kMaxCorridorCells));
    }
  }

  const BlockMap& blocks_;
  bool by_grid_ = true;  // the first of the planners, the grid, is asked for
  std::vector<std::uint32_t> nodes_;
  std::vector<Candidate> found_;
  std::size_t judged_ = 0;
  std::vector<std::vector<Eigen::Vector2d>> ways_;
  std::atomic<int> done_{0};
  int work_ = 1;
  std::unique_ptr<TraverseMap> around_;  // around all that was found
  std::vector<std::string> no_way_;
};

}  // namespace

FarProposal propose_far_routes(const PlanProblem& problem, std::span<const PlannerRow> planners,
                               const KeepOut& keep_out, const GroundTables& tables, Progress& progress) {
  StageProgress reading(progress, "looking over the ground", 0.0, 0.4);
  const BlockMap blocks(problem, keep_out, reading);
  StageProgress searching(progress, "proposing routes", 0.4, 1.0);
  const TraverseMap nowhere(problem, keep_out, std::vector<std::uint32_t>{}, progress);
  return FarProposer(problem, planners, nowhere, tables, blocks, searching).run();
}

}  // namespace slipway::planner
