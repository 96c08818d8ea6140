#include "api/report/report_words.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "api/documents/diagnosis/diagnosis_document.h"
#include "sim/effects/effect_catalogue.h"

namespace slipway::api {
namespace {

// The unit that the name of a cause's parameter ends with: "force_n" is in N, "gain" has none.
std::string_view unit_in(std::string_view parameter) {
  for (const auto& [ending, unit] : {std::pair<std::string_view, std::string_view>{"_n", "N"},
                                     {"_nm", "N m"},
                                     {"_m", "m"},
                                     {"_rad", "rad"}})
    if (parameter.ends_with(ending)) return unit;
  return {};
}

}  // namespace

std::string interval_words(const gap::Interval& x, double unit) {
  if (!std::isfinite(x.value)) return "none";
  if (!(x.low < x.high) || !std::isfinite(x.low) || !std::isfinite(x.high))
    return fmt::format("{:.3g}", unit * x.value);
  return fmt::format("{:.3g} ({:.3g} to {:.3g})", unit * x.value, unit * x.low, unit * x.high);
}

std::string number_words(fmt::format_string<double> format, double value) {
  return std::isfinite(value) ? fmt::format(format, double(value)) : "none";
}

std::string p_words(double p) {
  return p < 0.001 ? "below 0.001" : fmt::format("{:.3f}", p);
}

std::string probability_words(double p) {
  return p > 0.0 && p < 0.001   ? "below 0.001"
         : p < 1.0 && p > 0.999 ? "above 0.999"
                                : fmt::format("{:.3f}", p);
}

std::string unit_words(std::string_view unit) {
  return unit.empty() || unit == "1" ? std::string() : fmt::format(" {}", unit);
}

std::string_view effect_summary(std::string_view effect) {
  const sim::Effect* const row = sim::find_effect(effect);
  return row != nullptr ? row->summary : std::string_view();
}

std::string_view effect_unit(std::string_view effect, std::string_view parameter) {
  const sim::Effect* const row = sim::find_effect(effect);
  if (row == nullptr) return {};
  const auto field = std::find_if(row->fields.begin(), row->fields.end(),
                                  [&](const Field& f) { return f.name == parameter; });
  return field != row->fields.end() ? field->unit : std::string_view();
}

std::string outside_parameters_words(const gap::ResidualShape& cause) {
  std::vector<std::string> sizes;
  for (const gap::FoundParameter& p : cause.parameters)
    sizes.push_back(fmt::format("{} = {}{}", p.name, interval_words(p.value), unit_words(unit_in(p.name))));
  return fmt::format("{}", fmt::join(sizes, ", "));
}

std::string no_drive_offered_words() {
  return fmt::format(
      "Of the single drives on a plane that were compared, none is expected to bring {:g} bits of which "
      "explanation is true.",
      json::kLeastOfferedBits);
}

}  // namespace slipway::api
