#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <queue>
#include <vector>

namespace slipway::planner {

// Best-first search over numbered nodes [Hart et al. 1968]: writes to `cost`, infinite before, what the
// cheapest way between the origin and each node that it comes to costs.
//
//   whole(node, cost)   the least that a way over the node costs, of which `cost` is what it costs so far;
//                       with `cost` itself it is Dijkstra's search
//   ends(node, whole)   whether the search ends before it leaves the node
//   leave(node, reach)  calls reach(next, cost) for the nodes beside the node
//
// Where it was cancelled, of which it asks now and then, the costs are of no use.
template <class Cost, class Whole, class Ends, class Leave>
void search_best_first(std::vector<Cost>& cost, std::uint32_t origin, const Whole& whole, const Ends& ends,
                       const Leave& leave, const std::function<bool()>& cancelled = {}) {
  constexpr std::size_t kBetweenAsking = 1U << 13U;
  struct Reached {
    Cost whole;
    std::uint32_t node;
    // Ties by node, so that the order is one order.
    bool operator>(const Reached& other) const {
      return other.whole < whole || (!(whole < other.whole) && node > other.node);
    }
  };
  std::priority_queue<Reached, std::vector<Reached>, std::greater<>> open;
  const auto reach = [&](std::uint32_t node, const Cost& sum) {
    if (!(sum < cost[node])) return;
    cost[node] = sum;
    open.push({whole(node, sum), node});
  };
  reach(origin, Cost{});
  for (std::size_t looked_at = 1; !open.empty(); ++looked_at) {
    const Reached here = open.top();
    open.pop();
    if (whole(here.node, cost[here.node]) < here.whole) continue;  // a cheaper way leads there
    if (ends(here.node, here.whole) || (looked_at % kBetweenAsking == 0 && cancelled && cancelled())) break;
    leave(here.node, reach);
  }
}

// Which nodes can be reached from one of them; `leave(node, reach)` calls reach(next) for the nodes beside
// it.
template <class Leave>
std::vector<std::uint8_t> reachable(std::size_t nodes, std::size_t origin, const Leave& leave) {
  std::vector<std::uint8_t> reached(nodes, 0);
  std::vector<std::size_t> open;
  const auto reach = [&](std::size_t node) {
    if (reached[node] != 0) return;
    reached[node] = 1;
    open.push_back(node);
  };
  reach(origin);
  while (!open.empty()) {
    const std::size_t node = open.back();
    open.pop_back();
    leave(node, reach);
  }
  return reached;
}

}  // namespace slipway::planner
