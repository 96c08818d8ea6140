#include "sim/effects/dragging_wheel.h"

#include <array>
#include <cmath>

#include "core/random.h"

namespace slipway::sim {
namespace {

constexpr std::array kFields{
    Field{"wheel", "1", "number of the wheel in the rover's list, from 0", 0.0, 11.0, 3.0},
    Field{"rate_share", "1", "share of the commanded rate at which it turns; 0: it is locked", 0.0, 1.0, 0.0,
          1.0},
    Field{"drag_nm", "N m", "torque that resists it at its axle", 0.0, 200.0, 0.0, 0.0},
};

void change(std::span<const double> values, RoverModel& rover) {
  const auto number = static_cast<std::size_t>(std::lround(values[0]));
  if (number >= rover.wheels.size()) return;
  WheelModel& wheel = rover.wheels[number];
  if (values[1] == 0.0) wheel.drive = WheelDrive::kLocked;
  if (values[1] > 0.0) wheel.rate_share *= values[1];
  wheel.drag_nm += values[2];
}

// Any one wheel. A locked wheel is an own case of the physics, so the share stays above 0.
std::vector<EffectVariant> variants(const RoverModel& rover) {
  std::vector<EffectVariant> all;
  for (std::size_t k = 0; k < rover.wheels.size(); ++k)
    all.push_back({.label = rover.wheels[k].name,
                   .free = {{"rate_share", 0.4, 0.02, 1.0}, {"drag_nm", 3.0, 0.0, 50.0}},
                   .fixed = {{"wheel", static_cast<double>(k)}}});
  return all;
}

EffectParameters hidden(const HiddenDraw& draw) {
  const double share = draw.size < 1.0 ? 1.0 : draw.size < 2.0 ? 0.85 : 0.4;
  return {{"wheel", static_cast<double>(random_bits(draw.key, 0) % draw.rover.wheels.size())},
          {"rate_share", share},
          {"drag_nm", 2.0 * draw.size}};
}

}  // namespace

constexpr Effect kDraggingWheel{.name = "dragging_wheel",
                                .summary = "one wheel turns slower than commanded or against a brake",
                                .reference = "ARTEMIS sections 1 and 2.3: Spirit's right front wheel",
                                .fields = kFields,
                                .on_rover = &change,
                                .wheel_field = "wheel",
                                .rate_field = "rate_share",
                                .variants = &variants,
                                .hidden = &hidden};

}  // namespace slipway::sim
