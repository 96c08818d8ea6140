#include "gap/diagnosis/describe/unexplained.h"

#include <algorithm>
#include <cmath>

#include "core/normal_interval.h"

namespace slipway::gap {
namespace {

// An entry point as documents name it: a single motor's has its wheel's name behind.
std::string entry_name(const DiscrepancyTerm::Column& column, const sim::RoverModel& rover) {
  std::string name(name_of(column.entry));
  if (column.wheel >= 0) name += "_" + rover.wheels[static_cast<std::size_t>(column.wheel)].name;
  return name;
}

}  // namespace

std::vector<std::pair<double, Interval>> shape_of(Circumstance circumstance, double mean, double error) {
  std::vector<std::pair<double, Interval>> shape;
  for (const double at : {-1.0, 0.0, 1.0}) {
    const double times = circumstance == Circumstance::kConstant ? 1.0 : at;
    const double value = times * mean, reach = kReach90 * std::abs(times) * error;
    shape.push_back({at, {value, value - reach, value + reach}});
  }
  return shape;
}

std::vector<ResidualShape> describe_unexplained(const PreparedCampaign& prepared,
                                                const FittedExplanation& fit,
                                                const DiagnosisOptions& options) {
  const DiscrepancyTerm& term = prepared.discrepancy;
  const DiscrepancyEstimate found =
      estimate_discrepancy(fit, whitened(fit, *prepared.noise, term), options.discrepancy,
                           [&] { return prepared.model->cancelled(); });
  const Eigen::VectorXd squares =
      (prepared.noise->whiten(term.values) * found.mean.asDiagonal()).colwise().squaredNorm();
  const double all = squares.sum();
  if (!(all > 0.0)) return {};
  std::vector<Eigen::Index> order(static_cast<std::size_t>(squares.size()));
  for (std::size_t c = 0; c < order.size(); ++c) order[c] = static_cast<Eigen::Index>(c);
  std::stable_sort(order.begin(), order.end(),
                   [&](Eigen::Index a, Eigen::Index b) { return squares[a] > squares[b]; });
  order.resize(std::min(order.size(), static_cast<std::size_t>(options.verdict.max_unexplained_shapes)));
  std::vector<ResidualShape> shapes;
  for (const Eigen::Index c : order) {
    const DiscrepancyTerm::Column& column = term.columns[static_cast<std::size_t>(c)];
    shapes.push_back({entry_name(column, *prepared.model->campaign().rover),
                      std::string(name_of(column.circumstance)), squares[c] / all,
                      shape_of(column.circumstance, found.mean[c], found.error[c])});
  }
  return shapes;
}

}  // namespace slipway::gap
