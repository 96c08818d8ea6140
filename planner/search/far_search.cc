#include "planner/search/far_search.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>
#include <optional>

#include "core/angle.h"
#include "core/parallel_for.h"
#include "core/random.h"
#include "planner/search/bottleneck.h"
#include "planner/search/corridor.h"
#include "planner/search/corridor_cells.h"
#include "planner/search/grid_leg_planner.h"
#include "planner/search/grid_search.h"
#include "planner/search/leg_search.h"
#include "planner/search/leg_setting.h"
#include "planner/search/long_leg.h"
#include "planner/search/overlap.h"
#include "planner/search/profile.h"
#include "planner/search/smooth_route.h"
#include "planner/search/stage_progress.h"
#include "planner/search/tell_found.h"

namespace slipway::planner {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kMaxRounds = 4;
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
constexpr double kLineSpacing_m = 0.25;
// Planners that sample go so far at once, and see so many blocks to each side of the way.
constexpr double kPiece_m = 200.0;
constexpr int kPieceReach = 3;

struct Guide {
  std::string profile;
  MotionCost cost;
  std::vector<float> penalty = {};  // of the blocks
  double width = kOtherWidth;
  int widenings = 0;  // of a corridor that has a way
};

// One route in the making.
struct Draft {
  Pose2 at;
  std::vector<Motion> motions;
  std::vector<std::vector<Eigen::Vector2d>> ways;  // of each leg, on the grid
  double optimum = 0.0;
  bool found = true;
  std::string planner;
};

class FarProposer {
 public:
  FarProposer(const PlanProblem& problem, std::span<const PlannerRow> planners, const KeepOut& keep_out,
              const GroundTables& tables, const BlockMap& blocks, Progress& progress)
      : problem_(problem),
        keep_out_(keep_out),
        tables_(tables),
        blocks_(blocks),
        progress_(progress),
        cancelled_([&progress] { return progress.cancelled(); }),
        places_(problem.places()),
        nowhere_(problem, keep_out, std::vector<std::uint32_t>{}, progress),
        out_{.proposal = {.candidates = {}, .differences = Differences(problem.rover->body_width_m)},
             .map = nullptr,
             .no_way = {}} {
    for (const std::string& name : problem.planners)
      if (name != "grid") others_.emplace_back(name, planner_named(name, planners)->make());
    by_grid_ = problem.planners.empty() || others_.size() < problem.planners.size();
  }

  FarProposal run() {
    if (!find_nodes()) return std::move(out_);
    std::vector<Guide> guides;
    for (const Profile& profile : profiles(problem_.ranking)) {
      const double tail = profile.by_mean ? 1.0 : problem_.ranking.ranked_tail();
      guides.push_back({std::string(profile.name),
                        MotionCost(problem_, nowhere_, tables_, profile.weights(problem_.weights), tail)});
    }
    guides.front().width = kOwnWidth;
    guides.front().widenings = kOwnWidenings;
    const MotionCost asked(problem_, nowhere_, tables_, problem_.weights, problem_.ranking.ranked_tail());
    work_ = static_cast<int>(guides.size()) + kMaxRounds;
    search(guides, true);
    if (problem_.planners.empty() && !found_.empty()) {
      std::vector<Motion> line = straight_way(problem_);
      set_down_as_it_leaves(problem_.start, line);
      found_.push_back({std::move(line), std::string(kStraightPlanner), std::string(kStraightPlanner)});
    }
    judge(asked);
    for (int round = 1; round <= kMaxRounds && !found_.empty() && !enough() && !progress_.cancelled();
         ++round) {
      guides.clear();
      guides.push_back({"apart_from_the_others", asked});
      guides.front().penalty = bands(kBandFactor * std::pow(2.0, round - 1));
      search(guides, false);
      judge(asked);
    }
    return std::move(out_);
  }

 private:
  std::size_t wanted() const { return static_cast<std::size_t>(problem_.routes); }
  bool enough() const { return out_.proposal.different(wanted()).size() >= wanted(); }

  // The nodes of the places; false where no way joins two of them.
  bool find_nodes() {
    for (const Waypoint& place : places_) {
      const auto node = blocks_.node_at(place.x_m, place.y_m);
      if (!node) {
        out_.no_way.push_back(fmt::format("no way from ({:.1f}, {:.1f}): the search's cell there is closed",
                                          place.x_m, place.y_m));
        out_.proposal.grid_optimum = kInfinity;
        return false;
      }
      nodes_.push_back(*node);
    }
    return true;
  }

  void search(std::vector<Guide>& guides, bool is_first) {
    std::vector<Draft> drafts(guides.size() * (others_.size() + 1));
    parallel_for(guides.size(), problem_.threads, [&](std::size_t g) {
      if (progress_.cancelled()) return;
      NodeCosts costs(blocks_, guides[g].cost);
      Draft* const of_guide = &drafts[g * (others_.size() + 1)];
      for (std::size_t leg = 0; leg + 1 < places_.size() && of_guide[0].optimum < kInfinity; ++leg)
        drive_leg(guides[g], costs, leg, g, of_guide);
      // The request's own objective: what there is if nothing better comes.
      if (is_first && g == 0 && by_grid_ && of_guide[0].found && !of_guide[0].motions.empty())
        tell_found(progress_, of_guide[0].motions, of_guide[0].optimum);
      progress_.report("", std::min(1.0, static_cast<double>(++done_) / work_));
    });
    if (progress_.cancelled()) return;
    if (is_first) {
      out_.proposal.grid_optimum = drafts.front().optimum;
      ways_ = drafts.front().ways;
      if (!(drafts.front().optimum < kInfinity)) say_why();
    }
    for (std::size_t d = 0; d < drafts.size(); ++d) {
      Draft& draft = drafts[d];
      if (!draft.found || draft.motions.empty() || (d % (others_.size() + 1) == 0 && !by_grid_)) continue;
      set_down_as_it_leaves(problem_.start, draft.motions);
      found_.push_back({std::move(draft.motions), draft.planner, guides[d / (others_.size() + 1)].profile});
    }
  }

  // The way on the grid, and along it all planners.
  void drive_leg(const Guide& guide, NodeCosts& costs, std::size_t leg, std::size_t number,
                 Draft* drafts) const {
    const Waypoint &from = places_[leg], &to = places_[leg + 1];
    const auto fail = [&] {
      for (std::size_t d = 0; d <= others_.size(); ++d) drafts[d].found = false;
      drafts[0].optimum = kInfinity;
    };
    const Corridor corridor(blocks_, costs, guide.penalty, nodes_[leg], nodes_[leg + 1], cancelled_);
    if (!corridor.leads() || progress_.cancelled()) return fail();
    const dem::GridGeometry& g = blocks_.geometry();
    const double across = std::hypot((to.x_m - from.x_m) / g.cell_x_m, (to.y_m - from.y_m) / g.cell_y_m);
    std::size_t least = std::max(kFewestBlocks, static_cast<std::size_t>(guide.width * across / kBlockCells));
    for (int widened = 0;;) {
      least = std::min(least, kMaxCorridorCells / kBlockArea);
      const TraverseMap map(problem_, keep_out_, corridor.blocks(least), progress_);
      MotionCost cost = guide.cost.on(map);
      cost.penalise(cell_penalties(map, guide.penalty));
      const GridSearch grid(cost);
      const CostField to_go = grid.cost_to_go(to.x_m, to.y_m, {map.index_at(from.x_m, from.y_m), cancelled_});
      const PoseSampler sampler(grid, map, to_go, from.x_m, from.y_m);
      if (progress_.cancelled()) return fail();
      const bool is_last = least >= corridor.most() || least >= kMaxCorridorCells / kBlockArea;
      if (!is_last && (sampler.way().empty() ||
                       (widened < guide.widenings && comes_to_edge(blocks_, map, sampler.way())))) {
        least *= 2;
        ++widened;
        continue;
      }
      if (sampler.way().empty()) return fail();
      drafts[0].optimum += cost_of_way(guide.cost.on(map), sampler.way());
      drafts[0].ways.emplace_back();
      for (const std::size_t cell : sampler.way()) drafts[0].ways.back().push_back(map.centre_m(cell));
      if (leg == 0) {
        const auto cell = static_cast<std::size_t>(map.index_at(from.x_m, from.y_m));
        for (std::size_t d = 0; d <= others_.size(); ++d)
          drafts[d].at = {from.x_m, from.y_m, wrapped_rad(from.yaw_rad.value_or(sampler.flow_rad(cell)))};
      }
      pull_straight(cost, sampler, leg, drafts[0]);
      for (std::size_t k = 0; k < others_.size(); ++k)
        drive_in_pieces(guide, cost, drafts[0].ways.back(), leg, number, k, drafts[k + 1]);
      return;
    }
  }

  void pull_straight(const MotionCost& cost, const PoseSampler& sampler, std::size_t leg,
                     Draft& draft) const {
    draft.planner = "grid";
    if (!draft.found) return;
    const Waypoint &from = places_[leg], &to = places_[leg + 1];
    std::vector<Eigen::Vector2d> way = draft.ways.back();
    // The way's ends are in the first and last cell, mostly not at their centres.
    way.front() = {from.x_m, from.y_m};
    if (way.size() < 2) way.emplace_back();
    way.back() = {to.x_m, to.y_m};
    const LegSearch search = leg_between(cost, sampler, draft.at, from, to, 0);
    add(drive_long_way(cost, draft.at, way, search.arrival_rad, cancelled_), draft);
  }

  static void add(const std::vector<Motion>& motions, Draft& draft) {
    draft.found = !motions.empty();
    if (!draft.found) return;
    draft.motions.insert(draft.motions.end(), motions.begin(), motions.end());
    draft.at = draft.motions.back().to;
  }

  // From place to place on the grid's way, on the cells about it.
  void drive_in_pieces(const Guide& guide, const MotionCost& whole, const std::vector<Eigen::Vector2d>& way,
                       std::size_t leg, std::size_t number, std::size_t planner, Draft& draft) const {
    draft.planner = others_[planner].first;
    if (!draft.found) return;
    const Waypoint& last = places_[leg + 1];
    std::vector<Pose2> poses{draft.at};
    Pose2 at = draft.at;
    for (std::size_t begin = 0, piece = 0; begin + 1 < way.size(); ++piece) {
      std::size_t end = begin + 1;
      for (double driven = 0.0; end + 1 < way.size() && driven < kPiece_m; ++end)
        driven += (way[end] - way[end - 1]).norm();
      const Waypoint from{at.x_m, at.y_m, {}};
      Waypoint to{way[end].x(), way[end].y(), {}};
      if (end + 1 == way.size()) to = last;
      const std::vector<Eigen::Vector2d> part(way.begin() + static_cast<std::ptrdiff_t>(begin),
                                              way.begin() + static_cast<std::ptrdiff_t>(end) + 1);
      const TraverseMap map(problem_, keep_out_, blocks_around(blocks_.geometry(), part, kPieceReach),
                            progress_);
      MotionCost cost = guide.cost.on(map);
      cost.penalise(cell_penalties(map, guide.penalty));
      const GridSearch grid(cost);
      const PoseSampler sampler(grid, map, grid.cost_to_come(from.x_m, from.y_m, {-1, cancelled_}),
                                grid.cost_to_go(to.x_m, to.y_m, {-1, cancelled_}), from.x_m, from.y_m);
      const std::uint64_t key = random_key(random_key(kProposalSeed, leg), piece);
      LegSearch search =
          leg_between(cost, sampler, at, from, to, random_key(random_key(key, number), planner));
      search.cancelled = cancelled_;
      const std::vector<Pose2> found = others_[planner].second->search(search);
      draft.found = joins(found, search);
      if (!draft.found) return;
      poses.insert(poses.end(), found.begin() + 1, found.end());
      at = found.back();
      begin = end;
    }
    add(smooth_long_leg(whole, poses, last.yaw_rad.has_value(), cancelled_), draft);
  }

  // The extra cost factor of every block that is near a route that differs so far.
  std::vector<float> bands(double factor) const {
    const dem::GridGeometry& g = blocks_.geometry();
    std::vector<float> penalty(blocks_.blocks(), 0.0F);
    double longest = 0.0;
    for (std::size_t i = 1; i < places_.size(); ++i)
      longest = std::max(
          longest, std::hypot(places_[i].x_m - places_[i - 1].x_m, places_[i].y_m - places_[i - 1].y_m));
    const double block = kBlockCells * std::max(g.cell_x_m, g.cell_y_m);
    const double reach = std::max(kMinBand_blocks * block, kBandOfLeg * longest);
    const Proposal& p = out_.proposal;
    for (const std::size_t chosen : p.different(wanted())) {
      std::vector<Eigen::Vector2d> line = centreline(p.candidates[chosen].motions, 0.5 * block);
      line.erase(std::remove_if(line.begin(), line.end(),
                                [&](const Eigen::Vector2d& at) { return is_near_place(places_, at, reach); }),
                 line.end());
      for (const std::uint32_t b : blocks_around(g, line, static_cast<int>(std::ceil(reach / block))))
        penalty[b] = static_cast<float>(factor);
    }
    return penalty;
  }

  // Costs all that was found under the request's own objective, on the cells around it.
  void judge(const MotionCost& asked) {
    if (progress_.cancelled()) return;
    std::vector<Eigen::Vector2d> lines;
    for (const std::vector<Eigen::Vector2d>& way : ways_) lines.insert(lines.end(), way.begin(), way.end());
    for (const Found& route : found_) {
      const auto line = centreline(route.motions, 0.5 * kBlockCells * out_cell_m());
      lines.insert(lines.end(), line.begin(), line.end());
    }
    out_.map = std::make_unique<TraverseMap>(problem_, keep_out_, blocks_around(blocks_.geometry(), lines, 2),
                                             progress_);
    const MotionCost cost = asked.on(*out_.map);
    for (; judged_ < found_.size(); ++judged_) keep(cost, found_[judged_]);
    out_.proposal.grid_ways.clear();
    for (const std::vector<Eigen::Vector2d>& way : ways_) {
      std::vector<std::size_t>& cells = out_.proposal.grid_ways.emplace_back();
      for (const Eigen::Vector2d& p : way)
        cells.push_back(static_cast<std::size_t>(out_.map->index_at(p.x(), p.y())));
    }
  }

  double out_cell_m() const { return std::min(blocks_.geometry().cell_x_m, blocks_.geometry().cell_y_m); }

  struct Found {
    std::vector<Motion> motions;
    std::string planner, profile;
  };

  void keep(const MotionCost& asked, const Found& found) {
    Proposal& p = out_.proposal;
    const double cost = fine_cost(asked, found.motions);
    if (std::isfinite(cost)) {
      if (std::none_of(p.candidates.begin(), p.candidates.end(),
                       [&](const Candidate& other) { return other.cost <= cost; }))
        tell_found(progress_, found.motions, cost);
      p.differences.add(centreline(found.motions, kLineSpacing_m));
      p.candidates.push_back({found.motions, found.planner, found.profile, cost});
    } else if (found.planner == kStraightPlanner) {
      return;  // nobody found it: it is there whatever lies on it
    } else if (const auto pose = first_hit(keep_out_, found.motions)) {
      p.in_keep_out.push_back(*pose);
    } else if (const auto closed = first_closed(problem_, asked, found.motions)) {
      p.closed.push_back(fmt::format("{} found is closed at {}", found.planner, *closed));
    }
  }

  void say_why() {
    for (std::size_t leg = 0; leg + 1 < places_.size(); ++leg) {
      const Waypoint &from = places_[leg], &to = places_[leg + 1];
      const Reach reach = reach_of(blocks_, nodes_[leg], nodes_[leg + 1]);
      std::string words =
          fmt::format("from ({:.1f}, {:.1f}) to ({:.1f}, {:.1f})", from.x_m, from.y_m, to.x_m, to.y_m);
      if (!reach.leads)
        out_.no_way.push_back(fmt::format(
            "no way {} on the whole map: from the start {:.0f} m2 can be reached, and the ground from which "
            "the goal can be is nearest {:.0f} m away, between ({:.1f}, {:.1f}) and ({:.1f}, {:.1f})",
            words, reach.area_m2, reach.gap_m, reach.here.x(), reach.here.y(), reach.there.x(),
            reach.there.y()));
      else if (!(out_.proposal.grid_optimum < kInfinity))
        out_.no_way.push_back(fmt::format(
            "no drivable way {}: no cell closes it, but the slopes between them immobilise the rover on the "
            "mean soils in the directions that lead to the goal, on all ways of at most {} cells that were "
            "searched",
            words, kMaxCorridorCells));
    }
  }

  const PlanProblem& problem_;
  const KeepOut& keep_out_;
  const GroundTables& tables_;
  const BlockMap& blocks_;
  Progress& progress_;
  std::function<bool()> cancelled_;
  std::vector<Waypoint> places_;
  TraverseMap nowhere_;
  std::vector<std::pair<std::string, std::unique_ptr<LegPlanner>>> others_;
  bool by_grid_ = true;
  std::vector<std::uint32_t> nodes_;
  std::vector<Found> found_;
  std::size_t judged_ = 0;
  std::vector<std::vector<Eigen::Vector2d>> ways_;
  std::atomic<int> done_{0};
  int work_ = 1;
  FarProposal out_;
};

}  // namespace

FarProposal propose_far_routes(const PlanProblem& problem, std::span<const PlannerRow> planners,
                               const KeepOut& keep_out, const GroundTables& tables, Progress& progress) {
  StageProgress reading(progress, "looking over the ground", 0.0, 0.4);
  const BlockMap blocks(problem, keep_out, reading);
  StageProgress searching(progress, "proposing routes", 0.4, 1.0);
  FarProposal none{.proposal = {.candidates = {}, .differences = Differences(problem.rover->body_width_m)},
                   .map = nullptr,
                   .no_way = {}};
  if (progress.cancelled() || blocks.is_damaged()) return none;
  return FarProposer(problem, planners, keep_out, tables, blocks, searching).run();
}

}  // namespace slipway::planner
