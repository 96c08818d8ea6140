#include "planner/search/select_routes.h"

#include <algorithm>
#include <utility>

#include "planner/search/overlap.h"

namespace slipway::planner {
namespace {

// Extends `chosen` with candidates from order[from] on until it has `wanted`; the first that works is the
// best one. The first of all is one of the first `leaders`.
bool extend(const Differences& differences, const std::vector<std::size_t>& order, std::size_t from,
            std::size_t leaders, std::size_t wanted, std::vector<std::size_t>& chosen) {
  if (chosen.size() == wanted) return true;
  const std::size_t end = chosen.empty() ? std::min(leaders, order.size()) : order.size();
  for (std::size_t i = from; i < end && i + (wanted - chosen.size()) <= order.size(); ++i) {
    const bool differs = std::all_of(chosen.begin(), chosen.end(),
                                     [&](std::size_t other) { return differences.differ(order[i], other); });
    if (!differs) continue;
    chosen.push_back(order[i]);
    if (extend(differences, order, i + 1, leaders, wanted, chosen)) return true;
    chosen.pop_back();
  }
  return false;
}

}  // namespace

void Differences::add(std::vector<Eigen::Vector2d> centreline) {
  std::vector<double> row;
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    const double share =
        std::max(overlap(centreline, lines_[i], width_m_), overlap(lines_[i], centreline, width_m_));
    row.push_back(share);
    shared_[i].push_back(share);
  }
  row.push_back(1.0);
  shared_.push_back(std::move(row));
  lines_.push_back(std::move(centreline));
}

bool Differences::differ(std::size_t a, std::size_t b) const {
  return shared_[a][b] <= kMaxOverlap;
}

std::size_t as_good_as_best(const std::vector<double>& rising_costs) {
  std::size_t count = 0;
  while (count < rising_costs.size() &&
         (count == 0 || rising_costs[count] <= (1.0 + kAsGoodAsBest) * rising_costs.front()))
    ++count;
  return count;
}

std::vector<std::size_t> select_routes(const Differences& differences, const std::vector<std::size_t>& order,
                                       std::size_t leaders, std::size_t wanted) {
  for (std::size_t size = std::min(wanted, order.size()); size > 0; --size) {
    std::vector<std::size_t> chosen;
    if (extend(differences, order, 0, leaders, size, chosen)) return chosen;
  }
  return {};
}

}  // namespace slipway::planner
