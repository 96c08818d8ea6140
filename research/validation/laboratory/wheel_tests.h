#pragma once

#include <filesystem>
#include <vector>

#include "core/result.h"
#include "sim/wheel/wheel_forces.h"

namespace slipway::validation {

// The smooth wheel of the single-wheel tests of [Pavlov & Johnson 2022]: r 58 mm, b 50 mm.
inline constexpr sim::WheelGeometry kPavlovWheel{.radius_m = 0.058, .width_m = 0.05};

inline constexpr double kPavlovTravel_m_s = 0.01;  // set speed along the direction of travel

// One steady test: the wheel is towed at a slip angle while its rim turns at a set speed, and the load and
// the depth result. Values are means over the steady part, with their standard deviations within the test.
struct WheelTest {
  int trial = 0;                         // upstream's number; not unique among the repeats of a condition
  double commanded_rim_speed_m_s = 0.0;  // identifies the condition
  double rim_speed_m_s = 0.0;
  double travel_speed_m_s = 0.0;
  double slip_ratio = 0.0;      // travel_slip() at the set travel speed
  double slip_angle_rad = 0.0;  // between travel and the wheel's plane
  double drawbar_pull_n = 0.0, drawbar_pull_std_n = 0.0;
  double side_force_n = 0.0, side_force_std_n = 0.0;
  double load_n = 0.0, load_std_n = 0.0;
  double sinkage_m = 0.0;
};

// (rim - v) / max(v, rim) with v along the direction of travel, as the tests define slip, whatever the slip
// angle.
double travel_slip(double rim_speed_m_s, double travel_speed_m_s);

enum class Half { kFit, kPredict };

// The repeats of one commanded rim speed at one slip angle. All of them are in the same half of the split.
struct WheelCondition {
  double commanded_rim_speed_m_s = 0.0;
  double slip_angle_rad = 0.0;
  Half half = Half::kFit;
  std::vector<WheelTest> repeats;

  double mean(double WheelTest::*quantity) const;
  // Standard deviation of the repeats (n - 1 in the denominator); 0 for a single one.
  double scatter(double WheelTest::*quantity) const;
};

// The conditions in the order of rising slip angle and, within it, rising rim speed. They are split like a
// chessboard: where the index of the angle plus the index of the speed is even, a condition is for fitting,
// otherwise for predicting. Thus every angle and every speed is in both halves, and no repeat is in both.
// Errors: unreadable_data.
Result<std::vector<WheelCondition>> load_wheel_conditions(const std::filesystem::path& csv);

}  // namespace slipway::validation
