#include "gap/diagnosis/describe/unexplained.h"

#include <algorithm>
#include <cmath>

#include "core/normal_interval.h"
#include "gap/diagnosis/model/outside_cause.h"
#include "gap/diagnosis/search/effect_trace.h"

namespace slipway::gap {
namespace {

// An entry point as documents name it: a single motor's has its wheel's name behind.
std::string entry_name(const DiscrepancyTerm::Column& column, const sim::RoverModel& rover) {
  std::string name(name_of(column.entry));
  if (column.wheel >= 0) name += "_" + rover.wheels[static_cast<std::size_t>(column.wheel)].name;
  return name;
}

// A cause from outside as a shape: its first field over what it depends on.
ResidualShape shape_of(const OutsideFinding& outside, double share) {
  const OutsideCause& cause = *find_outside(outside.cause);
  ResidualShape shape;
  shape.entry = cause.entry;
  shape.variable = cause.depends;
  shape.share = share;
  shape.form = cause.form;
  shape.words = outside.words;
  shape.unit = cause.unit;
  shape.probability = outside.probability;
  shape.closed_share = outside.closed_share;
  shape.parameters = outside.parameters;
  if (!cause.has_shape) return shape;
  const Interval& size = outside.parameters.front().value;
  for (const double at : {-1.0, 0.0, 1.0}) {
    const double times = cause.depends == "constant" ? 1.0 : at;
    shape.shape.push_back({at,
                           {times * size.value, std::min(times * size.low, times * size.high),
                            std::max(times * size.low, times * size.high)}});
  }
  return shape;
}

// Whether a column enters where the cause does and depends on the same.
bool is_of(const OutsideCause* cause, const DiscrepancyTerm::Column& column) {
  return cause != nullptr && column.wheel < 0 && name_of(column.entry) == cause->entry &&
         name_of(column.circumstance) == cause->depends;
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
                                                const std::optional<OutsideFinding>& outside,
                                                const DiagnosisOptions& options) {
  const DiscrepancyTerm& term = prepared.discrepancy;
  const DiscrepancyEstimate found =
      estimate_discrepancy(fit, whitened(fit, *prepared.noise, term), options.discrepancy,
                           [&] { return prepared.model->cancelled(); });
  const Eigen::VectorXd squares =
      (prepared.noise->whiten(term.values) * found.mean.asDiagonal()).colwise().squaredNorm();
  const double of_outside =
      outside
          ? prepared.noise->whiten(effect_trace(fit, *prepared.model, outside->cause, options.search.threads))
                .squaredNorm()
          : 0.0;
  const double all = squares.sum() + of_outside;
  if (!(all > 0.0)) return {};
  // What the smooth function still has where the cause from outside acts is more of that cause.
  const OutsideCause* const cause = outside ? find_outside(outside->cause) : nullptr;
  double more_of_outside = 0.0;
  std::vector<Eigen::Index> order;
  for (Eigen::Index c = 0; c < squares.size(); ++c)
    if (is_of(cause, term.columns[static_cast<std::size_t>(c)]))
      more_of_outside += squares[c];
    else
      order.push_back(c);
  std::stable_sort(order.begin(), order.end(),
                   [&](Eigen::Index a, Eigen::Index b) { return squares[a] > squares[b]; });
  order.resize(std::min(order.size(), static_cast<std::size_t>(options.description.max_unexplained_shapes)));
  std::vector<ResidualShape> shapes;
  if (outside) shapes.push_back(shape_of(*outside, (of_outside + more_of_outside) / all));
  for (const Eigen::Index c : order) {
    const DiscrepancyTerm::Column& column = term.columns[static_cast<std::size_t>(c)];
    ResidualShape& shape = shapes.emplace_back();
    shape.entry = entry_name(column, *prepared.model->campaign().rover);
    shape.variable = name_of(column.circumstance);
    shape.share = squares[c] / all;
    shape.shape = shape_of(column.circumstance, found.mean[c], found.error[c]);
  }
  return shapes;
}

}  // namespace slipway::gap
