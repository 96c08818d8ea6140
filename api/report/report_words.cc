#include "api/report/report_words.h"

#include <cmath>

namespace slipway::api {

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

}  // namespace slipway::api
