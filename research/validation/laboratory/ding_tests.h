#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "core/result.h"
#include "research/validation/report/report.h"
#include "sim/soil/soil.h"

namespace slipway::validation {

// The readings of a single-wheel rig for a wheel under its load at a slip.
struct RigReading {
  double pull_n = 0.0, sinkage_mm = 0.0, torque_nm = 0.0;
};

// One point of the smooth or the lugged wheel of [Ding et al. 2011]: r 157.35 mm, b 165 mm, 80 N, on one
// sand; lugs 10 mm high, 30 around.
struct DingTest {
  bool lugged = false;
  double slip = 0.0;
  RigReading measured;

  std::string wheel() const { return lugged ? "lugged" : "smooth"; }
};

// Errors: unreadable_data.
Result<std::vector<DingTest>> load_ding_tests(const std::filesystem::path& csv);

// The sand as published: n 1.1, k_c 15.6, k_phi 2407.4, c 0.25 kPa, phi 31.9 deg, K 11 mm; c1 and c2 of loose
// sand.
sim::Soil ding_sand();

// The readings of the balanced wheel; empty where it sinks to its axle. rim_friction is that of a smooth rim
// (WheelGeometry). Where `grousers` is true, lugs act as grousers.
std::optional<RigReading> ding_reading(const sim::Soil& sand, bool lugged, bool grousers, double rim_friction,
                                       double slip);

// Add the rows, cases and median errors of predictions, and draw the three panels of the plot.
using DingModel = std::function<std::optional<RigReading>(bool lugged, double slip)>;
struct DingErrors {
  double pull = 0.0, sinkage = 0.0, torque = 0.0;  // medians of absolute relative errors
};
DingErrors add_ding_rows(const std::vector<DingTest>& tests, bool lugged, const DingModel& model,
                         Report& report);
std::string ding_plot(const std::vector<DingTest>& tests, const DingModel& model, const std::string& title);

}  // namespace slipway::validation
