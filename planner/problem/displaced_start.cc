#include "planner/problem/displaced_start.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "core/angle.h"

namespace slipway::planner {

Pose2 DisplacedStart::from(const Pose2& start) const {
  const double c = std::cos(start.yaw_rad), s = std::sin(start.yaw_rad);
  return {start.x_m + c * ahead_m - s * left_m, start.y_m + s * ahead_m + c * left_m,
          wrapped_rad(start.yaw_rad + turned_rad)};
}

std::size_t DisplacedStarts::count(Verdict verdict) const {
  return static_cast<std::size_t>(std::count_if(
      starts.begin(), starts.end(), [&](const DisplacedStart& start) { return start.verdict == verdict; }));
}

const DisplacedStart& DisplacedStarts::worst() const {
  const auto order = [](const DisplacedStart& start) {
    return std::tuple(severity(start.verdict), start.broken, start.max_slip_ratio);
  };
  return *std::max_element(
      starts.begin(), starts.end(),
      [&](const DisplacedStart& a, const DisplacedStart& b) { return order(a) < order(b); });
}

}  // namespace slipway::planner
