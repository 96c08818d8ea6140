#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "gap/diagnosis/model/outside_cause.h"

namespace slipway::gap {

// The rows of outside_catalogue, in this order.
std::span<const OutsideCause> outside_force_rows();
std::span<const OutsideCause> outside_rover_rows();
std::span<const OutsideCause> outside_soil_rows();
std::span<const OutsideCause> outside_sensor_rows();

// What rows are made of.

// A free number, normal around 0, within ten deviations.
sim::EffectVariant::Free outside_number(std::string field, double std);
sim::EffectVariant outside_variant(std::vector<sim::EffectVariant::Free> free, std::string label = {},
                                   std::vector<std::pair<std::string, double>> fixed = {});
// The field that marks the wheel of this index as one where a cause acts, and the indices so marked.
std::string wheel_field(std::size_t wheel);
std::vector<std::pair<std::string, double>> marks_of(std::span<const std::size_t> wheels);
std::vector<std::size_t> wheels_in(const OutsideValues& values);
std::vector<std::size_t> wheels_of_side(const sim::RoverModel& rover, double side);  // 1 left, -1 right
std::string names_of_wheels(const sim::RoverModel& rover,
                            std::span<const std::size_t> wheels);  // "lf and rf"

}  // namespace slipway::gap
