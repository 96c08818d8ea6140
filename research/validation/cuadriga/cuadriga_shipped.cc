#include "research/validation/cuadriga/cuadriga_shipped.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/angle.h"

namespace slipway::validation {

TableError table_error(const sim::RoverModel& rover, const CuadrigaParameters& parameters) {
  const sim::Soil soil = ground_of(parameters);
  TableError error;
  const auto table = ClimbTable::tabulate(rover, soil);
  if (!table) return error;
  const CuadrigaModel model(parameters, *table);
  const auto compare = [&](double gradient_deg, double curvature_1_m, double& slip, double& current) {
    const double gradient = rad_from_deg(gradient_deg);
    const auto solved = solve_climb(rover, soil, gradient, curvature_1_m);
    if (!solved) return;
    const ClimbConditions at{gradient, solved->turn_rate_rad_s};
    slip = std::max(slip, std::abs(table->at(at).slip_ratio - solved->slip_ratio));
    current = std::max(current, std::abs(model.current_a(at) - current_of(parameters, *solved)));
    error.fastest_turn_deg_s = std::max(error.fastest_turn_deg_s, deg_from_rad(solved->turn_rate_rad_s));
  };
  for (double g = ClimbTable::kMinGradient_deg + 0.5 * ClimbTable::kStep_deg; g < 20.0;
       g += ClimbTable::kStep_deg) {
    if (g < -20.0) continue;
    compare(g, 0.0, error.slip_straight, error.current_straight_a);
    if (std::abs(g) > 12.0) continue;
    for (const double curvature : {0.07, 0.22, 0.4})
      compare(g, curvature, error.slip_turning, error.current_turning_a);
  }
  return error;
}

std::vector<std::string> fit_words(const CuadrigaFit& fit) {
  const CuadrigaParameters& p = fit.model.parameters();
  Eigen::MatrixXd covariance = fit.search.covariance;
  covariance.topLeftCorner<3, 3>() = soil_covariance(fit);
  const auto error = [&](int k) { return std::sqrt(std::max(0.0, covariance(k, k))); };
  const auto together = [&](int a, int b) { return covariance(a, b) / (error(a) * error(b)); };
  const double cosine = std::cos(p.friction_angle_rad);
  std::vector<std::string> words{
      fmt::format("Fit of all logs: k_phi {:.3g} N/m^3 with k_c 0 and n 1 (standard error: a factor of "
                  "{:.2f}), friction angle {:.1f} +- {:.1f} deg with 1 kPa of cohesion, K {:.2f} mm (a "
                  "factor of {:.2f}), wheel torque per ampere {:.2f} +- {:.2f} N m, idle current {:.2f} +- "
                  "{:.2f} A for all four motors. Correlations: stiffness and tan(phi) {:.2f}, stiffness "
                  "and K {:.2f}, tan(phi) and K {:.2f}.",
                  p.k_phi, std::exp(error(0)), deg_from_rad(p.friction_angle_rad),
                  deg_from_rad(error(1) * cosine * cosine), 1e3 * p.shear_modulus_m, std::exp(error(2)),
                  p.torque_per_ampere_nm, error(3), p.idle_current_a, error(4), together(0, 1),
                  together(0, 2), together(1, 2)),
      fmt::format("A wheel that the ground drives, down a slope or inside a turn, returns {:.2f} +- {:.2f} "
                  "of the current that belongs to its torque, which is 0 within the error. The motors of "
                  "sim/rover/motor.h return all of it, so that predictions with the shipped rover miss the "
                  "charge that turns and steep descents cost.",
                  p.returned_share, error(5)),
      fmt::format("The soil is the one that this model needs and was not measured: the model has a rigid "
                  "wheel in place of a tyre, and one soil for several sites. Only soils on which the rover "
                  "climbs {:.0f} deg were allowed, as it did (net traction, tan(phi) less rolling "
                  "resistance, at least {:.2f}); {} The wheel speed was calibrated on level ground, where "
                  "the model slips {:.3f}; slip counts from there.",
                  ClimbTable::kMaxGradient_deg, cuadriga_unknowns()[1].lowest,
                  fit.search.on_bound[1] ? "the fit lies on that bound, and its errors ignore the bound."
                                         : "the fit does not lie on that bound.",
                  fit.model.level_slip()),
      "Priors: stiffness 3e6 N/m^3 with a factor of e^1.5, net traction 0.65 +- 0.15, K 10 mm with "
      "a factor of e, returned share 0 +- 1; torque per ampere and idle current have none. Gear "
      "ratio, efficiency and torque constant are estimated as one product."};
  for (const gap::UndeterminedDirection& direction : fit.search.undetermined)
    words.push_back("Undetermined: " + direction.words + ".");
  return words;
}

double shipped_difference(const api::Catalogue& catalogue, const CuadrigaParameters& p) {
  const auto soil = catalogue.soils.find("uma_rescue_area");
  if (soil == catalogue.soils.end()) return 1.0;
  const sim::Soil& ground = soil->second.mean;
  const sim::RoverModel& rover = *catalogue.rovers.at("cuadriga");
  const sim::DriveMotor& drive = rover.drive;
  const double per_ampere = drive.torque_constant_nm_per_a * drive.gear_ratio * drive.gear_efficiency;
  const double idle = drive.no_load_current_a * static_cast<double>(rover.wheels.size());
  const auto off = [](double shipped, double fitted) { return std::abs(shipped / fitted - 1.0); };
  return std::max({off(ground.pressure.k_phi, p.k_phi), off(ground.friction_angle_rad, p.friction_angle_rad),
                   off(ground.shear_modulus_x_m, p.shear_modulus_m), off(per_ampere, p.torque_per_ampere_nm),
                   off(idle, p.idle_current_a)});
}

}  // namespace slipway::validation
