#pragma once

#include <span>
#include <string_view>

#include "sim/soil/soil.h"

namespace slipway::sim {

// A law for the pressure under a wheel's rim at given depths. Must be zero at depth 0, positive and rising
// below.
struct PressureSinkageLaw {
  std::string_view name;
  std::string_view summary;
  std::string_view reference;
  // stiffness: k_c / b + k_phi; n is the exponent in force (slip sinkage included); depth_m >= 0.
  double (*pressure_pa)(const double& stiffness, const double& n, const double& depth_m);
};

// A law for the share of the soil's shear strength that is mobilised at a shear displacement over the shear
// modulus. Must be 0 at 0, rise, and stay below or at 1.
struct ShearLaw {
  std::string_view name;
  std::string_view summary;
  std::string_view reference;
  double (*mobilised)(const double& displacement_over_modulus);
};

// Explicit lists; the first row of each is what the wheel uses.
std::span<const PressureSinkageLaw> pressure_sinkage_catalogue();
std::span<const ShearLaw> shear_catalogue();

}  // namespace slipway::sim
