#pragma once

#include <string>
#include <vector>

#include "api/chart/chart.h"

namespace slipway::api {

// The layout of a chart's axis: the map from values to pixels, and its ticks.
class AxisScale {
 public:
  // values are all that the axis must show. begin_px is the place of the lowest value.
  AxisScale(const ChartAxis& axis, const std::vector<double>& values, double begin_px, double end_px);

  struct Tick {
    double at_px;
    std::string words;
  };
  const std::vector<Tick>& ticks() const { return ticks_; }
  double px(double value) const;
  // Whether the value is finite, and positive on a logarithmic axis.
  bool shows(double value) const;
  // Whether the value can be shown and is between the axis's ends.
  bool contains(double value) const;
  double lowest() const { return lowest_; }
  double highest() const { return highest_; }

 private:
  void lay_linear(const ChartAxis& axis, double lowest, double highest);
  void lay_logarithmic(const ChartAxis& axis, double lowest, double highest);
  void add_tick(double value, const std::string& words);

  bool logarithmic_;
  double begin_px_, end_px_;
  double lowest_ = 0.0, highest_ = 1.0;
  std::vector<Tick> ticks_;
};

// "0.25", "-3", "2e+06": as many decimals as the step between ticks has.
std::string tick_words(double value, double step);

}  // namespace slipway::api
