#include "sim/effects/motor_temperature.h"

#include <algorithm>
#include <array>

namespace slipway::sim {
namespace {

constexpr std::array kFields{
    Field{"kt_per_k", "1/K", "fall of the torque constant per kelvin", 0.0, 0.005, 0.0011, 0.0},
    Field{"friction_per_k", "1/K", "fall of friction per kelvin", 0.0, 0.05, 0.02, 0.0},
    Field{"resistance_per_k", "1/K", "rise of the resistance per kelvin", 0.0, 0.01, 0.0039, 0.0},
    Field{"reference_c", "degC", "temperature at which the rover file's motor constants hold", -100.0, 100.0,
          20.0},
};

void change(std::span<const double> values, RoverModel& rover) {
  DriveMotor& drive = rover.drive;
  drive.torque_constant_per_k = values[0];
  drive.friction_per_k = values[1];
  drive.resistance_per_k = values[2];
  drive.reference_temp_c = values[3];
}

std::vector<EffectVariant> variants(const RoverModel& /*rover*/) {
  return {{.free = {free_field(kFields, "kt_per_k", 0.0011), free_field(kFields, "friction_per_k", 0.015)}}};
}

EffectParameters hidden(const HiddenDraw& draw) {
  return {{"kt_per_k", 0.0011 * draw.size}, {"friction_per_k", std::min(0.02 * draw.size, 0.03)}};
}

}  // namespace

constexpr Effect kMotorTemperature{
    .name = "motor_temperature",
    .summary = "the motors' torque constant, resistance and friction change with their temperature",
    .reference =
        "ARTEMIS section 3.2 and [Lindemann 2005]: torque depends strongly on temperature; NdFeB magnets "
        "lose 0.11 %/K, copper gains 0.39 %/K",
    .fields = kFields,
    .on_rover = &change,
    .reads_motor_temperature = true,
    .variants = &variants,
    .has_many_forms = true,
    .hidden = &hidden};

}  // namespace slipway::sim
