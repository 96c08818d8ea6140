#pragma once

#include <cstdint>
#include <vector>

#include "planner/search/block_map.h"
#include "planner/search/traverse_map.h"

// Between the blocks of a search over any distance and the finest cells that it holds of them.
namespace slipway::planner {

// The blocks within so many of any of these blocks or places, in the order of their numbers.
std::vector<std::uint32_t> blocks_around(const dem::GridGeometry& g, const std::vector<std::uint32_t>& blocks,
                                         int reach);
std::vector<std::uint32_t> blocks_around(const dem::GridGeometry& g,
                                         const std::vector<Eigen::Vector2d>& places, int reach);

// The way comes to the last cells that the map holds, and there are cells to stand in beyond.
bool comes_to_edge(const BlockMap& blocks, const TraverseMap& map, const std::vector<std::size_t>& way);

// What a metre costs more in each cell of a map of blocks: the factors of the blocks, and more
// beside closed cells, so that a way through a gap keeps to its middle.
std::vector<float> cell_penalties(const TraverseMap& map, const std::vector<float>& of_blocks);

// Makes the cells beside ground that rises under the body dearer: heights run on between cells, so that a
// wheel may come to stand on the foot of a wall in the last open cell.
void keep_off_rises(const TraverseMap& map, std::vector<float>& factors);

}  // namespace slipway::planner
