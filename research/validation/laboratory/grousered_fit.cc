#include "research/validation/laboratory/grousered_fit.h"

#include "core/angle.h"
#include "research/validation/laboratory/laboratory_soil.h"
#include "sim/soil/hyperbolic_shear.h"

namespace slipway::validation {
namespace {

constexpr double kPlateExponent = 1.338;  // of the plain logarithms of all plate tests (plate_tests)

struct Row {
  gap::Unknown unknown;
  void (*set)(double value, SandboxModel& model);
};

Row row(const char* name, double start, double lowest, double highest,
        void (*set)(double value, SandboxModel& model)) {
  return {{.name = name,
           .start = start,
           .lowest = lowest,
           .highest = highest,
           .step_scale = 0.1 * std::max(start, 0.01 * highest),
           .prior = {}},
          set};
}

// Starts are the numbers of the shipped soil, so that a fit to the same tests ends where it starts.
std::span<const Row> rows() {
  static const std::vector<Row> kRows{
      row("k MPa/m^n", 2.988, 0.1, 100.0, [](double v, SandboxModel& m) { m.sand.pressure.k_phi = 1e6 * v; }),
      row("K_x mm", 17.5, 0.5, 60.0, [](double v, SandboxModel& m) { m.sand.shear_modulus_x_m = 1e-3 * v; }),
      row("K_y mm", 6.413, 0.5, 60.0, [](double v, SandboxModel& m) { m.sand.shear_modulus_y_m = 1e-3 * v; }),
      row("exit angle ratio", 0.4347, 0.0, 0.95,
          [](double v, SandboxModel& m) { m.sand.exit_angle_ratio = v; }),
      row("rim friction", 0.8959, 0.3, 1.0, [](double v, SandboxModel& m) { m.rim_friction = v; }),
      row("softening", 2.126, 0.0, 6.0, [](double v, SandboxModel& m) { m.sand.inclined_softening = v; }),
      row("dig rim share", 0.1674, 0.0, 1.0, [](double v, SandboxModel& m) { m.sand.digging.rim_share = v; }),
      row("dig rim slip", 0.5891, 0.05, 10.0, [](double v, SandboxModel& m) { m.sand.digging.rim_slip = v; }),
      row("dig cleat share", 0.5377, 0.0, 3.0,
          [](double v, SandboxModel& m) { m.sand.digging.cleat_share = v; }),
      row("dig cleat limit", 5.201, 0.5, 100.0,
          [](double v, SandboxModel& m) { m.sand.digging.cleat_limit = v; }),
      row("dig sideways", 1.532, 0.0, 10.0, [](double v, SandboxModel& m) { m.sand.digging.sideways = v; }),
      row("plough front", 8.017, 0.0, 60.0, [](double v, SandboxModel& m) { m.sand.ploughing.front = v; }),
      row("plough wall", 12.05, 0.0, 60.0, [](double v, SandboxModel& m) { m.sand.ploughing.wall = v; }),
      row("plough heap", 1.662, 0.0, 10.0, [](double v, SandboxModel& m) { m.sand.ploughing.heap = v; }),
      row("plough heap slip", 1.827, 0.1, 20.0,
          [](double v, SandboxModel& m) { m.sand.ploughing.heap_slip = v; }),
      row("wall friction", 0.3879, 0.0, 1.0,
          [](double v, SandboxModel& m) { m.sand.ploughing.wall_friction = v; }),
      row("wall turn", 0.1139, 0.0, 1.0, [](double v, SandboxModel& m) { m.sand.ploughing.wall_turn = v; }),
      row("wall yield", 0.837, 0.0, 10.0,
          [](double v, SandboxModel& m) { m.sand.ploughing.wall_yield = v; })};
  return kRows;
}

}  // namespace

Result<std::vector<SandboxWheelTests>> load_sandbox_wheels(const std::filesystem::path& data) {
  std::vector<SandboxWheelTests> tests;
  for (const bool grousered : {false, true}) {
    auto conditions = load_wheel_conditions(
        data / "validation" / (grousered ? "single_wheel_grousered_half.csv" : "single_wheel_smooth.csv"));
    if (!conditions) return fail(conditions.error());
    tests.push_back({grousered, std::move(*conditions)});
  }
  return tests;
}

sim::WheelGeometry SandboxModel::wheel(bool grousered) const {
  sim::WheelGeometry wheel = kPavlovWheel;
  if (grousered)
    wheel.grousers = {
        .height_m = 0.005, .count = 24.0, .thrust = 0.0, .braking = 0.0, .shear_by_spacing = 1.0};
  else
    wheel.rim_friction = rim_friction;
  return wheel;
}

SandboxModel sandbox_model(std::span<const double> x) {
  SandboxModel model{laboratory_soil({0.0, 1e6, kPlateExponent}, 0.0, 29.0, 0.01, 0.0, 0.0), 1.0};
  model.sand.shear_law.row = &sim::kHyperbolicShear;
  model.sand.slip_directed = 1.0;
  model.sand.density_kg_m3 = 1330.0;
  model.sand.gravity_m_s2 = 9.81;
  for (std::size_t k = 0; k < rows().size(); ++k) rows()[k].set(x[k], model);
  return model;
}

std::vector<gap::Unknown> sandbox_unknowns() {
  std::vector<gap::Unknown> unknowns;
  for (const Row& r : rows()) unknowns.push_back(r.unknown);
  return unknowns;
}

Result<gap::LeastSquaresFit> fit_sandbox(
    const std::vector<SandboxWheelTests>& tests, std::span<const gap::Unknown> unknowns,
    const std::function<bool(bool grousered, const WheelCondition&)>& used, bool covariance) {
  struct Place {
    bool grousered;
    const WheelCondition* condition;
  };
  std::vector<Place> places;
  for (const SandboxWheelTests& wheel : tests)
    for (const WheelCondition& c : wheel.conditions)
      if (used(wheel.grousered, c)) places.push_back({wheel.grousered, &c});
  const auto residuals = [&](std::span<const double> x, std::span<double> r) {
    const SandboxModel model = sandbox_model(x);
    for (std::size_t k = 0; k < places.size(); ++k) {
      const WheelCondition& c = *places[k].condition;
      const bool across = deg_from_rad(c.slip_angle_rad) > 80.0;
      const PavlovReading predicted = read_pavlov_rig(model.wheel(places[k].grousered), model.sand, c);
      const double unit = (across ? 0.15 : 0.07) * c.mean(&WheelTest::load_n);
      r[3 * k] = (predicted.pull_n - c.mean(&WheelTest::drawbar_pull_n)) / unit;
      r[3 * k + 1] = (predicted.side_n - c.mean(&WheelTest::side_force_n)) / unit;
      r[3 * k + 2] = (predicted.sinkage_m - c.mean(&WheelTest::sinkage_m)) / (across ? 0.012 : 0.005);
    }
    return true;
  };
  NoProgress progress;
  return gap::fit_least_squares(unknowns, 3 * places.size(), residuals,
                                {.loss = gap::RobustLoss::kHuber,
                                 .max_iterations = covariance ? 60 : 12,
                                 .tolerance = covariance ? 1e-6 : 1e-4,
                                 .relative_step = 1e-4,
                                 .residual_std_known = false,
                                 .covariance = covariance},
                                progress);
}

}  // namespace slipway::validation
