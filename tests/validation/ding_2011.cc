#include <fmt/format.h>

#include <array>

#include "sim/entry_angle.h"
#include "sim/slip_ratio.h"
#include "tests/sim/reference_models.h"
#include "tests/validation/report.h"

namespace slipway::validation {
namespace {

using namespace sim;

struct Row {
  double slip, pull_n, sinkage_mm, torque_nm;
};

// Digitised by the authors of RoverDevKit; allow 5 % reading error.
constexpr std::array kSmooth{Row{0, -6.5, 5, 0},    Row{0.1, 11, 5.5, 3.0},  Row{0.2, 14.5, 7.5, 4.2},
                             Row{0.3, 15, 10, 4.8}, Row{0.4, 15, 12.5, 5.0}, Row{0.6, 15, 17.5, 5.3}};
constexpr std::array kLugged{Row{0, -6.5, 4.5, 0},    Row{0.1, 14, 5, 3.5},  Row{0.2, 20, 7.5, 5.0},
                             Row{0.3, 22, 10.5, 5.8}, Row{0.4, 23, 14, 6.3}, Row{0.6, 24.5, 27, 7.2}};

struct Errors {
  std::vector<double> pull, sinkage, torque;
};

std::string percent(double predicted, double measured, std::vector<double>& errors) {
  if (measured == 0.0) return "-";
  errors.push_back(predicted / measured - 1.0);
  return fmt::format("{:+.0f} %", 100.0 * errors.back());
}

void compare(const char* name, std::span<const Row> rows, const Soil& soil, Report& report) {
  const WheelGeometry wheel{0.15735, 0.165};
  Errors errors;
  for (const Row& row : rows) {
    const WheelMotion motion{speed_ratio_from_slip(row.slip), 0.0};
    const double theta = balanced_entry_angle_rad(wheel, soil, 80.0, motion).value();
    const WheelForces f = wheel_forces(wheel, soil, theta, motion);
    const double z_mm = 1e3 * sinkage_m(wheel.radius_m, theta);
    report.rows.push_back(
        {name, fmt::format("{:.1f}", row.slip), fmt::format("{:g}", row.pull_n),
         fmt::format("{:.1f}", f.drawbar_pull_n), percent(f.drawbar_pull_n, row.pull_n, errors.pull),
         fmt::format("{:g}", row.sinkage_mm), fmt::format("{:.1f}", z_mm),
         percent(z_mm, row.sinkage_mm, errors.sinkage), fmt::format("{:g}", row.torque_nm),
         fmt::format("{:.2f}", f.torque_nm), percent(f.torque_nm, row.torque_nm, errors.torque)});
  }
  report.notes.push_back(fmt::format("{}: median error of pull {:.0f} %, sinkage {:.0f} %, torque {:.0f} %.",
                                     name, 100.0 * median_abs(errors.pull),
                                     100.0 * median_abs(errors.sinkage), 100.0 * median_abs(errors.torque)));
}

}  // namespace

Report ding_2011() {
  Report report;
  report.title = "Single-wheel tests of Ding et al. 2011, with nothing fitted";
  report.source =
      "Ding et al. 2011, smooth and lugged wheel, r 157.35 mm, b 165 mm, 80 N, digitised by the authors of "
      "RoverDevKit; soil n 1.1, k_c 15.6, k_phi 2407.4, c 0.25 kPa, phi 31.9 deg, K 11 mm";
  report.columns = {"wheel", "slip",  "pull N",     "ours", "error", "sinkage mm",
                    "ours",  "error", "torque N m", "ours", "error"};
  const Soil soil = make_soil({15'600.0, 2'407'400.0, 1.1}, 250.0, 31.9, 0.011, 0.18, 0.32);
  compare("smooth", kSmooth, soil, report);
  compare("lugged", kLugged, soil, report);
  report.notes.push_back(
      "Not in the model of this table: slip sinkage (the measured wheel digs from 5 to 17 mm and more as it "
      "slips, the bare wheel hardly at all), grousers, and a rear exit angle. c1 and c2 are Wong and Reece's "
      "for loose sand. Open peers on the same rows with the plain wheel: pull 35 to 40 %, sinkage 42 to 85 "
      "%, "
      "torque 4 to 14 %.");
  return report;
}

}  // namespace slipway::validation
