#include "sim/effects/steering_offset.h"

#include <array>
#include <cmath>

#include "core/angle.h"
namespace slipway::sim {
namespace {

constexpr std::array kFields{
    Field{"angle_deg", "deg", "true less told angle, positive to the left", -20.0, 20.0, 2.0, 0.0},
    Field{"wheel", "1", "number of the wheel in the rover's list, from 0; -1 for all that steer", -1.0, 11.0,
          -1.0},
};

void change(std::span<const double> values, RoverModel& rover) {
  const long number = std::lround(values[1]);
  for (std::size_t k = 0; k < rover.wheels.size(); ++k) {
    WheelModel& wheel = rover.wheels[k];
    if (wheel.steerable && (number < 0 || static_cast<std::size_t>(number) == k))
      wheel.steering_offset_rad += rad_from_deg(values[0]);
  }
}

}  // namespace

constexpr Effect kSteeringOffset{.name = "steering_offset",
                                 .summary = "steered wheels stand at another angle than told",
                                 .reference = "ROAMS section 4.1: heading errors in tight arcs",
                                 .fields = kFields,
                                 .on_rover = &change};

}  // namespace slipway::sim
