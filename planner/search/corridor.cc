#include "planner/search/corridor.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>

namespace slipway::planner {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
// Of the cheapest way: over dearer nodes no way is looked for.
constexpr float kWorst = 1.5F;
constexpr std::size_t kBetweenAsking = 1U << 13U;

// Sums are in floats: a little above the bound none is left out that rounding put there.
constexpr float kRounding = 1.0001F;

struct Reached {
  float whole, cost;  // of a way through the node at the least; so far
  std::uint32_t node;
  bool operator>(const Reached& other) const {
    return whole > other.whole || (whole == other.whole && node > other.node);
  }
};

// In a step's direction; between two of the eight their mean.
float per_metre(const std::array<float, 8>& costs, int step) {
  const auto k = static_cast<std::size_t>(step / 2);
  return step % 2 == 0 ? costs[k] : 0.5F * (costs[k] + costs[(k + 1) % 8]);
}

}  // namespace

Corridor::Corridor(const BlockMap& blocks, NodeCosts& costs, const std::vector<float>& penalty,
                   std::uint32_t from, std::uint32_t to, const std::function<bool()>& cancelled)
    : blocks_(blocks), costs_(costs), penalty_(penalty), cancelled_(cancelled) {
  const dem::GridGeometry& g = blocks.geometry();
  for (std::size_t k = 0; k < kGridSteps; ++k)
    half_length_m_[k] = 0.5F * kBlockCells *
                        static_cast<float>(std::hypot(kGridDirections[k].right * g.cell_x_m,
                                                      kGridDirections[k].up * g.cell_y_m));
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
  float metre = here + there;
  if (!penalty_.empty())
    metre += here * penalty_[blocks_.block_of(node)] + there * penalty_[blocks_.block_of(edge.to)];
  return half_length_m_[edge.step] * metre;
}

template <class AtLeast>
std::vector<float> Corridor::spread(std::uint32_t origin, std::uint32_t end, bool to_go,
                                    const AtLeast& at_least) const {
  std::vector<float> cost(blocks_.nodes(), kInfinity);
  std::priority_queue<Reached, std::vector<Reached>, std::greater<>> open;
  cost[origin] = 0.0F;
  open.push({at_least(origin), 0.0F, origin});
  std::size_t looked_at = 0;
  while (!open.empty()) {
    const Reached here = open.top();
    open.pop();
    if (here.cost > cost[here.node]) continue;
    if (here.whole > kRounding * kWorst * cost[end]) break;
    if (++looked_at % kBetweenAsking == 0 && cancelled_()) break;
    for (const BlockMap::Edge* edge = blocks_.begin(here.node); edge != blocks_.end(here.node); ++edge) {
      const int driven = to_go ? (edge->step + kGridSteps / 2) % kGridSteps : edge->step;
      const float sum = here.cost + cost_of(here.node, *edge, driven);
      if (!(sum < cost[edge->to])) continue;
      cost[edge->to] = sum;
      open.push({sum + at_least(edge->to), sum, edge->to});
    }
  }
  return cost;
}

std::vector<std::uint32_t> Corridor::blocks(std::size_t least) const {
  const dem::GridGeometry& g = blocks_.geometry();
  const long long columns = block_columns(g);
  const auto rows = static_cast<long long>(blocks_.blocks()) / columns;
  std::vector<std::uint32_t> held;
  for (std::size_t k = 0; k < std::min(least, order_.size()); ++k) {
    const long long block = blocks_.block_of(order_[k]);
    for (long long row = std::max(0LL, block / columns - 1); row <= std::min(rows - 1, block / columns + 1);
         ++row)
      for (long long column = std::max(0LL, block % columns - 1);
           column <= std::min(columns - 1, block % columns + 1); ++column)
        held.push_back(static_cast<std::uint32_t>(row * columns + column));
  }
  std::sort(held.begin(), held.end());
  held.erase(std::unique(held.begin(), held.end()), held.end());
  return held;
}

Reach reach_of(const BlockMap& blocks, std::uint32_t from, std::uint32_t to) {
  const auto reached_from = [&](std::uint32_t origin) {
    std::vector<std::uint8_t> reached(blocks.nodes(), 0);
    std::vector<std::uint32_t> open{origin};
    reached[origin] = 1;
    while (!open.empty()) {
      const std::uint32_t node = open.back();
      open.pop_back();
      for (const BlockMap::Edge* edge = blocks.begin(node); edge != blocks.end(node); ++edge) {
        if (reached[edge->to] != 0) continue;
        reached[edge->to] = 1;
        open.push_back(edge->to);
      }
    }
    return reached;
  };
  const std::vector<std::uint8_t> here = reached_from(from), there = reached_from(to);
  const dem::GridGeometry& g = blocks.geometry();
  Reach reach;
  reach.leads = here[to] != 0;
  long long cells = 0;
  for (std::size_t node = 0; node < here.size(); ++node)
    if (here[node] != 0) cells += blocks.cells(node);
  reach.area_m2 = static_cast<double>(cells) * g.cell_x_m * g.cell_y_m;

  // The nearest block of the others, by rings of blocks from all of ours at once.
  const long long columns = block_columns(g);
  const auto rows = static_cast<long long>(blocks.blocks()) / columns;
  std::vector<std::uint32_t> source(blocks.blocks(), std::numeric_limits<std::uint32_t>::max());
  std::vector<std::uint8_t> is_there(blocks.blocks(), 0);
  std::vector<std::uint32_t> ring, next;
  for (std::size_t node = 0; node < here.size(); ++node) {
    const std::uint32_t block = blocks.block_of(node);
    if (there[node] != 0) is_there[block] = 1;
    if (here[node] == 0 || source[block] != std::numeric_limits<std::uint32_t>::max()) continue;
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
      for (long long dr = -1; dr <= 1; ++dr) {
        for (long long dc = -1; dc <= 1; ++dc) {
          const long long row = block / columns + dr, column = block % columns + dc;
          if (row < 0 || column < 0 || row >= rows || column >= columns) continue;
          const auto beside = static_cast<std::size_t>(row * columns + column);
          if (source[beside] != std::numeric_limits<std::uint32_t>::max()) continue;
          source[beside] = source[block];
          next.push_back(static_cast<std::uint32_t>(beside));
        }
      }
    }
    ring.swap(next);
  }
  return reach;
}

}  // namespace slipway::planner
