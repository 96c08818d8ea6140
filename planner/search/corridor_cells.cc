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

std::vector<std::uint32_t> blocks_around(const dem::GridGeometry& g, const std::vector<std::uint32_t>& blocks,
                                         int reach) {
  std::vector<std::uint32_t> around;
  for (std::size_t k = 0; k < blocks.size(); ++k)
    if (k == 0 || blocks[k] != blocks[k - 1])
      for_blocks_about(g, blocks[k], reach, [&](std::uint32_t block) { around.push_back(block); });
  std::sort(around.begin(), around.end());
  around.erase(std::unique(around.begin(), around.end()), around.end());
  return around;
}

std::vector<std::uint32_t> blocks_around(const dem::GridGeometry& g,
                                         const std::vector<Eigen::Vector2d>& places, int reach) {
  std::vector<std::uint32_t> blocks;
  for (const Eigen::Vector2d& p : places)
    if (const long long cell = grid_index(g, p.x(), p.y()); cell >= 0)
      blocks.push_back(block_at(g, cell / g.columns, cell % g.columns));
  return blocks_around(g, blocks, reach);
}

bool comes_to_edge(const BlockMap& blocks, const TraverseMap& map, const std::vector<std::size_t>& way) {
  const dem::GridGeometry& g = map.geometry();
  for (const std::size_t cell : way) {
    const dem::Cell at = map.place_of(cell);
    for (const auto& [down, right] : {std::pair{-1, 0}, {1, 0}, {0, -1}, {0, 1}}) {
      const long long row = at.row + down, column = at.column + right;
      if (row < 0 || column < 0 || row >= g.rows || column >= g.columns || map.index_of(row, column) >= 0)
        continue;
      if (blocks.has_nodes(block_at(g, row, column))) return true;
    }
  }
  return false;
}

std::vector<float> cell_penalties(const TraverseMap& map, const std::vector<float>& of_blocks) {
  std::vector<float> factors(map.cells(), 0.0F);
  for (std::size_t first = 0; first < factors.size(); first += kCellsOfBlock) {
    const dem::Cell at = map.place_of(first);
    std::fill_n(factors.begin() + static_cast<std::ptrdiff_t>(first), kCellsOfBlock,
                of_blocks[block_at(map.geometry(), at.row, at.column)]);
  }
  for (std::size_t cell = 0; cell < factors.size(); ++cell)
    if (!is_open(map.cell(cell).passage)) charge_beside(map, map.place_of(cell), kBesideClosed, factors);
  keep_off_rises(map, factors);
  return factors;
}

void keep_off_rises(const TraverseMap& map, std::vector<float>& factors) {
  for (std::size_t cell = 0; cell < factors.size(); ++cell)
    if (map.cell(cell).passage == Passage::kRough)
      charge_beside(map, map.place_of(cell), kBesideRise, factors);
}

}  // namespace slipway::planner
