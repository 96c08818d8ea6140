#pragma once

#include <Eigen/Core>
#include <span>
#include <string_view>

#include "sim/soil.h"

namespace slipway::sim {

// The quadrature nodes along an arc at which laws are evaluated together.
constexpr int kArcNodes = 8;
using ArcValues = Eigen::Array<double, kArcNodes, 1>;

// A law for the pressure under a wheel's rim at given depths. Must be zero at depth 0, positive and rising
// below.
struct PressureSinkageLaw {
  std::string_view name;
  std::string_view summary;
  std::string_view reference;
  // depth_m >= 0; width_m of the smaller side of the contact; n is the exponent in force (slip sinkage
  // included).
  ArcValues (*pressure_pa)(const BekkerModuli& moduli, double n, double width_m, const ArcValues& depth_m);
};

// A law for the share of the soil's shear strength that is mobilised at a shear displacement. Must be 0 at 0,
// rise, and stay below or at 1.
struct ShearLaw {
  std::string_view name;
  std::string_view summary;
  std::string_view reference;
  ArcValues (*mobilised)(const ArcValues& displacement_m, double shear_modulus_m);
};

// Explicit lists; the first row of each is what the wheel uses.
std::span<const PressureSinkageLaw> pressure_sinkage_catalogue();
std::span<const ShearLaw> shear_catalogue();

}  // namespace slipway::sim
