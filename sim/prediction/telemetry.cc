#include "sim/prediction/telemetry.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace slipway::sim {
namespace {

// Floors of what is divided by or taken the logarithm of.
constexpr double kMinTravel = 1e-3;     // share of the way that the wheels roll
constexpr double kMinCurrent_a = 0.01;  // of a motor

constexpr double kSlipFloor = 0.02;
constexpr double kCurrentModelError = 0.2;

double normal_density(double deviation, double sd) {
  const double z = deviation / sd;
  return std::exp(-0.5 * z * z) / (sd * std::sqrt(2.0 * std::numbers::pi));
}

// One that says nothing is uniform over slips of 0 to 1, and over currents that are e times as large.
double with_model_error(double density, double model_error) {
  return (1.0 - model_error) * density + model_error;
}

double current_likelihood(double measured_a, double drawn_a, double noise_a, double model_error) {
  const double measured = std::max(std::abs(measured_a), kMinCurrent_a);
  const double drawn = std::max(drawn_a, kMinCurrent_a);
  const double sd = std::hypot(kCurrentModelError, noise_a / std::max(measured, drawn));
  return with_model_error(normal_density(std::log(measured / drawn), sd), model_error);
}

}  // namespace

double slip_deviation(double slip_ratio, double slip_error, double rolled_m, double position_m) {
  const double travel = std::max(1.0 - slip_ratio, kMinTravel);
  const double positions = std::numbers::sqrt2 * position_m / rolled_m;
  return std::hypot(positions, travel * std::log(travel) * slip_error, kSlipFloor);
}

double unresolved_slip_error(const SoilDistribution& belief) {
  return std::sqrt(belief.shares.patch) * belief.slip_error;
}

double likelihood(const MeasuredStretch& measured, const DrawnStretch& drawn, const TelemetryErrors& errors) {
  const double sd = slip_deviation(drawn.slip_ratio, drawn.slip_error, measured.rolled_m, errors.position_m);
  double all =
      with_model_error(normal_density(measured.slip_ratio() - drawn.slip_ratio, sd), errors.model_error);
  if (drawn.currents_a.empty()) return all;
  if (measured.current_a) {
    double sum = 0.0;
    for (const double current : drawn.currents_a) sum += current;
    const double noise = errors.current_a * std::sqrt(static_cast<double>(drawn.currents_a.size()));
    all *= current_likelihood(*measured.current_a, sum, noise, errors.model_error);
  }
  for (std::size_t k = 0; k < measured.wheel_currents_a.size() && k < drawn.currents_a.size(); ++k)
    if (measured.wheel_currents_a[k])
      all *= current_likelihood(*measured.wheel_currents_a[k], drawn.currents_a[k], errors.current_a,
                                errors.model_error);
  return all;
}

}  // namespace slipway::sim
