#include "gap/estimate/plate_sinkage.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace slipway::gap {
namespace {

struct Sample {
  double radius_m, sinkage_m, pressure_pa;
};

std::vector<Sample> usable(std::span<const PlateRecord> tests, PlateMeasure measure) {
  const bool logarithms = measure == PlateMeasure::kLogPressure || measure == PlateMeasure::kWongWeighted;
  std::vector<Sample> samples;
  for (const PlateRecord& test : tests)
    for (std::size_t i = 0; i < std::min(test.sinkage_m.size(), test.pressure_pa.size()); ++i)
      if (test.sinkage_m[i] > 0.0 && (!logarithms || test.pressure_pa[i] > 0.0))
        samples.push_back({test.radius_m, test.sinkage_m[i], test.pressure_pa[i]});
  return samples;
}

// ln k and n of the straight line through the logarithms: where the search starts.
std::pair<double, double> line_through_logarithms(const std::vector<Sample>& samples) {
  double w = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;
  for (const Sample& s : samples) {
    if (s.pressure_pa <= 0.0) continue;
    const double u = std::log(s.sinkage_m), v = std::log(s.pressure_pa);
    w += 1.0;
    x += u;
    y += v;
    xx += u * u;
    xy += u * v;
  }
  const double spread = w * xx - x * x;
  if (!(spread > 1e-12 * std::max(1.0, w * xx))) return {std::log(1e6), 1.0};
  const double n = std::clamp((w * xy - x * y) / spread, 0.2, 3.0);
  return {(y - n * x) / w, n};
}

double residual_of(const Sample& s, double stiffness, double n, PlateMeasure measure) {
  const double error_pa = stiffness * std::pow(s.sinkage_m, n) - s.pressure_pa;
  switch (measure) {
    case PlateMeasure::kForce:
      return std::numbers::pi * s.radius_m * s.radius_m * error_pa;
    case PlateMeasure::kPressure:
      return error_pa;
    case PlateMeasure::kWongWeighted:
      return s.pressure_pa * (std::log(stiffness) + n * std::log(s.sinkage_m) - std::log(s.pressure_pa));
    case PlateMeasure::kLogPressure:
      return std::log(stiffness) + n * std::log(s.sinkage_m) - std::log(s.pressure_pa);
  }
  return error_pa;
}

void judge(const std::vector<Sample>& samples, ModuliFit& fit) {
  double mean = 0.0, left = 0.0, all = 0.0;
  const auto n = static_cast<double>(samples.size());
  for (const Sample& s : samples) mean += s.pressure_pa / n;
  for (const Sample& s : samples) {
    left +=
        std::pow(fit.moduli.stiffness(s.radius_m) * std::pow(s.sinkage_m, fit.moduli.n) - s.pressure_pa, 2);
    all += std::pow(s.pressure_pa - mean, 2);
  }
  fit.rms_pa = std::sqrt(left / n);
  fit.explained_variance = all > 0.0 ? 1.0 - left / all : 0.0;
}

}  // namespace

Result<ModuliFit> fit_moduli(std::span<const PlateRecord> tests, const ModuliOptions& options,
                             Progress& progress) {
  const std::vector<Sample> samples = usable(tests, options.measure);
  const std::size_t first = options.cohesive_modulus ? 0 : 1;
  if (samples.size() < 4 - first)
    return fail(ErrorCode::kNoData, "the plate tests have fewer usable samples than unknowns");
  const auto [log_k, n] = line_through_logarithms(samples);
  const double k = std::exp(log_k);
  const std::vector<Unknown> all{
      {.name = "k_c", .start = 0.0, .step_scale = k * samples.front().radius_m, .prior = {}},
      {.name = "k_phi", .start = k, .step_scale = k, .prior = {}},
      {.name = "n", .start = n, .lowest = 0.0, .highest = 5.0, .step_scale = 1.0, .prior = {}}};
  // Residuals of order one, so that tolerances mean the same for newtons and logarithms.
  double scale = 0.0;
  for (const Sample& s : samples) scale = std::max(scale, std::abs(residual_of(s, k, n, options.measure)));
  if (!(scale > 0.0)) scale = 1.0;
  const ResidualFunction residuals = [&](std::span<const double> x, std::span<double> r) {
    const double k_c = first == 0 ? x[0] : 0.0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const double stiffness = k_c / samples[i].radius_m + x[1 - first];
      if (!(stiffness > 0.0)) return false;
      r[i] = residual_of(samples[i], stiffness, x[2 - first], options.measure) / scale;
    }
    return true;
  };
  const auto fitted = fit_least_squares(std::span(all).subspan(first), samples.size(), residuals,
                                        {.residual_std_known = false}, progress);
  if (!fitted) return fail(fitted.error());
  ModuliFit fit;
  fit.moduli = {first == 0 ? fitted->estimate[0] : 0.0, fitted->estimate[1 - first],
                fitted->estimate[2 - first]};
  const auto size = static_cast<Eigen::Index>(3 - first);
  fit.covariance.bottomRightCorner(size, size) = fitted->covariance;
  fit.undetermined = fitted->undetermined;
  fit.converged = fitted->converged;
  judge(samples, fit);
  return fit;
}

double AnnulusRecord::mean_stress_pa(double load) const {
  return load / (std::numbers::pi * (std::pow(outer_radius_m, 2) - std::pow(inner_radius_m, 2)));
}

double AnnulusRecord::shear_stress_pa(double torque) const {
  return torque /
         (2.0 / 3.0 * std::numbers::pi * (std::pow(outer_radius_m, 3) - std::pow(inner_radius_m, 3)));
}

Result<ShearStrengthFit> fit_shear_strength(const AnnulusRecord& test, Progress& progress) {
  const std::size_t count = std::min(test.load_n.size(), test.peak_torque_nm.size());
  if (count < 3) return fail(ErrorCode::kNoData, "an annulus test needs three loads");
  std::vector<double> sigma, tau;
  for (std::size_t i = 0; i < count; ++i) {
    sigma.push_back(test.mean_stress_pa(test.load_n[i]));
    tau.push_back(test.shear_stress_pa(test.peak_torque_nm[i]));
  }
  const double scale = *std::max_element(tau.begin(), tau.end());
  if (!(scale > 0.0)) return fail(ErrorCode::kNoData, "no torque was measured");
  const std::vector<Unknown> unknowns{
      {.name = "cohesion_pa", .start = 0.1 * scale, .step_scale = 0.1 * scale, .prior = {}},
      {.name = "friction_angle_rad",
       .start = 0.5,
       .lowest = 0.0,
       .highest = 1.5,
       .step_scale = 0.1,
       .prior = {}}};
  const ResidualFunction residuals = [&](std::span<const double> x, std::span<double> r) {
    for (std::size_t i = 0; i < count; ++i) r[i] = (x[0] + sigma[i] * std::tan(x[1]) - tau[i]) / scale;
    return true;
  };
  const auto fitted = fit_least_squares(unknowns, count, residuals, {.residual_std_known = false}, progress);
  if (!fitted) return fail(fitted.error());
  ShearStrengthFit fit{fitted->estimate[0], fitted->estimate[1], fitted->covariance, 0.0};
  fit.rms_pa = scale * std::sqrt(2.0 * fitted->cost / static_cast<double>(count));
  return fit;
}

}  // namespace slipway::gap
