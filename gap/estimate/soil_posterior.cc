#include "gap/estimate/soil_posterior.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "core/angle.h"
#include "sim/soil/soil_field.h"

namespace slipway::gap {
namespace {

// The axes of a distribution's quantities, in the order of sim::SoilNormals.
constexpr std::array<SoilParameter, sim::kSoilDims> kQuantities{
    SoilParameter::kBekker, SoilParameter::kN, SoilParameter::kCohesion, SoilParameter::kFrictionAngle,
    SoilParameter::kShearModulus};

// What a soil's file holds at most: ratios, n, Pa, rad.
constexpr std::array<double, sim::kSoilDims> kMax{2.0, 1.0, 1e6, rad_from_deg(30.0), 2.0};

std::array<double*, sim::kSoilDims> fields_of(sim::SoilStd& std) {
  return {&std.stiffness_ratio, &std.n, &std.cohesion_pa, &std.friction_angle_rad, &std.shear_modulus_ratio};
}

}  // namespace

double coordinate_std(const sim::SoilDistribution& soil, SoilParameter axis, const SoilAxes& axes) {
  const double angle = soil.mean.friction_angle_rad;
  switch (axis) {
    case SoilParameter::kBekker:
      return soil.std.stiffness_ratio;
    case SoilParameter::kKc:
    case SoilParameter::kKphi:
      return soil.std.stiffness_ratio * axes.scale(axis);
    case SoilParameter::kN:
      return soil.std.n / soil.mean.pressure.n;
    case SoilParameter::kCohesion:
      return soil.std.cohesion_pa;
    case SoilParameter::kFrictionAngle:
      return soil.std.friction_angle_rad / (std::sin(angle) * std::cos(angle));
    case SoilParameter::kShearModulus:
      return soil.std.shear_modulus_ratio;
  }
  return 0.0;
}

sim::SoilDistribution posterior_soil(const sim::SoilDistribution& nominal, const sim::Soil& fitted,
                                     const SoilAxes& axes, std::span<const std::size_t> places,
                                     const LeastSquaresFit& fit) {
  sim::SoilDistribution soil = nominal;
  soil.mean = fitted;
  // A bound's end may be passed by rounding, which the reader of soil files would not take.
  for (const sim::SoilField& row : sim::soil_fields()) {
    double& kept = row.number(soil.mean);
    const double value = row.to_boundary(kept);
    if (!row.holds(value)) kept = row.from_boundary(std::clamp(value, row.field.lowest, row.field.highest));
  }
  soil.assumed = {"correlation_length_m: the nominal soil's",
                  "what was not estimated: the nominal soil's, see its source"};
  std::array<std::optional<std::size_t>, sim::kSoilDims> place;
  const auto fields = fields_of(soil.std);
  for (std::size_t q = 0; q < kQuantities.size(); ++q) {
    for (std::size_t k = 0; k < axes.axes().size(); ++k)
      if (axes.axes()[k] == kQuantities[q] && fit.standard_error(places[k])) place[q] = places[k];
    if (!place[q]) continue;
    const double std = *fit.standard_error(*place[q]);
    double& field = *fields[q];
    // Of stiffness and shear modulus the ratio is the coordinate itself.
    const bool ratio =
        kQuantities[q] == SoilParameter::kBekker || kQuantities[q] == SoilParameter::kShearModulus;
    field = ratio ? std : axes.value_std(kQuantities[q], soil.mean, std);
    if (field > kMax[q]) {
      soil.assumed.push_back(fmt::format("std of {}: {:.3g} was found, a file holds {:.3g} at most",
                                         row_of(kQuantities[q]).name, field, kMax[q]));
      field = kMax[q];
    }
  }
  // Draws are log-normal: a cohesion of 0 has no spread.
  if (!(soil.mean.cohesion_pa > 0.0)) soil.std.cohesion_pa = 0.0;
  for (int a = 0; a < sim::kSoilDims; ++a)
    for (int b = 0; b < sim::kSoilDims; ++b) {
      const auto of_a = place[static_cast<std::size_t>(a)], of_b = place[static_cast<std::size_t>(b)];
      if (a == b || (!of_a && !of_b)) continue;
      soil.correlation(a, b) = of_a && of_b ? fit.correlation(*of_a, *of_b).value_or(0.0) : 0.0;
    }
  // Rounding can leave a matrix that is not positive definite.
  const auto sound = [&] {
    return Eigen::LLT<sim::SoilCorrelation>(soil.correlation).info() == Eigen::Success;
  };
  for (int round = 0; round < 40 && !sound(); ++round)
    for (int a = 0; a < sim::kSoilDims; ++a)
      for (int b = 0; b < sim::kSoilDims; ++b)
        if (a != b) soil.correlation(a, b) *= 0.995;
  return soil;
}

}  // namespace slipway::gap
