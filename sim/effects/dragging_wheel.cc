#include "sim/effects/dragging_wheel.h"

#include <array>
#include <cmath>

namespace slipway::sim {
namespace {

constexpr std::array kFields{
    Field{"wheel", "1", "number of the wheel in the rover's list, from 0", 0.0, 11.0, 3.0},
    Field{"rate_share", "1", "of the told rate that it turns at; 0 is locked", 0.0, 1.0, 0.0, 1.0},
    Field{"drag_nm", "N m", "resisting torque at its axle", 0.0, 200.0, 0.0, 0.0},
};

void change(std::span<const double> values, RoverModel& rover) {
  const auto number = static_cast<std::size_t>(std::lround(values[0]));
  if (number >= rover.wheels.size()) return;
  WheelModel& wheel = rover.wheels[number];
  if (values[1] == 0.0) wheel.drive = WheelDrive::kLocked;
  if (values[1] > 0.0) wheel.rate_share *= values[1];
  wheel.drag_nm += values[2];
}

}  // namespace

constexpr Effect kDraggingWheel{.name = "dragging_wheel",
                                .summary = "one wheel turns slower than told or against a brake",
                                .reference = "ARTEMIS sections 1 and 2.3: Spirit's right front wheel",
                                .fields = kFields,
                                .on_rover = &change};

}  // namespace slipway::sim
