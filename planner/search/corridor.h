#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "planner/search/block_map.h"
#include "planner/search/grid_search.h"

namespace slipway::planner {

// What a metre costs in the nodes of a block map (see BlockMap::costs()), found when a node is first asked
// for: a search looks at few of a large map's nodes. For one thread.
class NodeCosts {
 public:
  // Both outlive this.
  NodeCosts(const BlockMap& blocks, const MotionCost& cost)
      : blocks_(blocks),
        cost_(cost),
        costs_(new std::array<float, 8>[blocks.nodes()]),
        known_(blocks.nodes(), 0) {}

  const std::array<float, 8>& of(std::size_t node) {
    if (known_[node] == 0) {
      costs_[node] = blocks_.costs(node, cost_);
      known_[node] = 1;
    }
    return costs_[node];
  }
  double least() const { return cost_.least_per_metre(); }

 private:
  const BlockMap& blocks_;
  const MotionCost& cost_;
  std::unique_ptr<std::array<float, 8>[]> costs_;  // of nodes that were not asked for: not even written
  std::vector<std::uint8_t> known_;
};

// Where ways through the blocks may run well: the cost of the cheapest way over each node, from one node to
// another.
class Corridor {
 public:
  // `penalty`: each metre in a block costs (1 + penalty[block]) times as much.
  Corridor(const BlockMap& blocks, NodeCosts& costs, const std::vector<float>& penalty, std::uint32_t from,
           std::uint32_t to, const std::function<bool()>& cancelled);

  // A way leads there. Where the ground holds the rover in one direction alone the cells may have none.
  bool leads() const { return leads_; }
  // The blocks of the cheapest ways, at least `least` of them where ways worth looking at pass so many, with
  // the ring of blocks around them; in the order of their numbers.
  std::vector<std::uint32_t> blocks(std::size_t least) const;
  // So many that no more are worth looking at.
  std::size_t most() const { return order_.size(); }

 private:
  // The cost between the origin and each node; `at_least` is what the rest of a way costs at the least, of
  // which nodes are left out that only ways pass which are not worth looking at.
  template <class AtLeast>
  std::vector<float> spread(std::uint32_t origin, std::uint32_t end, bool to_go,
                            const AtLeast& at_least) const;
  // Of a step between two nodes side by side, driven in a direction of GridSearch.
  float cost_of(std::uint32_t node, const BlockMap::Edge& edge, int driven) const;

  const BlockMap& blocks_;
  NodeCosts& costs_;
  const std::vector<float>& penalty_;
  std::array<float, kGridSteps> half_length_m_;  // of a step
  const std::function<bool()>& cancelled_;
  bool leads_ = false;
  std::vector<std::uint32_t> order_;  // nodes, those of the cheapest ways first
};

// How much of the ground can be reached from a node, and how near it comes to another.
struct Reach {
  bool leads = false;  // to the other
  double area_m2 = 0.0;
  double gap_m = 0.0;           // between the nearest two blocks; 0 within one
  Eigen::Vector2d here, there;  // their middles
};
Reach reach_of(const BlockMap& blocks, std::uint32_t from, std::uint32_t to);

}  // namespace slipway::planner
