#include "sim/soil/soil.h"

#include <Eigen/Cholesky>
#include <cmath>

#include "sim/soil/soil_law_catalogue.h"

namespace slipway::sim {
namespace {

// A log-normal with the given mean and standard deviation: its logarithm is normal with standard deviation s
// and mean ln(mean) - s^2 / 2, where s^2 = ln(1 + (std / mean)^2).
double log_normal(double mean, double std, double standard_normal) {
  if (mean <= 0.0 || std <= 0.0) return mean;
  const double ratio = std / mean;
  const double s2 = std::log1p(ratio * ratio);
  return mean * std::exp(std::sqrt(s2) * standard_normal - 0.5 * s2);
}

}  // namespace

PressureForm Soil::pressure_form(const ContactSize& contact) const {
  if (pressure_law.row == nullptr) return {pressure.stiffness(contact.width_m), 1.0};
  PressureForm form = pressure_law.row->form(*this, contact);
  form.stiffness *= pressure_law.stiffening;
  return form;
}

SoilNormals towards_weakness() {
  SoilNormals normals;
  normals << -0.5, 0.0, -0.5, -0.5, 0.5;
  return normals;
}

Soil draw_soil(const SoilDistribution& distribution, const SoilNormals& normals,
               const ClosureNormals& closures) {
  SoilNormals z = normals;
  if (!distribution.correlation.isIdentity(0.0)) {
    z = Eigen::LLT<SoilCorrelation>(distribution.correlation).matrixL() * normals;
  }
  const Soil& mean = distribution.mean;
  const SoilStd& std = distribution.std;
  Soil soil = mean;
  if (mean.slip_curve != nullptr) {
    soil.slip_deviation = std.slip_ratio * towards_weakness().dot(normals);
    return soil;
  }
  const double stiffness = log_normal(1.0, std.stiffness_ratio, z[0]);
  soil.stiffen(stiffness);
  soil.pressure.n = log_normal(mean.pressure.n, std.n, z[1]);
  soil.cohesion_pa = log_normal(mean.cohesion_pa, std.cohesion_pa, z[2]);
  if (std.friction_angle_rad > 0.0) {
    // The spread of the tangent to first order, so that every draw is an angle below a right angle.
    const double tangent = std::tan(mean.friction_angle_rad);
    const double tangent_std = std.friction_angle_rad * (1.0 + tangent * tangent);
    soil.friction_angle_rad = std::atan(log_normal(tangent, tangent_std, z[3]));
  }
  const double shear = log_normal(1.0, std.shear_modulus_ratio, z[4]);
  soil.shear_modulus_x_m = mean.shear_modulus_x_m * shear;
  soil.shear_modulus_y_m = mean.shear_modulus_y_m * shear;
  const double rho = distribution.closure_correlation;
  soil.c1 = log_normal(mean.c1, std.c1, closures[0]);
  soil.c2 = log_normal(mean.c2, std.c2, rho * closures[0] + std::sqrt(1.0 - rho * rho) * closures[1]);
  return soil;
}

}  // namespace slipway::sim
