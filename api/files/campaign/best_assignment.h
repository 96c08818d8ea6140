#pragma once

#include <cstddef>
#include <vector>

namespace slipway::api {

// Which column each row is given so that no two have the same and the costs add up to least (Kuhn 1955, by
// shortest augmenting paths). `costs` is square and finite.
std::vector<std::size_t> best_assignment(const std::vector<std::vector<double>>& costs);

}  // namespace slipway::api
