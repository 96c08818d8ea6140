#include "sim/single_wheel/current_map.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "sim/single_wheel/zhurong_literal.h"
#include "sim/wheel/entry_angle.h"

namespace slipway::sim {
namespace {

CurrentPoint literal_point(const WheelRigConditions& test) {
  CurrentPoint point;
  const double deepest = sinkage_m(test.wheel.radius_m, kMaxEntryAngleRad);
  const double bekker = bekker_sinkage_m(test.wheel, test.soil, test.load_n);
  if (!(bekker <= deepest)) {
    point.reason = fmt::format("sunk to the axle: equation A18 gives {:.0f} mm of a radius of {:.0f} mm",
                               1e3 * bekker, 1e3 * test.wheel.radius_m);
    return point;
  }
  const ZhurongLiteral literal = zhurong_literal(test.wheel, test.soil, test.load_n, test.slip);
  point.sinkage_m = literal.sinkage_m;
  point.torque_nm = literal.torque_nm;
  point.current_a = literal.torque_nm / (kZhurongTorqueFactor * kZhurongImpliedGearRatio);
  return point;
}

CurrentPoint balanced_point(const WheelRigConditions& test) {
  const WheelRigResult result = run_wheel_rig(test);
  CurrentPoint point;
  point.reason = result.reason;
  if (!result.stands()) return point;
  point.sinkage_m = result.sinkage_m;
  point.torque_nm = result.forces.torque_nm;
  point.current_a = result.current_a;
  return point;
}

struct PaperRange {
  std::string_view parameter;
  double lowest, highest;
  bool in_equal_ratios;
};

// Zhurong Table 3, "Analysis range", in SI.
constexpr std::array kPaperRanges{
    PaperRange{"slip", 0.0, 0.9, false},
    PaperRange{"soil.k_s", 60e3, 7700e3, true},
    PaperRange{"soil.n", 0.7, 1.4, false},
    PaperRange{"soil.cohesion_pa", 100.0, 15e3, false},
    PaperRange{"soil.friction_angle_deg", 16.0, 40.0, false},
};

}  // namespace

std::vector<CurrentPoint> run_current_map(const WheelSweep& sweep, CurrentModel model) {
  std::vector<CurrentPoint> points;
  for (SweepPoint& place : points_of(sweep)) {
    points.push_back(model == CurrentModel::kLiteral ? literal_point(place.test)
                                                     : balanced_point(place.test));
    points.back().place = std::move(place);
  }
  return points;
}

std::optional<SweepAxis> paper_axis(std::string_view parameter, std::size_t count) {
  for (const PaperRange& range : kPaperRanges) {
    if (range.parameter != parameter) continue;
    SweepAxis axis{std::string(parameter), {}};
    for (std::size_t i = 0; i < count; ++i) {
      const double share = count > 1 ? static_cast<double>(i) / static_cast<double>(count - 1) : 0.0;
      const double value = range.in_equal_ratios
                               ? range.lowest * std::pow(range.highest / range.lowest, share)
                               : range.lowest + share * (range.highest - range.lowest);
      axis.values.push_back(rounded_to_twelve(value));
    }
    return axis;
  }
  return std::nullopt;
}

}  // namespace slipway::sim
