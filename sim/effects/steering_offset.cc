#include "sim/effects/steering_offset.h"

#include <array>
#include <cmath>

#include "core/angle.h"
#include "core/random.h"

namespace slipway::sim {
namespace {

constexpr std::array kFields{
    Field{"angle_deg", "deg", "true minus commanded angle, positive to the left", -20.0, 20.0, 2.0, 0.0},
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

// All wheels that steer, or one of them.
std::vector<EffectVariant> variants(const RoverModel& rover) {
  const EffectVariant::Free angle = free_field(kFields, "angle_deg", 2.0);
  std::vector<EffectVariant> all{{.label = "all that steer", .free = {angle}, .fixed = {{"wheel", -1.0}}}};
  for (std::size_t k = 0; k < rover.wheels.size(); ++k)
    if (rover.wheels[k].steerable)
      all.push_back(
          {.label = rover.wheels[k].name, .free = {angle}, .fixed = {{"wheel", static_cast<double>(k)}}});
  return all;
}

EffectParameters hidden(const HiddenDraw& draw) {
  std::vector<std::size_t> steered;
  for (std::size_t k = 0; k < draw.rover.wheels.size(); ++k)
    if (draw.rover.wheels[k].steerable) steered.push_back(k);
  const bool one = !steered.empty() && random_uniform(draw.key, 1) < 0.4;
  const double wheel = one ? static_cast<double>(steered[random_bits(draw.key, 2) % steered.size()]) : -1.0;
  return {{"angle_deg", draw.sign(0) * 2.0 * draw.size}, {"wheel", wheel}};
}

}  // namespace

constexpr Effect kSteeringOffset{.name = "steering_offset",
                                 .summary = "steered wheels stand at another angle than commanded",
                                 .reference = "ROAMS section 4.1: heading errors in tight arcs",
                                 .fields = kFields,
                                 .on_rover = &change,
                                 .wheel_field = "wheel",
                                 .variants = &variants,
                                 .hidden = &hidden};

}  // namespace slipway::sim
