#pragma once

#include <cstdint>
#include <string>

#include "sim/prediction/drive_prediction.h"

namespace slipway::validation {

// The classes of soil of a seeded world: number 0 is the loosest, the last the firmest.
inline constexpr int kWorldSoils = 10;
std::string world_soil_name(int soil_class);

// The belief about a class: from k_phi 500 kN/m^3, 500 Pa, 30 deg and K 18 mm to 2.5 MN/m^3, 3 kPa, 37 deg
// and 9.9 mm, in equal steps (of the logarithm for all but the angle), with the spread of the shipped soils
// (25 % of stiffness and K, 30 % of cohesion, 2 deg) times `spread`. On the loosest a rover like the Mars
// Exploration Rovers slips by a sixth on the level and by 40 % at some 5 deg, on the firmest at some 18 deg.
// The class may be a fraction, and beyond the ends: a soil between two classes, or looser than all.
sim::SoilDistribution soil_of_class(double soil_class, double spread = 1.0);

// What a planner believes of a world: the ten classes, in their order; and of unknown ground that it is one
// of the ten, each as likely as another, another one for each unit of ground.
sim::SoilBeliefs world_beliefs();

// Soils that no planner believes in: each class is half a step looser or firmer than believed (by a draw of
// the seed), and its spread is half of what is believed where the seed is odd, and double where it is even.
sim::SoilBeliefs other_soils(std::uint64_t seed);

}  // namespace slipway::validation
