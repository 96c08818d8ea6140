#include <fmt/format.h>

#include "sim/entry_angle.h"
#include "sim/slip_ratio.h"
#include "tests/sim/reference_models.h"
#include "tests/validation/report.h"

namespace slipway::validation {
namespace {

using namespace sim;

struct Band {
  double slip, pull_low, pull_high, torque_low, torque_high;
};

// Published bands; sinkage 26 to 29 mm at every slip.
constexpr Band kBands[] = {
    {0.05, -1.5, 1.5, 1.65, 1.86}, {0.2, 5.5, 7.7, 2.3, 2.55}, {0.5, 12.5, 14.9, 3.05, 3.3}};

bool inside(double value, double low, double high) {
  return value >= low && value <= high;
}

// Whether all nine bands hold with this shear modulus; fills a table's rows.
bool compare(double shear_modulus_m, std::vector<std::vector<std::string>>* rows) {
  const Soil soil = make_soil({1400.0, 820'000.0, 1.0}, 1000.0, 45.0, shear_modulus_m, 0.4, 0.2);
  const WheelGeometry wheel{0.1, 0.06};
  bool all = true;
  for (const Band& band : kBands) {
    const WheelMotion motion{speed_ratio_from_slip(band.slip), 0.0};
    const double theta = balanced_entry_angle_rad(wheel, soil, 50.0, motion).value();
    const WheelForces f = wheel_forces(wheel, soil, theta, motion);
    const double z_mm = 1e3 * sinkage_m(wheel.radius_m, theta);
    const bool row_holds = inside(z_mm, 26, 29) && inside(f.drawbar_pull_n, band.pull_low, band.pull_high) &&
                           inside(f.torque_nm, band.torque_low, band.torque_high);
    all = all && row_holds;
    if (rows)
      rows->push_back({fmt::format("{:.2f}", band.slip), "26 to 29", fmt::format("{:.1f}", z_mm),
                       fmt::format("{:.1f} to {:.1f}", band.pull_low, band.pull_high),
                       fmt::format("{:.2f}", f.drawbar_pull_n),
                       fmt::format("{:.2f} to {:.2f}", band.torque_low, band.torque_high),
                       fmt::format("{:.3f}", f.torque_nm), row_holds ? "yes" : "NO"});
  }
  return all;
}

}  // namespace

Report kernel_cross_check() {
  Report report;
  report.title = "The wheel kernel against another implementation of the same equations";
  report.source =
      "RoverDevKit regression rows (arXiv 2606.21755): r 0.1 m, b 0.06 m, 50 N, n 1, k_c 1.4, k_phi 820, "
      "c 1 kPa, phi 45 deg, c1 0.4, c2 0.2";
  report.columns = {"slip", "sinkage mm, band", "ours", "pull N, band",
                    "ours", "torque N m, band", "ours", "inside"};
  constexpr double kShearModulus_m = 0.018;
  report.holds = compare(kShearModulus_m, &report.rows);
  double low = 1.0, high = 0.0;
  for (int tenth_mm = 50; tenth_mm <= 400; ++tenth_mm)
    if (compare(1e-4 * tenth_mm, nullptr)) {
      low = std::min(low, 1e-4 * tenth_mm);
      high = std::max(high, 1e-4 * tenth_mm);
    }
  report.notes.push_back(fmt::format(
      "The rows do not give the shear modulus. All nine bands hold for K from {:.1f} to {:.1f} mm; "
      "the table is for K = {:.0f} mm. One unstated number explains nine bands, which is "
      "evidence for the equations but not for K.",
      1e3 * low, 1e3 * high, 1e3 * kShearModulus_m));
  return report;
}

}  // namespace slipway::validation
