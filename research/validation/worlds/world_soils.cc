#include "research/validation/worlds/world_soils.h"

#include <fmt/format.h>

#include <cmath>
#include <memory>

#include "core/angle.h"
#include "core/random.h"

namespace slipway::validation {

std::string world_soil_name(int soil_class) {
  return fmt::format("class_{}", soil_class);
}

sim::SoilDistribution soil_of_class(double soil_class, double spread) {
  const double firm = soil_class / (kWorldSoils - 1);
  sim::SoilDistribution soil;
  soil.name = fmt::format("class_{:g}", soil_class);
  soil.summary = "A class of soil of a seeded world";
  soil.source = "made up, within the range of the soils in data/soils";
  sim::Soil& mean = soil.mean;
  mean.pressure = {.k_c = 1400.0, .k_phi = 500e3 * std::pow(5.0, firm), .n = 1.0};
  mean.cohesion_pa = 500.0 * std::pow(6.0, firm);
  mean.friction_angle_rad = rad_from_deg(30.0 + 7.0 * firm);
  mean.shear_modulus_x_m = mean.shear_modulus_y_m = 0.018 * std::pow(0.55, firm);
  mean.c1 = 0.285 + 0.145 * firm;
  mean.c2 = 0.32;
  soil.std = {.stiffness_ratio = 0.25 * spread,
              .n = 0.05 * spread,
              .cohesion_pa = 0.3 * mean.cohesion_pa * spread,
              .friction_angle_rad = rad_from_deg(2.0) * spread,
              .shear_modulus_ratio = 0.25 * spread};
  return soil;
}

sim::SoilBeliefs world_beliefs() {
  sim::SoilBeliefs beliefs;
  for (int k = 0; k < kWorldSoils; ++k) beliefs.known.push_back(soil_of_class(k));
  // The mean is that of the middle, with the spread of the ten about it.
  beliefs.unknown = soil_of_class(0.5 * (kWorldSoils - 1));
  beliefs.unknown.name = "unknown_ground";
  beliefs.unknown.std = {.stiffness_ratio = 0.6,
                         .n = 0.05,
                         .cohesion_pa = 0.6 * beliefs.unknown.mean.cohesion_pa,
                         .friction_angle_rad = rad_from_deg(3.0),
                         .shear_modulus_ratio = 0.3};
  for (const sim::SoilDistribution& soil : beliefs.known)
    beliefs.unknown.alternatives.push_back(
        {soil.name, std::make_shared<const sim::SoilDistribution>(soil), 1.0, 1.0});
  beliefs.unknown.alternatives_by = sim::AlternativesBy::kUnit;
  return beliefs;
}

sim::SoilBeliefs other_soils(std::uint64_t seed) {
  const double spread = seed % 2 == 1 ? 0.5 : 2.0;
  sim::SoilBeliefs soils;
  for (int k = 0; k < kWorldSoils; ++k) {
    const double step = random_uniform(seed, static_cast<std::uint64_t>(k)) < 0.5 ? -0.5 : 0.5;
    soils.known.push_back(soil_of_class(k + step, spread));
  }
  return soils;
}

}  // namespace slipway::validation
