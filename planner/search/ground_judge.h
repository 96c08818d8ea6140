#pragma once

#include <Eigen/Core>
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

// The rover's centre may be there, at some heading at least.
constexpr bool is_open(Passage passage) {
  return passage == Passage::kFree || passage == Passage::kNearKeepOut;
}

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

// -1 outside; the south and east edges are simply outside.
inline long long grid_index(const dem::GridGeometry& g, double x_m, double y_m) {
  // On the search's hot path: no optional.
  const double column = (x_m - g.west_m) / g.cell_x_m;
  const double row = (g.north_m - y_m) / g.cell_y_m;
  if (!(column >= 0.0 && row >= 0.0 && column < g.columns && row < g.rows)) return -1;
  return static_cast<long long>(row) * g.columns + static_cast<long long>(column);
}

// Finer than any rover of interest steers.
constexpr double kFinestCell_m = 0.25;

// Judges the cells of a search on the ground. Keeps references to what it is made of.
class GroundJudge {
 public:
  // `geometry`: the search's cells.
  GroundJudge(const PlanProblem& problem, const KeepOut& keep_out, const dem::GridGeometry& geometry);

  // The cell about a centre. `terrain`: the problem's, or a part of it that reaches margin() cells beyond.
  GroundCell cell(const dem::Terrain& terrain, const Eigen::Vector2d& centre) const;
  // The same, up to rounding, of a window of the search's cells, into rows that are `stride` apart; quick
  // where no elevation is missing. `first`: which cell of the whole terrain is the first of `terrain`.
  void cells(const dem::Terrain& terrain, const dem::Cell& first, const dem::CellWindow& window,
             GroundCell* out, std::size_t stride) const;
  // The terrain's rows that rows of the search's cells need.
  dem::CellWindow rows_of_terrain(long long row, long long rows) const;
  // How many of the terrain's cells beyond its own a cell's judgement needs.
  int margin() const { return margin_; }

 private:
  void judge_ground(const dem::Terrain& terrain, const std::vector<Eigen::Vector2d>& places,
                    GroundCell& cell) const;
  // Of the terrain's cells in the search cell about a place, or the place itself where they are as large.
  std::vector<Eigen::Vector2d> judged_places(const Eigen::Vector2d& centre) const;
  // Which of the terrain's cells along a side of a search's cell are judged: so far apart that their
  // footprints still cover all between them, the outermost ones included.
  static std::vector<int> judged_cells(int along, int reach);
  // A place of the problem is in the search's cell about this centre.
  bool holds_a_place(const Eigen::Vector2d& centre) const;
  // The worst of the judged cells of a search's cell, of whose first one the height is given.
  void judge_planes(const float* height, std::ptrdiff_t stride, GroundCell& cell) const;
  // Of a cell with elevation all around, whose height is given; rows are `stride` heights apart.
  void judge_plane(const float* height, std::ptrdiff_t stride, GroundCell& cell) const;
  void judge_quickly(double gradient_x, double gradient_y, double rise_m, GroundCell& cell) const;
  void judge_figures(double gradient_x, double gradient_y, double rise_m, GroundCell& cell) const;

  const PlanProblem& problem_;
  const KeepOut& keep_out_;
  dem::GridGeometry geometry_;
  double circumscribed_m_;  // of the body
  double max_tilt_rad_, steepest_squared_, most_rise_m_;
  int reach_x_, reach_y_;  // of a footprint to each side, in the terrain's cells
  int margin_;
  int step_x_, step_y_;                        // of a search's cell, in the terrain's
  std::vector<long long> cells_of_places_;     // of the problem, in the search's cells
  bool judges_centres_;                        // and nothing else, since they are so small
  std::vector<int> judged_right_, judged_up_;  // of these from its south-west corner, see judged_cells()
};

}  // namespace slipway::planner
