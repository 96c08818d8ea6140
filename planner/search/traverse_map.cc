#include "planner/search/traverse_map.h"

#include <algorithm>
#include <cmath>

#include "core/parallel_for.h"

namespace slipway::planner {
namespace {

// Of the terrain, where all of it is judged by stripes.
constexpr long long kRowsAtOnce = 64;

// Of the terrain's cells, in whole numbers of which a search's cell is as wide.
int finest_step(double cell_m) {
  return std::max(1, static_cast<int>(std::floor(kFinestCell_m / cell_m + 1e-9)));
}

// The same ground in cells of so many.

dem::GridGeometry in_cells_of(dem::GridGeometry geometry, int step_x, int step_y) {
  geometry.rows = (geometry.rows + step_y - 1) / step_y;
  geometry.columns = (geometry.columns + step_x - 1) / step_x;
  geometry.cell_x_m *= step_x;
  geometry.cell_y_m *= step_y;
  return geometry;
}

}  // namespace

dem::GridGeometry search_geometry(const dem::GridGeometry& terrain, const dem::Extent& extent,
                                  long long max_cells) {
  const dem::CellWindow window =
      terrain.window(extent).value_or(dem::CellWindow{0, 0, terrain.rows, terrain.columns});
  const dem::GridGeometry geometry = terrain.sub(window);
  int step_x = finest_step(geometry.cell_x_m), step_y = finest_step(geometry.cell_y_m);
  dem::GridGeometry cells = in_cells_of(geometry, step_x, step_y);
  while (static_cast<long long>(cells.rows) * cells.columns > max_cells) {
    // The shorter side grows, both where they are equal.
    const double x_m = step_x * geometry.cell_x_m, y_m = step_y * geometry.cell_y_m;
    if (x_m <= y_m) ++step_x;
    if (y_m <= x_m) ++step_y;
    cells = in_cells_of(geometry, step_x, step_y);
  }
  return cells;
}

bool in_finest_cells(const dem::GridGeometry& terrain, const dem::Extent& extent) {
  const dem::GridGeometry cells = search_geometry(terrain, extent), finest = finest_geometry(terrain);
  return cells.cell_x_m == finest.cell_x_m && cells.cell_y_m == finest.cell_y_m;
}

dem::GridGeometry finest_geometry(const dem::GridGeometry& terrain) {
  return in_cells_of(terrain, finest_step(terrain.cell_x_m), finest_step(terrain.cell_y_m));
}

dem::Extent search_extent(const PlanProblem& problem, double rooms) {
  dem::Extent extent{problem.start.x_m, problem.start.y_m, problem.start.x_m, problem.start.y_m};
  for (const Waypoint& place : problem.places()) {
    extent.west_m = std::min(extent.west_m, place.x_m);
    extent.south_m = std::min(extent.south_m, place.y_m);
    extent.east_m = std::max(extent.east_m, place.x_m);
    extent.north_m = std::max(extent.north_m, place.y_m);
  }
  const std::vector<double> legs = problem.leg_lengths_m();
  const double room = rooms * std::max(60.0, 0.5 * *std::max_element(legs.begin(), legs.end()));
  return {extent.west_m - room, extent.south_m - room, extent.east_m + room, extent.north_m + room};
}

TraverseMap::TraverseMap(const PlanProblem& problem, const KeepOut& keep_out, const dem::Extent& extent)
    : geometry_(search_geometry(problem.terrain->geometry(), extent)), keep_out_(keep_out) {
  cells_.resize(static_cast<std::size_t>(geometry_.rows) * static_cast<std::size_t>(geometry_.columns));
  const GroundJudge judge(problem, keep_out_, geometry_);
  parallel_for(static_cast<std::size_t>(geometry_.rows), problem.threads, [&](std::size_t row) {
    for (int column = 0; column < geometry_.columns; ++column) {
      const std::size_t i = row * static_cast<std::size_t>(geometry_.columns) + column;
      cells_[i] = judge.cell(*problem.terrain, centre_m(i));
    }
  });
}

TraverseMap::TraverseMap(const PlanProblem& problem, const KeepOut& keep_out, long long max_cells,
                         const Progress& progress)
    : geometry_(
          search_geometry(problem.terrain->geometry(), problem.terrain->geometry().extent(), max_cells)),
      keep_out_(keep_out) {
  const dem::GridGeometry& terrain = problem.terrain->geometry();
  const auto columns = static_cast<std::size_t>(geometry_.columns);
  cells_.resize(static_cast<std::size_t>(geometry_.rows) * columns, GroundCell{.passage = Passage::kNoData});
  const GroundJudge judge(problem, keep_out_, geometry_);
  const auto step = static_cast<long long>(std::lround(geometry_.cell_y_m / terrain.cell_y_m));
  const auto rows_at_once = static_cast<int>(std::max(1LL, kRowsAtOnce / step));
  const int stripes = (geometry_.rows + rows_at_once - 1) / rows_at_once;
  parallel_for(static_cast<std::size_t>(stripes), problem.threads, [&](std::size_t stripe) {
    if (progress.cancelled()) return;
    const int row = static_cast<int>(stripe) * rows_at_once;
    const int rows = std::min(rows_at_once, geometry_.rows - row);
    const dem::CellWindow read = judge.rows_of_terrain(row, rows);
    const auto part = problem.terrain->part(read);
    if (!part) return;
    // In squares: cells whose neighbours all have a height are judged quickly.
    for (int column = 0; column < geometry_.columns; column += kBlockCells) {
      const dem::CellWindow square{row, column, rows, std::min(kBlockCells, geometry_.columns - column)};
      judge.cells(*part, {read.row, 0}, square,
                  &cells_[static_cast<std::size_t>(row) * columns + static_cast<std::size_t>(column)],
                  columns);
    }
  });
}

TraverseMap::TraverseMap(const PlanProblem& problem, const KeepOut& keep_out,
                         std::vector<std::uint32_t> blocks, const Progress& progress)
    : geometry_(finest_geometry(problem.terrain->geometry())),
      keep_out_(keep_out),
      blocks_(std::move(blocks)),
      block_columns_(block_columns(geometry_)) {
  slots_.assign(static_cast<std::size_t>(block_rows(geometry_) * block_columns_), -1);
  for (std::size_t k = 0; k < blocks_.size(); ++k) slots_[blocks_[k]] = static_cast<std::int32_t>(k);
  cells_.resize(blocks_.size() * kBlockCells * kBlockCells, GroundCell{.passage = Passage::kNoData});
  const GroundJudge judge(problem, keep_out_, geometry_);
  parallel_for(blocks_.size(), problem.threads, [&](std::size_t slot) {
    if (progress.cancelled()) return;
    const dem::CellWindow window = block_window(geometry_, blocks_[slot]);
    judge.cells(*problem.terrain, {0, 0}, window, &cells_[slot * kBlockCells * kBlockCells], kBlockCells);
  });
}

dem::CellWindow block_window(const dem::GridGeometry& geometry, std::uint32_t block) {
  const auto row = static_cast<int>(block / block_columns(geometry)) * kBlockCells;
  const auto column = static_cast<int>(block % block_columns(geometry)) * kBlockCells;
  return {row, column, std::min(kBlockCells, geometry.rows - row),
          std::min(kBlockCells, geometry.columns - column)};
}

long long TraverseMap::index_at(double x_m, double y_m) const {
  const long long in_all = grid_index(geometry_, x_m, y_m);
  if (in_all < 0 || slots_.empty()) return in_all;
  return index_of(in_all / geometry_.columns, in_all % geometry_.columns);
}

dem::Cell TraverseMap::place_of(std::size_t index) const {
  if (!holds_blocks()) {
    const auto columns = static_cast<std::size_t>(geometry_.columns);
    return {static_cast<int>(index / columns), static_cast<int>(index % columns)};
  }
  const auto block = static_cast<long long>(blocks_[index / (kBlockCells * kBlockCells)]);
  const auto in_block = static_cast<int>(index % (kBlockCells * kBlockCells));
  return {static_cast<int>(block / block_columns_) * kBlockCells + in_block / kBlockCells,
          static_cast<int>(block % block_columns_) * kBlockCells + in_block % kBlockCells};
}

bool TraverseMap::may_stand(const Pose2& pose) const {
  const long long i = index_at(pose.x_m, pose.y_m);
  if (i < 0) return false;
  const Passage passage = cells_[static_cast<std::size_t>(i)].passage;
  return passage == Passage::kFree || (passage == Passage::kNearKeepOut && !keep_out_.hits(pose));
}

}  // namespace slipway::planner
