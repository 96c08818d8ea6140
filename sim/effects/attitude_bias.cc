#include "sim/effects/attitude_bias.h"

#include <array>

#include "core/angle.h"
namespace slipway::sim {
namespace {

constexpr std::array kFields{
    Field{"roll_deg", "deg", "true less reckoned roll", -10.0, 10.0, 0.0, 0.0},
    Field{"pitch_deg", "deg", "true less reckoned pitch, positive nose down", -10.0, 10.0, 1.0, 0.0},
};

void change(std::span<const double> values, RoverModel& rover) {
  rover.roll_bias_rad += rad_from_deg(values[0]);
  rover.pitch_bias_rad += rad_from_deg(values[1]);
}

}  // namespace

constexpr Effect kAttitudeBias{
    .name = "attitude_bias",
    .summary = "the true attitude differs from the map's or the inclinometer's",
    .reference =
        "ROAMS section 2.5 leaves bias out of its truth sensors; a DEM of 1 m cells misses tilt by degrees",
    .fields = kFields,
    .on_rover = &change};

}  // namespace slipway::sim
