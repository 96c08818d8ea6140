#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "core/progress.h"
#include "dem/grid_geometry.h"
#include "dem/terrain.h"
#include "planner/problem/keep_out.h"
#include "planner/problem/problem.h"
#include "planner/search/ground_judge.h"

namespace slipway::planner {

// More cells than this are never searched: a larger window gets larger cells, in whole numbers of the
// terrain's.
constexpr long long kMaxSearchCells = 500'000;

// What a search looks at: around all places of the problem, with room for detours of half the longest leg
// times `rooms`.
dem::Extent search_extent(const PlanProblem& problem, double rooms = 1.0);

// The cells of the terrain that meet `extent` as a search sees them: no more than `max_cells`.
dem::GridGeometry search_geometry(const dem::GridGeometry& terrain, const dem::Extent& extent,
                                  long long max_cells = kMaxSearchCells);
// These are the finest that there are.
bool in_finest_cells(const dem::GridGeometry& terrain, const dem::Extent& extent);
// All of the terrain in the finest cells of a search, however many these are.
dem::GridGeometry finest_geometry(const dem::GridGeometry& terrain);

// A map that holds only some of its cells does so in squares of this many, counted from its north-west
// corner.
constexpr int kBlockCells = 16;
// The cells of a block, which at the east and south edges may be fewer.
dem::CellWindow block_window(const dem::GridGeometry& geometry, std::uint32_t block);
// Blocks from west to east, and from north to south.
inline long long block_columns(const dem::GridGeometry& geometry) {
  return (geometry.columns + kBlockCells - 1) / kBlockCells;
}
inline long long block_rows(const dem::GridGeometry& geometry) {
  return (geometry.rows + kBlockCells - 1) / kBlockCells;
}
// The block of a cell.
inline std::uint32_t block_at(const dem::GridGeometry& geometry, long long row, long long column) {
  return static_cast<std::uint32_t>(row / kBlockCells * block_columns(geometry) + column / kBlockCells);
}
// Calls `visit` for each block within so many of one, that one included, row by row.
template <class Visit>
void for_blocks_about(const dem::GridGeometry& geometry, std::uint32_t block, int reach, const Visit& visit) {
  const long long columns = block_columns(geometry), row = block / columns, column = block % columns;
  for (long long r = std::max(0LL, row - reach); r <= std::min(block_rows(geometry) - 1, row + reach); ++r)
    for (long long c = std::max(0LL, column - reach); c <= std::min(columns - 1, column + reach); ++c)
      visit(static_cast<std::uint32_t>(r * columns + c));
}

// The search's view of the ground, built once per problem and immutable after. Slopes are least-squares
// planes over a square as wide as the rover, or three terrain cells where those are wider: what the
// simulator's stance averages over the wheels too.
//
// A map holds either all cells of its geometry, or those of some blocks. A cell's index counts the cells that
// are held; what is not held is outside, like what lies beyond the edge.
class TraverseMap {
 public:
  // The cells of the terrain that meet `extent`.
  TraverseMap(const PlanProblem& problem, const KeepOut& keep_out, const dem::Extent& extent);
  // All of the terrain in no more than `max_cells` cells, for maps of it: the same up to rounding, in a
  // fraction of the time, and of a terrain that is read by tiles no tile is kept. Cells that were not judged
  // when it was cancelled, or could not be read, have no data.
  TraverseMap(const PlanProblem& problem, const KeepOut& keep_out, long long max_cells,
              const Progress& progress);
  // Of the finest cells those in these blocks, which are numbered row by row from the north-west. Cells that
  // were not judged when it was cancelled have no data.
  TraverseMap(const PlanProblem& problem, const KeepOut& keep_out, std::vector<std::uint32_t> blocks,
              const Progress& progress);

  const dem::GridGeometry& geometry() const { return geometry_; }
  double cell_m() const { return std::min(geometry_.cell_x_m, geometry_.cell_y_m); }  // the shorter side
  std::size_t cells() const { return cells_.size(); }
  bool holds_blocks() const { return !slots_.empty(); }
  // -1 outside.
  long long index_at(double x_m, double y_m) const;
  // Of a cell of the geometry; -1 outside.
  long long index_of(long long row, long long column) const {
    if (row < 0 || column < 0 || row >= geometry_.rows || column >= geometry_.columns) return -1;
    if (slots_.empty()) return row * geometry_.columns + column;
    const std::int32_t slot =
        slots_[static_cast<std::size_t>(row / kBlockCells * block_columns_ + column / kBlockCells)];
    if (slot < 0) return -1;
    return (static_cast<long long>(slot) * kBlockCells + row % kBlockCells) * kBlockCells +
           column % kBlockCells;
  }
  // Row and column of a cell.
  dem::Cell place_of(std::size_t index) const;
  const GroundCell& cell(std::size_t index) const { return cells_[index]; }
  Eigen::Vector2d centre_m(std::size_t index) const { return geometry_.centre_m(place_of(index)); }
  // Nothing forbids the pose but what depends on soil and slope together. False outside the map.
  bool may_stand(const Pose2& pose) const;
  const KeepOut& keep_out() const { return keep_out_; }

 private:
  dem::GridGeometry geometry_;
  const KeepOut& keep_out_;
  std::vector<GroundCell> cells_;
  // Of a map of blocks: which are held, and of each block of the geometry where it is held, -1 where not.
  std::vector<std::uint32_t> blocks_;
  std::vector<std::int32_t> slots_;
  long long block_columns_ = 0;
};

}  // namespace slipway::planner
