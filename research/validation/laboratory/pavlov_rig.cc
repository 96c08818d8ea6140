#include "research/validation/laboratory/pavlov_rig.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "research/validation/report/statistics.h"
#include "sim/wheel/entry_angle.h"

namespace slipway::validation {

PavlovReading read_pavlov_rig(const sim::WheelGeometry& wheel, const sim::Soil& sand,
                              const WheelCondition& c) {
  const double rim = std::max(c.mean(&WheelTest::rim_speed_m_s), 1e-3 * kPavlovTravel_m_s);
  const sim::WheelMotion motion{kPavlovTravel_m_s * std::cos(c.slip_angle_rad) / rim,
                                kPavlovTravel_m_s * std::sin(c.slip_angle_rad) / rim};
  const auto balanced = sim::balanced_entry_angle_rad(wheel, sand, c.mean(&WheelTest::load_n), motion);
  const double theta = balanced ? *balanced : sim::max_entry_angle_rad(sand);
  const sim::WheelForces f = sim::wheel_forces(wheel, sand, theta, motion);
  return {f.drawbar_pull_n, -f.lateral_n, sim::sinkage_m(wheel.radius_m, theta), !balanced};
}

void PavlovErrors::add(const PavlovReading& predicted, const WheelCondition& c) {
  const double load = c.mean(&WheelTest::load_n);
  pull.push_back((predicted.pull_n - c.mean(&WheelTest::drawbar_pull_n)) / load);
  side.push_back((predicted.side_n - c.mean(&WheelTest::side_force_n)) / load);
  sinkage_mm.push_back(1e3 * (predicted.sinkage_m - c.mean(&WheelTest::sinkage_m)));
}

double PavlovErrors::rms(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double v : values) sum += v * v;
  return values.empty() ? 0.0 : std::sqrt(sum / static_cast<double>(values.size()));
}

std::string PavlovErrors::words() const {
  std::vector<double> all = pull;
  all.insert(all.end(), side.begin(), side.end());
  const auto close = std::count_if(all.begin(), all.end(), [](double e) { return std::abs(e) <= 0.15; });
  return fmt::format(
      "pull rms {:.1f} %, median {:.1f} %; side force rms {:.1f} %, median {:.1f} % of the load; {:.0f} % "
      "of both "
      "within 15 %; sinkage rms {:.1f} mm ({} conditions)",
      100.0 * rms(pull), 100.0 * median_abs(pull), 100.0 * rms(side), 100.0 * median_abs(side),
      100.0 * static_cast<double>(close) / static_cast<double>(all.size()), rms(sinkage_mm), pull.size());
}

}  // namespace slipway::validation
