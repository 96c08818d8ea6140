#include "api/chart/chart_axes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace slipway::api {
namespace {

// The smallest of 1, 2 and 5 times a power of ten that is not below `at_least`.
double nice_step(double at_least) {
  const double power = std::pow(10.0, std::floor(std::log10(at_least)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (factor * power >= at_least * (1.0 - 1e-9)) return factor * power;
  return 10.0 * power;
}

}  // namespace

std::vector<double> nice_ticks(double lowest, double highest, int wanted) {
  const double span = highest > lowest ? highest - lowest : std::max(std::abs(lowest), 1.0);
  const double step = nice_step(span / wanted);
  const double first = std::floor(lowest / step + 1e-9), last = std::ceil(highest / step - 1e-9);
  std::vector<double> ticks;
  for (int k = 0; first + k <= last; ++k) ticks.push_back((first + k) * step);
  if (ticks.size() == 1) ticks = {ticks[0] - step, ticks[0], ticks[0] + step};
  return ticks;
}

std::string tick_words(double value, double step) {
  const double rounded = std::round(value / step) * step;
  if (std::abs(rounded) >= 1e5 || (rounded != 0.0 && step < 1e-4)) return fmt::format("{:.3g}", rounded);
  const int decimals = std::max(0, -static_cast<int>(std::floor(std::log10(step) + 1e-9)));
  return fmt::format("{:.{}f}", rounded == 0.0 ? 0.0 : rounded, decimals);
}

AxisScale::AxisScale(const ChartAxis& axis, const std::vector<double>& values, double begin_px, double end_px)
    : logarithmic_(axis.logarithmic && axis.categories.empty()), begin_px_(begin_px), end_px_(end_px) {
  if (!axis.categories.empty()) {
    lowest_ = -0.5;
    highest_ = static_cast<double>(axis.categories.size()) - 0.5;
    for (std::size_t k = 0; k < axis.categories.size(); ++k)
      add_tick(static_cast<double>(k), axis.categories[k]);
    return;
  }
  double low = 0.0, high = 0.0;
  bool any = false;
  for (const double v : values) {
    if (!shows(v)) continue;
    low = any ? std::min(low, v) : v;
    high = any ? std::max(high, v) : v;
    any = true;
  }
  if (!any) low = high = 1.0;
  low = axis.lowest.value_or(low);
  high = std::max(low, axis.highest.value_or(high));
  logarithmic_ ? lay_logarithmic(axis, low, high) : lay_linear(axis, low, high);
}

void AxisScale::lay_linear(const ChartAxis& axis, double lowest, double highest) {
  const std::vector<double> ticks = nice_ticks(lowest, highest, 6);
  lowest_ = axis.lowest.value_or(ticks.front());
  highest_ = axis.highest.value_or(ticks.back());
  if (!(highest_ > lowest_)) highest_ = lowest_ + 1.0;
  for (const double tick : ticks)
    if (tick >= lowest_ - 1e-9 * (highest_ - lowest_) && tick <= highest_ + 1e-9 * (highest_ - lowest_))
      add_tick(tick, tick_words(tick, ticks[1] - ticks[0]));
}

void AxisScale::lay_logarithmic(const ChartAxis& axis, double lowest, double highest) {
  const double first = std::floor(std::log10(lowest) + 1e-9), last = std::ceil(std::log10(highest) - 1e-9);
  lowest_ = axis.lowest.value_or(std::pow(10.0, first));
  highest_ = axis.highest.value_or(std::pow(10.0, std::max(last, first + 1.0)));
  const bool few = last - first <= 2.0;
  for (int k = 0; first + k <= std::max(last, first + 1.0); ++k)
    for (const double factor : {1.0, 2.0, 5.0}) {
      const double tick = factor * std::pow(10.0, first + k);
      if ((factor == 1.0 || few) && tick >= lowest_ * (1.0 - 1e-9) && tick <= highest_ * (1.0 + 1e-9))
        add_tick(tick, fmt::format("{:.3g}", tick));
    }
}

void AxisScale::add_tick(double value, const std::string& words) {
  ticks_.push_back({px(value), words});
}

double AxisScale::px(double value) const {
  const double share =
      logarithmic_ ? (std::log10(value) - std::log10(lowest_)) / (std::log10(highest_) - std::log10(lowest_))
                   : (value - lowest_) / (highest_ - lowest_);
  return begin_px_ + share * (end_px_ - begin_px_);
}

bool AxisScale::contains(double value) const {
  const double slack = 1e-9 * (highest_ - lowest_);
  return shows(value) && value >= lowest_ - slack && value <= highest_ + slack;
}

bool AxisScale::shows(double value) const {
  return std::isfinite(value) && (!logarithmic_ || value > 0.0);
}

}  // namespace slipway::api
