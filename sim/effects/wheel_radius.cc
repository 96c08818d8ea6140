#include "sim/effects/wheel_radius.h"

#include <array>

namespace slipway::sim {
namespace {

constexpr std::array kFields{
    Field{"scale", "1", "effective radius over the rover file's, minus 1", -0.2, 0.2, 0.03, 0.0},
};

void change(std::span<const double> values, RoverModel& rover) {
  const double scale = values[0];
  // B's origin stays on the ground, so everything above the axles rises by what the radius grows.
  const double rise = scale * rover.smallest_wheel_radius_m();
  for (WheelModel& wheel : rover.wheels) {
    wheel.software_radius_m = wheel.reckoned_radius_m();
    wheel.position_m.z() += scale * wheel.radius_m;
    wheel.radius_m *= 1.0 + scale;
  }
  rover.com_m.z() += rise;
  rover.suspension.rocker_pivot_m.z() += rise;
  rover.suspension.bogie_pivot_m.z() += rise;
  rover.belly_clearance_m += rise;
}

EffectParameters hidden(const HiddenDraw& draw) {
  return {{"scale", draw.sign(0) * 0.03 * draw.size}};
}

}  // namespace

constexpr Effect kWheelRadius{.name = "wheel_radius",
                              .summary = "the wheels' effective radius differs from the rover file's",
                              .reference = "Zhurong section 2.2: lugs between 145 and 150 mm",
                              .fields = kFields,
                              .on_rover = &change,
                              .hidden = &hidden};

}  // namespace slipway::sim
