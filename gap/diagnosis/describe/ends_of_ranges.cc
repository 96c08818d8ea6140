#include "gap/diagnosis/describe/ends_of_ranges.h"

#include <fmt/format.h>

#include <cmath>

#include "gap/diagnosis/model/outside_cause.h"

namespace slipway::gap {
namespace {

constexpr double kAtTheEnd = 1e-3;  // of the range

}  // namespace

std::vector<std::string> notes_of_ends_of_ranges(const FittedExplanation& fit) {
  std::vector<std::string> notes;
  const auto parameters = fit.hypothesis.parameters();
  for (std::size_t p = fit.hypothesis.nuisance_count(); p < parameters.size(); ++p) {
    const Parameter& parameter = parameters[p];
    if (parameter.shape || is_outside(parameter.effect)) continue;
    const double near = kAtTheEnd * (parameter.highest - parameter.lowest);
    const auto at = [&](double end) {
      return std::abs(fit.x[p] - end) <= near && std::abs(parameter.neutral - end) > near;
    };
    if (!at(parameter.lowest) && !at(parameter.highest)) continue;
    notes.push_back(fmt::format(
        "{} is estimated at the end of its range ({:.3g}): the drives may ask for more than {} can do",
        parameter.name, fit.x[p], parameter.effect));
  }
  return notes;
}

}  // namespace slipway::gap
