#include "gap/diagnosis/describe/unexplained.h"

#include <algorithm>
#include <cmath>

#include "core/normal_interval.h"

namespace slipway::gap {
namespace {

constexpr std::size_t kMostShapes = 5;

}  // namespace

std::vector<ResidualShape> describe_unexplained(const PreparedCampaign& prepared,
                                                const FittedExplanation& fit) {
  const DiscrepancyEstimate found = estimate_discrepancy(fit, *prepared.noise, prepared.discrepancy);
  const Eigen::VectorXd squares =
      (prepared.noise->whiten(prepared.discrepancy.values) * found.mean.asDiagonal()).colwise().squaredNorm();
  const double all = squares.sum();
  if (!(all > 0.0)) return {};
  std::vector<Eigen::Index> order(static_cast<std::size_t>(squares.size()));
  for (std::size_t c = 0; c < order.size(); ++c) order[c] = static_cast<Eigen::Index>(c);
  std::stable_sort(order.begin(), order.end(),
                   [&](Eigen::Index a, Eigen::Index b) { return squares[a] > squares[b]; });
  order.resize(std::min(order.size(), kMostShapes));
  std::vector<ResidualShape> shapes;
  for (const Eigen::Index c : order) {
    const DiscrepancyTerm::Column& column = prepared.discrepancy.columns[static_cast<std::size_t>(c)];
    ResidualShape shape{column.entry, column.variable, squares[c] / all, {}};
    // A coefficient is linear in its variable: two ends and the middle say its shape.
    for (const double at : {-1.0, 0.0, 1.0}) {
      const double times = column.variable == "constant" ? 1.0 : at;
      const double value = times * found.mean[c], reach = kReach90 * std::abs(times) * found.error[c];
      shape.shape.push_back({at, {value, value - reach, value + reach}});
    }
    shapes.push_back(std::move(shape));
  }
  return shapes;
}

}  // namespace slipway::gap
