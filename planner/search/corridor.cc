#include "planner/search/corridor.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "planner/search/corridor_cells.h"
#include "planner/search/graph_search.h"

namespace slipway::planner {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
// Of the cheapest way: over dearer nodes no way is looked for.
constexpr float kWorst = 1.5F;
// Sums are in floats: a little above the bound none is left out that rounding put there.
constexpr float kRounding = 1.0001F;

// In a step's direction; between two of the eight their mean.
float per_metre(const std::array<float, 8>& costs, int step) {
  const auto k = static_cast<std::size_t>(step / 2);
  return step % 2 == 0 ? costs[k] : 0.5F * (costs[k] + costs[(k + 1) % 8]);
}

}  // namespace

Corridor::Corridor(const BlockMap& blocks, NodeCosts& costs, const std::vector<float>& penalty,
                   std::uint32_t from, std::uint32_t to, const std::function<bool()>& cancelled)
    : blocks_(blocks),
      costs_(costs),
      penalty_(penalty),
      half_length_m_(GridSearch::half_lengths_m(blocks.geometry())),
      cancelled_(cancelled) {
  const dem::GridGeometry& g = blocks.geometry();
  for (float& half : half_length_m_) half *= kBlockCells;
  // First with the straight line at the least cost of a metre as what is left, then with what is left indeed.
  const long long columns = block_columns(g), start = blocks.block_of(from);
  const std::vector<float> to_go = spread(to, from, true, [&](std::uint32_t node) {
    const long long block = blocks.block_of(node);
    const double up = static_cast<double>(block / columns - start / columns) * g.cell_y_m,
                 right = static_cast<double>(block % columns - start % columns) * g.cell_x_m;
    return static_cast<float>(costs.least() * kBlockCells * std::sqrt(up * up + right * right));
  });
  leads_ = to_go[from] < kInfinity;
  if (!leads_ || cancelled_()) return;
  const std::vector<float> to_come = spread(from, to, false, [&](std::uint32_t node) { return to_go[node]; });
  std::vector<float> sum(blocks.nodes());
  for (std::uint32_t node = 0; node < sum.size(); ++node) {
    sum[node] = to_come[node] + to_go[node];
    if (sum[node] <= kWorst * to_go[from]) order_.push_back(node);
  }
  std::sort(order_.begin(), order_.end(),
            [&](std::uint32_t a, std::uint32_t b) { return sum[a] < sum[b] || (sum[a] == sum[b] && a < b); });
}

float Corridor::cost_of(std::uint32_t node, const BlockMap::Edge& edge, int driven) const {
  const float here = per_metre(costs_.of(node), driven), there = per_metre(costs_.of(edge.to), driven);
  const float dearer = here * penalty_[blocks_.block_of(node)] + there * penalty_[blocks_.block_of(edge.to)];
  return half_length_m_[edge.step] * (here + there + dearer);
}

template <class AtLeast>
std::vector<float> Corridor::spread(std::uint32_t origin, std::uint32_t end, bool to_go,
                                    const AtLeast& at_least) const {
  std::vector<float> cost(blocks_.nodes(), kInfinity);
  search_best_first(
      cost, origin, [&](std::uint32_t node, float sum) { return sum + at_least(node); },
      [&](std::uint32_t, float whole) { return whole > kRounding * kWorst * cost[end]; },
      [&](std::uint32_t node, const auto& reach) {
        for (const BlockMap::Edge* edge = blocks_.begin(node); edge != blocks_.end(node); ++edge)
          reach(edge->to, cost[node] + cost_of(node, *edge, to_go ? opposite(edge->step) : edge->step));
      },
      cancelled_);
  return cost;
}

std::vector<std::uint32_t> Corridor::blocks(std::size_t least) const {
  std::vector<std::uint32_t> held;
  for (std::size_t k = 0; k < std::min(least, order_.size()); ++k)
    held.push_back(blocks_.block_of(order_[k]));
  return blocks_around(blocks_.geometry(), held, 1);
}

Reach reach_of(const BlockMap& blocks, std::uint32_t from, std::uint32_t to) {
  const auto leave = [&](std::size_t node, const auto& reach) {
    for (const BlockMap::Edge* edge = blocks.begin(node); edge != blocks.end(node); ++edge) reach(edge->to);
  };
  const std::vector<std::uint8_t> here = reachable(blocks.nodes(), from, leave),
                                  there = reachable(blocks.nodes(), to, leave);
  const dem::GridGeometry& g = blocks.geometry();
  Reach reach;
  reach.leads = here[to] != 0;
  long long cells = 0;
  for (std::size_t node = 0; node < here.size(); ++node)
    if (here[node] != 0) cells += blocks.cells(node);
  reach.area_m2 = static_cast<double>(cells) * g.cell_x_m * g.cell_y_m;

  // The nearest block of the others, by rings of blocks from all of ours at once.
  constexpr auto kNone = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> source(blocks.blocks(), kNone);
  std::vector<std::uint8_t> is_there(blocks.blocks(), 0);
  std::vector<std::uint32_t> ring, next;
  for (std::size_t node = 0; node < here.size(); ++node) {
    const std::uint32_t block = blocks.block_of(node);
    if (there[node] != 0) is_there[block] = 1;
    if (here[node] == 0 || source[block] != kNone) continue;
    source[block] = block;
    ring.push_back(block);
  }
  while (!ring.empty()) {
    next.clear();
    for (const std::uint32_t block : ring) {
      if (is_there[block] != 0) {
        reach.here = blocks.centre_m(source[block]);
        reach.there = blocks.centre_m(block);
        reach.gap_m = (reach.here - reach.there).norm();
        return reach;
      }
      for_blocks_about(g, block, 1, [&](std::uint32_t beside) {
        if (source[beside] != kNone) return;
        source[beside] = source[block];
        next.push_back(beside);
      });
    }
    ring.swap(next);
  }
  return reach;
}

}  // namespace slipway::planner
