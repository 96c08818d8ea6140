#include "sim/wheel_radius.h"

#include <array>

namespace slipway::sim {
namespace {

constexpr std::array kFields{
    Field{"ratio", "1", "effective radius over the file's", 0.8, 1.2, 1.0},
};

void apply(std::span<const double> values, RoverModel& rover) {
  const double ratio = values[0];
  // B's origin stays on the ground, so everything above the axles rises by what the radius grows.
  const double rise = (ratio - 1.0) * rover.smallest_wheel_radius_m();
  for (WheelModel& wheel : rover.wheels) {
    wheel.position_m.z() += (ratio - 1.0) * wheel.radius_m;
    wheel.radius_m *= ratio;
  }
  rover.com_m.z() += rise;
  rover.suspension.rocker_pivot_m.z() += rise;
  rover.suspension.bogie_pivot_m.z() += rise;
  rover.belly_clearance_m += rise;
}

}  // namespace

constexpr Effect kWheelRadius{"wheel_radius",
                              "the wheels' effective radius differs from the file's",
                              "Zhurong section 2.2: lugs between 145 and 150 mm",
                              kFields,
                              &apply,
                              nullptr};

}  // namespace slipway::sim
