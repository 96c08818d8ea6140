#pragma once

#include <string>
#include <vector>

#include "api/chart/chart.h"

namespace slipway::api {

// A chart's axis laid out: which values map to which pixels, and where its ticks stand.
class AxisScale {
 public:
  // values: all that is to be shown on the axis. begin_px is where its lowest value stands.
  AxisScale(const ChartAxis& axis, const std::vector<double>& values, double begin_px, double end_px);

  struct Tick {
    double at_px;
    std::string words;
  };
  const std::vector<Tick>& ticks() const { return ticks_; }
  double px(double value) const;
  // Finite, and positive on a logarithmic axis.
  bool shows(double value) const;
  // Shown, and between the axis's ends.
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
