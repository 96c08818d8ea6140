#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/model_field.h"
#include "core/result.h"
#include "sim/rover/rover_model.h"

namespace slipway::sim {

// The numbers of a rover's file, object by object, each in the order in which it is written. Points
// (positions, pivots, inertia) and what is no number are read and checked by themselves.
std::span<const ModelField<RoverModel>> mass_fields();
std::span<const ModelField<MassDistribution>> part_mass_fields();  // of "masses"
std::span<const ModelField<WheelModel>> wheel_fields();
std::span<const ModelField<Grousers>> grouser_fields();
std::span<const ModelField<Suspension>> differential_fields();  // of suspensions with rockers
std::span<const ModelField<Suspension>> bogie_fields();         // of a rocker-bogie besides
std::span<const ModelField<DriveMotor>> motor_fields();
std::span<const ModelField<PowerSupply>> power_fields();
std::span<const ModelField<RoverModel>> closure_fields();
std::span<const ModelField<RoverModel>> body_fields();

// Appends what of an object's numbers is out of range, at `pointer`/key, in the unit of the boundary.
template <class Owner>
void check_fields(std::span<const ModelField<Owner>> fields, const Owner& object, const std::string& pointer,
                  std::vector<Fault>& faults);

// "n = 9, must be in [0.01, 3]".
std::string out_of_range_in_words(std::string_view key, double value, const Field& field);

}  // namespace slipway::sim
