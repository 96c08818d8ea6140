#include "planner/search/corridor_cells.h"

#include <algorithm>
#include <utility>

namespace slipway::planner {
namespace {

constexpr std::size_t kCellsOfBlock = static_cast<std::size_t>(kBlockCells) * kBlockCells;
// What a metre beside closed ground costs more, and beside ground that is closed because it rises under the
// body.
constexpr float kBesideClosed = 0.3F, kBesideRise = 3.0F;

void charge_beside(const TraverseMap& map, const dem::Cell& at, float charge, std::vector<float>& factors) {
  for (int row = at.row - 1; row <= at.row + 1; ++row) {
    for (int column = at.column - 1; column <= at.column + 1; ++column) {
      const long long beside = map.index_of(row, column);
      if (beside < 0) continue;
      float& factor = factors[static_cast<std::size_t>(beside)];
      factor = std::max(factor, charge);
    }
  }
}

}  // namespace

std::vector<std::uint32_t> blocks_around(const dem::GridGeometry& g,
                                         const std::vector<Eigen::Vector2d>& places, int reach) {
  const long long columns = block_columns(g), rows = (g.rows + kBlockCells - 1) / kBlockCells;
  std::vector<std::uint32_t> blocks;
  long long last = -1;
  for (const Eigen::Vector2d& p : places) {
    const long long cell = grid_index(g, p.x(), p.y());
    if (cell < 0) continue;
    const long long row = cell / g.columns / kBlockCells, column = cell % g.columns / kBlockCells;
    if (row * columns + column == last) continue;
    last = row * columns + column;
    for (long long r = std::max(0LL, row - reach); r <= std::min(rows - 1, row + reach); ++r)
      for (long long c = std::max(0LL, column - reach); c <= std::min(columns - 1, column + reach); ++c)
        blocks.push_back(static_cast<std::uint32_t>(r * columns + c));
  }
  std::sort(blocks.begin(), blocks.end());
  blocks.erase(std::unique(blocks.begin(), blocks.end()), blocks.end());
  return blocks;
}

bool comes_to_edge(const BlockMap& blocks, const TraverseMap& map, const std::vector<std::size_t>& way) {
  const dem::GridGeometry& g = map.geometry();
  const long long columns = block_columns(g);
  for (const std::size_t cell : way) {
    const dem::Cell at = map.place_of(cell);
    for (const auto& [down, right] : {std::pair{-1, 0}, {1, 0}, {0, -1}, {0, 1}}) {
      const long long row = at.row + down, column = at.column + right;
      if (row < 0 || column < 0 || row >= g.rows || column >= g.columns || map.index_of(row, column) >= 0)
        continue;
      if (blocks.has_nodes(static_cast<std::uint32_t>(row / kBlockCells * columns + column / kBlockCells)))
        return true;
    }
  }
  return false;
}

std::vector<float> cell_penalties(const TraverseMap& map, const std::vector<float>& of_blocks) {
  std::vector<float> factors(map.cells(), 0.0F);
  const long long columns = block_columns(map.geometry());
  for (std::size_t first = 0; first < factors.size(); first += kCellsOfBlock) {
    if (!of_blocks.empty()) {
      const dem::Cell at = map.place_of(first);
      std::fill_n(
          factors.begin() + static_cast<std::ptrdiff_t>(first), kCellsOfBlock,
          of_blocks[static_cast<std::size_t>(at.row / kBlockCells * columns + at.column / kBlockCells)]);
    }
  }
  for (std::size_t cell = 0; cell < factors.size(); ++cell) {
    const Passage passage = map.cell(cell).passage;
    if (passage != Passage::kFree && passage != Passage::kNearKeepOut)
      charge_beside(map, map.place_of(cell), kBesideClosed, factors);
  }
  keep_off_rises(map, factors);
  return factors;
}

void keep_off_rises(const TraverseMap& map, std::vector<float>& factors) {
  for (std::size_t cell = 0; cell < factors.size(); ++cell)
    if (map.cell(cell).passage == Passage::kRough)
      charge_beside(map, map.place_of(cell), kBesideRise, factors);
}

}  // namespace slipway::planner
