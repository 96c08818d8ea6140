#include "sim/effects/attitude_bias.h"

#include <array>

#include "core/angle.h"

namespace slipway::sim {
namespace {

constexpr std::array kFields{
    Field{"roll_deg", "deg", "true minus assumed roll", -10.0, 10.0, 0.0, 0.0},
    Field{"pitch_deg", "deg", "true minus assumed pitch, positive nose down", -10.0, 10.0, 1.0, 0.0},
};

void change(std::span<const double> values, RoverModel& rover) {
  rover.roll_bias_rad += rad_from_deg(values[0]);
  rover.pitch_bias_rad += rad_from_deg(values[1]);
}

// The inclinometer is wrong, or the map, or both by the same angle, in which case nothing shows it.
std::vector<EffectVariant> variants(const RoverModel& /*rover*/) {
  const std::vector<EffectVariant::Free> free{free_field(kFields, "roll_deg", 1.0),
                                              free_field(kFields, "pitch_deg", 1.0)};
  return {{.label = "the inclinometer alone", .free = free, .shown = 1.0, .acting = 0.0},
          {.label = "the map alone", .free = free, .shown = 1.0},
          {.label = "map and inclinometer", .free = free}};
}

TiltError shown_tilt(std::span<const double> values) {
  return {rad_from_deg(values[0]), rad_from_deg(values[1])};
}

EffectParameters hidden(const HiddenDraw& draw) {
  return {{"pitch_deg", draw.sign(0) * draw.size}, {"roll_deg", draw.sign(1) * 0.5 * draw.size}};
}

}  // namespace

constexpr Effect kAttitudeBias{
    .name = "attitude_bias",
    .summary = "the rover's true roll and pitch differ from what the map or the inclinometer says",
    .reference =
        "ROAMS section 2.5 leaves bias out of its truth sensors; a DEM of 1 m cells misses tilt by degrees",
    .fields = kFields,
    .on_rover = &change,
    .variants = &variants,
    .shown_tilt = &shown_tilt,
    .hidden = &hidden};

}  // namespace slipway::sim
