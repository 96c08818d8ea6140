#include "gap/estimate/soil_determination.h"

#include <fmt/format.h>

#include <cmath>

namespace slipway::gap {
namespace {

// Three digits; thousands apart.
std::string number(double value) {
  const double a = std::abs(value);
  if (a != 0.0 && (a >= 1e5 || a < 1e-3)) return fmt::format("{:.3g}", value);
  if (a < 100.0) return fmt::format("{:.3g}", value);
  const std::string digits = fmt::format("{:.0f}", a);
  std::string apart = value < 0.0 ? "-" : "";
  for (std::size_t i = 0; i < digits.size(); ++i) {
    if (i > 0 && (digits.size() - i) % 3 == 0) apart.push_back(',');
    apart.push_back(digits[i]);
  }
  return apart;
}

std::string words_of(const EstimatedParameter& p, bool model_holds) {
  const bool has_prior = p.prior_std.has_value();
  const SoilParameterRow& row = row_of(p.parameter);
  const auto shown = [&](double value) { return number(row.boundary_unit * value); };
  const std::string unit = row.unit == "1" ? "" : fmt::format(" {}", row.unit);
  switch (p.determination) {
    case Determination::kDetermined:
      return fmt::format("{}: {}{}, determined ({} to {} at 90 %)", row.name, shown(p.value), unit,
                         shown(p.low), shown(p.high));
    case Determination::kOneSided:
      return fmt::format("{}: {} {}{} (90 %), no {} end; what is given, {}{}, leans on {}", row.name,
                         p.low_open ? "at most" : "at least", shown(p.low_open ? p.high : p.low), unit,
                         p.low_open ? "lower" : "upper", shown(p.value), unit,
                         has_prior ? "the prior" : "where the search ended");
    case Determination::kUndetermined:
      break;
  }
  if (!model_holds)
    return fmt::format(
        "{}: not determined, since the model does not hold; {}{} ({} to {}) is where it misses the readings "
        "least",
        row.name, shown(p.value), unit, shown(p.low), shown(p.high));
  // Between them, the data say something, but little.
  const bool closed = !p.low_open && !p.high_open;
  return fmt::format("{}: not determined by these data ({} to {}{} all fit); what is given, {}{}, is {}",
                     row.name, shown(p.low), shown(p.high), unit, shown(p.value), unit,
                     closed      ? "no better than that"
                     : has_prior ? "largely the prior"
                                 : "where the search ended");
}

}  // namespace

std::string_view name_of(Determination determination) {
  switch (determination) {
    case Determination::kDetermined:
      return "determined";
    case Determination::kOneSided:
      return "one_sided";
    case Determination::kUndetermined:
      break;
  }
  return "undetermined";
}

void judge(EstimatedParameter& p, const DeterminationGrounds& grounds, const DeterminationOptions& options) {
  const double size = grounds.scale.value_or(std::abs(p.value));
  const bool model_holds = grounds.residual_variance <= options.max_residual_variance;
  const bool judgeable = grounds.says_more && model_holds;
  p.determination = Determination::kUndetermined;
  if (judgeable && !p.low_open && !p.high_open && p.high - p.low <= 2.0 * options.max_half_width * size)
    p.determination = Determination::kDetermined;
  else if (judgeable && p.low_open != p.high_open)
    p.determination = Determination::kOneSided;
  p.words = words_of(p, model_holds);
}

}  // namespace slipway::gap
