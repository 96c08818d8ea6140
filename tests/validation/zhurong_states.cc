#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "sim/entry_angle.h"
#include "sim/zhurong_literal.h"
#include "tests/sim/reference_models.h"
#include "tests/validation/report.h"

namespace slipway::validation {
namespace {

using namespace sim;

struct State {
  const char* name;
  double k_c_kn, k_phi_kn, n, c_kpa, phi_deg, k_cm, c1;
  double reproduced_torque_times_ki, reproduced_sinkage_mm;  // another reproduction of the paper; 0: none
};

// Zhurong Table 1 and Table A1. The dense second simulant prints c 0.80 kPa and phi 39.3 deg.
constexpr std::array kStates{
    State{"JLU Mars 1 loose", 5.471, 234.221, 0.910, 0.383, 19.1, 1.33, 0.285, 0.0, 0.0},
    State{"JLU Mars 1 medium", 58.375, 10276.77, 1.067, 0.541, 30.6, 1.38, 0.18, 0.202, 7.3},
    State{"JLU Mars 1 dense", 740.32, 11155.956, 1.172, 1.131, 37.8, 1.62, 0.43, 0.209, 8.4},
    State{"JLU Mars 2 loose", 20.538, 328.221, 0.956, 0.354, 35.1, 1.51, 0.285, 2.222, 43.7},
    State{"JLU Mars 2 medium", 10.843, 1638.496, 0.993, 0.672, 37.1, 1.71, 0.18, 0.839, 19.1},
    State{"JLU Mars 2 dense", 314.413, 7432.759, 1.12, 0.80, 39.3, 1.92, 0.43, 0.225, 9.7},
    State{"JLU Mars 3 loose", 3.125, 536.156, 0.867, 0.102, 33.2, 1.71, 0.285, 1.098, 28.8},
    State{"JLU Mars 3 medium", 47.578, 2225.388, 1.022, 0.168, 36.8, 1.83, 0.18, 0.605, 16.3},
    State{"JLU Mars 3 dense", 552.963, 6879.961, 1.107, 0.437, 37.6, 2.07, 0.43, 0.171, 8.9},
};

std::string number(double value, const char* format) {
  return value == 0.0 ? "-" : fmt::format(fmt::runtime(format), value);
}

}  // namespace

Report zhurong_states() {
  Report report;
  report.title = "Zhurong's current model at zero slip, literal and balanced";
  report.source =
      "Zhurong paper (Aerospace 2024, 11, 892), Table 1 and equations A16 to A19, and an independent "
      "reproduction of them; r 147.5 mm, b 200 mm, 34.08 kg x 9.81";
  report.columns = {"state",
                    "sinkage A18 mm, reproduced",
                    "ours",
                    "T k_I, reproduced",
                    "ours",
                    "current A (literal, gear 79.3)",
                    "balanced: sinkage mm",
                    "balanced: current A"};
  const WheelGeometry wheel{0.1475, 0.2};
  const double load = 34.08 * 9.81;
  double worst = 0.0;
  for (const State& s : kStates) {
    const Soil soil = make_soil({1e3 * s.k_c_kn, 1e3 * s.k_phi_kn, s.n}, 1e3 * s.c_kpa, s.phi_deg,
                                0.01 * s.k_cm, s.c1, 0.32);
    const ZhurongLiteral literal = zhurong_literal(wheel, soil, load, 0.0);
    const double times_ki = literal.torque_nm * kZhurongTorqueFactor;
    if (s.reproduced_torque_times_ki > 0.0)
      worst = std::max(worst, std::abs(times_ki / s.reproduced_torque_times_ki - 1.0));
    const double geared = kZhurongTorqueFactor * kZhurongImpliedGearRatio;
    const auto theta = balanced_entry_angle_rad(wheel, soil, load, {1.0, 0.0});
    const double balanced = theta ? wheel_forces(wheel, soil, *theta, {1.0, 0.0}).torque_nm / geared : 0.0;
    report.rows.push_back({s.name, number(s.reproduced_sinkage_mm, "{:.1f}"),
                           fmt::format("{:.1f}", 1e3 * literal.sinkage_m),
                           number(s.reproduced_torque_times_ki, "{:.3f}"), fmt::format("{:.3f}", times_ki),
                           fmt::format("{:.4f}", literal.torque_nm / geared),
                           theta ? fmt::format("{:.1f}", 1e3 * sinkage_m(wheel.radius_m, *theta)) : "sunk",
                           fmt::format("{:.4f}", balanced)});
  }
  report.notes.push_back(
      fmt::format("Largest difference of T k_I to the other reproduction: {:.1f} %.", 100.0 * worst));
  report.notes.push_back(
      "The paper prints 0.114 A for JLU Mars 2 dense and measured 0.110 A as the mean of six wheels; k_I "
      "without a "
      "gear would give 9.04 A, so a gear ratio of about 79 is missing from its text. The balanced wheel "
      "needs "
      "more torque because A18's entry angle carries only 227 N of the 334 N.");
  report.holds = worst < 0.01;
  return report;
}

}  // namespace slipway::validation
