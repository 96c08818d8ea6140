#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/progress.h"
#include "planner/problem/problem.h"
#include "planner/search/motion_cost.h"
#include "planner/search/traverse_map.h"

namespace slipway::planner {

// The whole terrain in blocks of kBlockCells x kBlockCells of a search's finest cells. The cells of a block
// that the rover may stand in fall into parts that hang together over their edges; a part is a node,
// and two nodes are joined where cells of theirs touch. So the blocks know every wall and every gap that the
// cells have, a gap of one cell too; what they know roughly is cost, from a sample of 16 cells of each block.
//
// Built in one pass over the terrain, which keeps none of its cells: some 250 bytes a block, 1 byte a cell.
class BlockMap {
 public:
  // Parallel over stripes. Of no use where it was cancelled.
  BlockMap(const PlanProblem& problem, const KeepOut& keep_out, Progress& progress);

  const dem::GridGeometry& geometry() const { return geometry_; }  // of the cells
  std::size_t blocks() const { return blocks_.size(); }
  std::size_t nodes() const { return block_of_.size(); }
  std::uint32_t block_of(std::size_t node) const { return block_of_[node]; }
  Eigen::Vector2d centre_m(std::uint32_t block) const;
  // The node of the cell that holds the place; nothing where the rover may not stand there.
  std::optional<std::uint32_t> node_at(double x_m, double y_m) const;
  // The nodes of a block follow one another.
  std::uint32_t first_node(std::uint32_t block) const { return first_node_[block]; }
  bool has_nodes(std::uint32_t block) const { return first_node_[block + 1] > first_node_[block]; }
  // Cells of a node.
  int cells(std::size_t node) const { return cells_[node]; }
  // The place could not be read.
  bool is_damaged() const { return damaged_; }

  struct Edge {
    std::uint32_t to = 0;
    std::uint8_t step = 0;  // of GridSearch, in blocks
  };
  const Edge* begin(std::size_t node) const { return edges_.data() + first_edge_[node]; }
  const Edge* end(std::size_t node) const { return edges_.data() + first_edge_[node + 1]; }

  // What a metre costs in a node, driven in eight directions counter-clockwise from east: the mean over its
  // sample, more where a share of it can't be driven so. Nowhere infinite, and nowhere less than
  // MotionCost::least_per_metre().
  std::array<float, 8> costs(std::size_t node, const MotionCost& cost) const;

 private:
  static constexpr int kSamples = 16;
  // A cell of a block's sample.
  struct Sample {
    float gradient_x = 0.0F, gradient_y = 0.0F;
    std::uint8_t soil = kUnknownSoil;
    std::uint8_t part = 0;  // 0: closed
  };
  struct Block {
    std::array<Sample, kSamples> samples;
    // The parts of the cells at its edges, east, north, west and south, each from the west or the north.
    std::array<std::array<std::uint8_t, kBlockCells>, 4> edges{};
    std::uint8_t parts = 0;
  };
  // Of a cell of a node in the pass.
  using Parts = std::array<std::uint8_t, kBlockCells * kBlockCells>;

  void read_stripe(const PlanProblem& problem, const GroundJudge& judge, long long first_block_row,
                   long long block_rows);
  static int label(const GroundCell* cells, const dem::CellWindow& window, Parts& parts,
                   std::vector<std::uint16_t>& sizes);
  void number_nodes();
  void join(std::size_t threads, const Progress& progress);
  void touching(std::size_t node, int side, std::vector<std::uint32_t>& to) const;
  std::uint32_t node_of(std::uint32_t block, std::uint8_t part) const {
    return first_node_[block] + part - 1;
  }

  dem::GridGeometry geometry_;
  const PlanProblem& problem_;
  const KeepOut& keep_out_;
  long long block_rows_, block_columns_;
  std::vector<Block> blocks_;
  std::vector<std::vector<std::uint16_t>> sizes_;  // of the parts of each block, in the pass
  std::vector<std::uint32_t> first_node_;          // of each block
  std::vector<std::uint32_t> block_of_;            // of each node
  std::vector<std::uint16_t> cells_;
  std::vector<std::uint32_t> first_edge_;
  std::vector<Edge> edges_;
  std::atomic<bool> damaged_{false};
};

}  // namespace slipway::planner
