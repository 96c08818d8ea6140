#include <fmt/format.h>

#include <array>
#include <cmath>

#include "core/progress.h"
#include "gap/estimate/least_squares.h"
#include "research/validation/laboratory/comparisons.h"
#include "research/validation/laboratory/ding_tests.h"
#include "research/validation/laboratory/fit_words.h"
#include "research/validation/report/statistics.h"
#include "sim/soil/hyperbolic_shear.h"
#include "sim/wheel/entry_angle.h"
#include "sim/wheel/slip_ratio.h"

namespace slipway::validation {
namespace {

constexpr double kLoad_n = 80.0;
constexpr std::array kSlips{0.0, 0.1, 0.2, 0.3, 0.4, 0.6};
constexpr double kDigLimit = 10.0;  // slip travel; these tests end at 1.5

// How the strength is mobilised: both candidates are fitted, and the slips that are left out choose.
enum class Mobilisation { kExponential, kHyperbola };

// k_c, k_phi, c and phi as published, the cleats' soil sheared where their spacing says; the rest is fitted.
struct DingClosures {
  sim::Soil sand;
  double rim_friction = 1.0;

  std::optional<RigReading> reading(bool lugged, double slip) const {
    sim::WheelGeometry wheel{.radius_m = 0.15735, .width_m = 0.165};
    if (lugged)
      wheel.grousers = {
          .height_m = 0.01, .count = 30.0, .thrust = 0.0, .braking = 0.0, .shear_by_spacing = 1.0};
    else
      wheel.rim_friction = rim_friction;
    const sim::WheelMotion motion{sim::speed_ratio_from_slip(slip), 0.0};
    const auto theta = sim::balanced_entry_angle_rad(wheel, sand, kLoad_n, motion);
    if (!theta) return std::nullopt;
    const sim::WheelForces f = sim::wheel_forces(wheel, sand, *theta, motion);
    return RigReading{f.drawbar_pull_n, 1e3 * sim::sinkage_m(wheel.radius_m, *theta), f.torque_nm};
  }
};

DingClosures closures_of(std::span<const double> x, Mobilisation mobilisation) {
  DingClosures model{ding_sand(), x[2]};
  model.sand.pressure.n = x[0];
  model.sand.shear_modulus_x_m = model.sand.shear_modulus_y_m = 1e-3 * x[1];
  model.sand.c1 = x[3];
  model.sand.c2 = x[4];
  model.sand.digging = {
      .rim_share = x[5], .rim_slip = kDigLimit, .cleat_share = x[6], .cleat_limit = kDigLimit};
  if (mobilisation == Mobilisation::kHyperbola) model.sand.shear_law.row = &sim::kHyperbolicShear;
  return model;
}

std::vector<gap::Unknown> unknowns() {
  const auto unknown = [](const char* name, double start, double lowest, double highest, double step) {
    return gap::Unknown{
        .name = name, .start = start, .lowest = lowest, .highest = highest, .step_scale = step, .prior = {}};
  };
  return {unknown("n", 0.75, 0.3, 1.6, 0.1),
          unknown("K mm", 2.5, 0.5, 30.0, 0.5),
          unknown("rim friction", 0.83, 0.5, 1.0, 0.1),
          unknown("c1", 0.7, 0.0, 0.9, 0.1),
          unknown("c2", 0.25, -0.3, 0.8, 0.1),
          unknown("dig rim share", 0.55, 0.0, 1.0, 0.1),
          unknown("dig cleat share", 0.3, 0.0, 3.0, 0.1)};
}

// Fits all tests but those at slip `left_out`, in the units of the other fit to these tests.
Result<gap::LeastSquaresFit> fit(const std::vector<DingTest>& tests, Mobilisation mobilisation,
                                 double left_out) {
  std::vector<DingTest> used;
  for (const DingTest& test : tests)
    if (test.slip != left_out) used.push_back(test);
  const auto residuals = [&](std::span<const double> x, std::span<double> r) {
    const DingClosures model = closures_of(x, mobilisation);
    for (std::size_t k = 0; k < used.size(); ++k) {
      const auto ours = model.reading(used[k].lugged, used[k].slip);
      if (!ours) return false;
      r[3 * k] = (ours->pull_n - used[k].measured.pull_n) / 2.0;
      r[3 * k + 1] = (ours->sinkage_mm - used[k].measured.sinkage_mm) / 1.5;
      r[3 * k + 2] = (ours->torque_nm - used[k].measured.torque_nm) / 0.4;
    }
    return true;
  };
  NoProgress progress;
  return gap::fit_least_squares(
      unknowns(), 3 * used.size(), residuals,
      {.loss = gap::RobustLoss::kCauchy, .starts = 2, .tolerance = 1e-8, .residual_std_known = false},
      progress);
}

struct LeftOut {
  std::vector<double> pull, sinkage, torque;
  double pull_at_a_tenth = 0.0;  // the larger miss of the two wheels at slip 0.1

  std::string words() const {
    return fmt::format(
        "pull {:.0f} %, sinkage {:.0f} %, torque {:.0f} %, the pull at slip 0.1 within {:.0f} %",
        100.0 * median_abs(pull), 100.0 * median_abs(sinkage), 100.0 * median_abs(torque),
        100.0 * pull_at_a_tenth);
  }
};

// The errors where every slip is predicted by a fit without it.
Result<LeftOut> left_out_errors(const std::vector<DingTest>& tests, Mobilisation mobilisation) {
  LeftOut errors;
  for (const double slip : kSlips) {
    const auto fitted = fit(tests, mobilisation, slip);
    if (!fitted) return fail(fitted.error());
    const DingClosures model = closures_of(fitted->estimate, mobilisation);
    for (const DingTest& test : tests) {
      if (test.slip != slip) continue;
      const auto ours = model.reading(test.lugged, slip);
      if (!ours) continue;
      errors.pull.push_back(ours->pull_n / test.measured.pull_n - 1.0);
      errors.sinkage.push_back(ours->sinkage_mm / test.measured.sinkage_mm - 1.0);
      if (test.measured.torque_nm != 0.0)
        errors.torque.push_back(ours->torque_nm / test.measured.torque_nm - 1.0);
      if (slip == 0.1)
        errors.pull_at_a_tenth = std::max(errors.pull_at_a_tenth, std::abs(errors.pull.back()));
    }
  }
  return errors;
}

}  // namespace

Result<Report> ding_2011_closures(const std::filesystem::path& data) {
  const auto tests = load_ding_tests(data / "validation" / "ding_2011.csv");
  if (!tests) return fail(tests.error());
  const auto fitted = fit(*tests, Mobilisation::kHyperbola, -1.0);
  if (!fitted) return fail(fitted.error());
  const auto hyperbola = left_out_errors(*tests, Mobilisation::kHyperbola);
  if (!hyperbola) return fail(hyperbola.error());
  const auto exponential = left_out_errors(*tests, Mobilisation::kExponential);
  if (!exponential) return fail(exponential.error());
  const DingClosures closures = closures_of(fitted->estimate, Mobilisation::kHyperbola);
  const DingModel model = [&](bool lugged, double slip) { return closures.reading(lugged, slip); };
  Report report;
  report.title = "The same tests with a hyperbola of shear, digging, and lugs that hold soil between them";
  report.source =
      "as above; k_c, k_phi, c and phi as published, seven numbers fitted to all rows of both wheels at once";
  report.columns = {"wheel",  "slip",  "pull N",     "fitted", "error", "sinkage mm",
                    "fitted", "error", "torque N m", "fitted", "error"};
  for (const bool lugged : {false, true}) (void)add_ding_rows(*tests, lugged, model, report);
  report.notes = {
      "Fitted: " + words_of(unknowns(), *fitted) + ".",
      "Cross-validated, median errors where every slip is predicted by a fit without it: hyperbola " +
          hyperbola->words() + "; one exponential " + exponential->words() +
          ". The hyperbola was chosen by these.",
      "The lugged wheel's resistance at slip 0 is missed: by its rim the wheel that is sheared at half of "
      "its "
      "lugs' height slips there already, and pulls.",
      "The fitted soil ships as ding_2011_closures. A row is repeated by: slipway wheel --soil "
      "ding_2011_closures --radius 0.15735 --width 0.165 --gravity 9.81 --load 80 --slip 0.1, with "
      "--grousers "
      "0.01,30 --effect cleat_shear_radius for the lugged wheel and --effect smooth_rim:friction_share=0.834 "
      "for the smooth one.",
      "The fit itself is repeated by: slipway estimate wheel data/validation/ding_2011_wheel_tests.csv "
      "--soil ding_2011_closures --wheel-radius 0.15735 --wheel-width 0.165 --gravity 9.81 --grousers "
      "0.01,30@lugged --effect cleat_shear_radius@lugged --effect "
      "smooth_rim@smooth:friction_share=0.834 --free "
      "n,shear_modulus,smooth_rim.friction_share,c1,c2,dig_rim_share,dig_cleat_share --bound c1=0:0.9 "
      "--prior none --loss cauchy --loss-scale 1 --no-profile."};
  report.bands = {
      {"cross-validated: median error of pull, %", 100.0 * median_abs(hyperbola->pull), 0.0, 15.0},
      {"cross-validated: larger error of pull at slip 0.1, %", 100.0 * hyperbola->pull_at_a_tenth, 0.0,
       25.0}};
  report.plot = ding_plot(*tests, model, report.title);
  return report;
}

}  // namespace slipway::validation
