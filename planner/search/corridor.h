#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "planner/search/block_map.h"

namespace slipway::planner {

// Where ways through the blocks may run well: the cost of the cheapest way over each node, from one node to
// another.
class Corridor {
 public:
  // `costs`: of BlockMap::costs(). `penalty`: each metre in a block costs (1 + penalty[block]) times as much;
  // empty: none does.
  Corridor(const BlockMap& blocks, const std::vector<std::array<float, 8>>& costs,
           const std::vector<float>& penalty, std::uint32_t from, std::uint32_t to,
           const std::function<bool()>& cancelled);

  // A way leads there. Where the ground holds the rover in one direction alone the cells may have none.
  bool leads() const { return leads_; }
  // The blocks of the cheapest ways, at least `least` of them where ways worth looking at pass so many, with
  // the ring of blocks around them; in the order of their numbers.
  std::vector<std::uint32_t> blocks(std::size_t least) const;
  // So many that no more are worth looking at.
  std::size_t most() const { return order_.size(); }

 private:
  std::vector<float> spread(std::uint32_t origin, std::uint32_t end, bool to_go) const;

  const BlockMap& blocks_;
  const std::vector<std::array<float, 8>>& costs_;
  const std::vector<float>& penalty_;
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
