#include "gap/estimate/soil_determination.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "core/random.h"

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

// A value, an end of a range and a range in the parameter's unit.
class InWords {
 public:
  explicit InWords(const EstimatedParameter& p)
      : factor_(p.parameter.boundary_unit()),
        unit_(p.parameter.unit() == "1" ? "" : fmt::format(" {}", p.parameter.unit())) {}
  std::string bare(double value) const { return number(factor_ * value); }
  std::string operator()(double value) const { return bare(value) + unit_; }
  std::string range(const ParameterRange& r) const {
    return fmt::format("{} to {}", bare(r.low), (*this)(r.high));
  }

 private:
  double factor_;
  std::string unit_;
};

std::string one_sided_words(const EstimatedParameter& p, const ParameterRange& r, const InWords& shown) {
  return fmt::format("{}: {} {} (90 %), no {} end; what is given, {}, leans on {}", p.parameter.shown(),
                     r.low_open ? "at most" : "at least", shown(r.low_open ? r.high : r.low),
                     r.low_open ? "lower" : "upper", shown(p.value),
                     p.prior_std ? "the prior" : "where the search ended");
}

std::string words_of(const EstimatedParameter& p, const DeterminationGrounds& grounds,
                     const DeterminationOptions& options) {
  const InWords shown(p);
  const std::string name = p.parameter.shown();
  const ParameterRange data{p.low, p.high, p.low_open, p.high_open};
  if (p.determination == Determination::kDetermined)
    return fmt::format("{}: {}, determined ({} to {} at 90 %{})", name, shown(p.value), shown.bare(p.low),
                       shown.bare(p.high),
                       p.with_assumed ? fmt::format("; {} with {} uncertain", shown.range(*p.with_assumed),
                                                    fmt::join(p.assumed, ", "))
                                      : "");
  if (p.determination == Determination::kOneSided)
    return one_sided_words(p, p.with_assumed.value_or(data), shown);
  if (!grounds.model_holds)
    return fmt::format(
        "{}: not determined, since the model does not hold; {} ({} to {}) is where it misses the readings "
        "least",
        name, shown(p.value), shown.bare(p.low), shown.bare(p.high));
  if (grounds.spare_readings && *grounds.spare_readings < options.min_spare_readings)
    return fmt::format(
        "{}: not determined: {} readings more than free parameters do not say whether the model holds; {} "
        "({} to {}) if it does",
        name, *grounds.spare_readings, shown(p.value), shown.bare(p.low), shown.bare(p.high));
  if (p.with_assumed)
    return fmt::format(
        "{}: not determined: {} ({} to {}) only if {} {} as assumed; {} fit where {} as uncertain "
        "as in soils of its kind",
        name, shown(p.value), shown.bare(p.low), shown.bare(p.high), fmt::join(p.assumed, ", "),
        p.assumed.size() == 1 ? "is" : "are", shown.range(*p.with_assumed),
        p.assumed.size() == 1 ? "it is" : "they are");
  // Between them, the data say something, but little.
  const bool closed = !p.low_open && !p.high_open;
  return fmt::format("{}: not determined by these data ({} all fit); what is given, {}, is {}", name,
                     shown.range(data), shown(p.value),
                     closed        ? "no better than that"
                     : p.prior_std ? "largely the prior"
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

double max_residual_variance(std::size_t degrees_of_freedom, const DeterminationOptions& options) {
  if (degrees_of_freedom == 0) return 0.0;
  const double z = normal_quantile(1.0 - 1e-3 * options.false_alarms_in_1000);
  const double part = 2.0 / (9.0 * static_cast<double>(degrees_of_freedom));
  return std::pow(1.0 - part + z * std::sqrt(part), 3);
}

Determination said_by(const ParameterRange& range, double value, const DeterminationGrounds& grounds,
                      const DeterminationOptions& options) {
  const double size = grounds.scale.value_or(std::abs(value));
  const bool enough = !grounds.spare_readings || *grounds.spare_readings >= options.min_spare_readings;
  if (!grounds.says_more || !grounds.model_holds || !enough) return Determination::kUndetermined;
  const double farther = std::max(value - range.low, range.high - value);
  if (!range.low_open && !range.high_open && farther <= options.max_half_width * size)
    return Determination::kDetermined;
  return range.low_open != range.high_open ? Determination::kOneSided : Determination::kUndetermined;
}

void judge(EstimatedParameter& p, const DeterminationGrounds& grounds, const DeterminationOptions& options) {
  p.determination = said_by({p.low, p.high, p.low_open, p.high_open}, p.value, grounds, options);
  // No more than what is left when the assumptions vary.
  if (p.with_assumed && p.determination != Determination::kUndetermined)
    p.determination = said_by(*p.with_assumed, p.value, grounds, options);
  p.words = words_of(p, grounds, options);
}

}  // namespace slipway::gap
