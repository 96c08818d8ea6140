#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "dem/grid_geometry.h"
#include "dem/terrain.h"
#include "planner/problem/keep_out.h"
#include "planner/problem/problem.h"

namespace slipway::planner {

// Why no route passes over a cell, or how it may.
enum class Passage : std::uint8_t {
  kFree,         // of keep-outs: the body meets none at any place and heading in the cell
  kNearKeepOut,  // depends on place and heading: ask KeepOut
  kNoData,       // missing elevation, or the map's edge, nearer than the body's circumscribed circle
  kSteep,        // steeper than the tilt limit at any heading
  kRough,        // the ground under the body rises above the belly
  kKeepOut,      // at the cell's centre the body meets a keep-out at every heading
};

// The search's cell: the ground as a plane over the rover's footprint. Where a cell covers several of the
// terrain's, tilt, rise and missing elevation are the worst over all of these, so that no rock in it is
// overlooked; only a cell that holds a place of the problem is judged at that place, where the rover must
// stand.
struct GroundCell {
  float gradient_x = 0.0F;  // rise per metre towards east, about the cell's centre
  float gradient_y = 0.0F;  // rise per metre towards north
  float tilt_rad = 0.0F;    // the greatest of any footprint's plane
  float rise_m = 0.0F;      // the greatest height of the ground above a footprint's plane
  std::uint8_t soil = 0;    // index of the ground table; kUnknownSoil for unknown ground
  Passage passage = Passage::kFree;
};

constexpr std::uint8_t kUnknownSoil = 255;

// More cells than this are never searched: a larger window gets larger cells, in whole numbers of the
// terrain's.
constexpr long long kMaxSearchCells = 500'000;

// What a search looks at: around all places of the problem, with room for detours of half the longest leg
// times `rooms`.
dem::Extent search_extent(const PlanProblem& problem, double rooms = 1.0);

// The search's view of the ground, built once per problem and immutable after. Slopes are least-squares
// planes over a square as wide as the rover, or three terrain cells where those are wider: what the
// simulator's stance averages over the wheels too.
class TraverseMap {
 public:
  // The cells of the terrain that meet `extent`.
  TraverseMap(const PlanProblem& problem, const KeepOut& keep_out, const dem::Extent& extent);

  const dem::GridGeometry& geometry() const { return geometry_; }
  double cell_m() const { return std::min(geometry_.cell_x_m, geometry_.cell_y_m); }  // the shorter side
  std::size_t cells() const { return cells_.size(); }
  // -1 outside.
  long long index_at(double x_m, double y_m) const;
  const GroundCell& cell(std::size_t index) const { return cells_[index]; }
  Eigen::Vector2d centre_m(std::size_t index) const;
  // Nothing forbids the pose but what depends on soil and slope together. False outside the map.
  bool may_stand(const Pose2& pose) const;
  const KeepOut& keep_out() const { return keep_out_; }

 private:
  GroundCell cell_of(const PlanProblem& problem, const Eigen::Vector2d& centre) const;
  void judge_ground(const PlanProblem& problem, const std::vector<Eigen::Vector2d>& places,
                    GroundCell& cell) const;
  // Of the terrain's cells in the search cell about a place, or the place itself where they are as large.
  std::vector<Eigen::Vector2d> judged_places(const PlanProblem& problem, const Eigen::Vector2d& centre) const;

  dem::GridGeometry geometry_;
  const KeepOut& keep_out_;
  std::vector<GroundCell> cells_;
};

}  // namespace slipway::planner
