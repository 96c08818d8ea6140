#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

namespace slipway::sim {

// What feeds a rover and what it needs besides its drive motors, in watts at the bus.
struct PowerSupply {
  double constant_w = 0.0;        // of a source that gives the same all day
  double array_m2 = 0.0;          // solar cells, flat on the body
  double upright_array_m2 = 0.0;  // solar cells that stand upright around the body, as much to each side
  double array_efficiency = 0.2;  // power over the light on clean cells
  double array_clean = 1.0;       // share of the light that dust on the cells lets through
  double battery_wh = 1.0;        // that may be used, from empty to full
  double standing_w = 0.0;
  double driving_w = 0.0;  // without the motors
  double heating_w = 0.0;  // besides, where the air is colder than
  double heating_below_c = -200.0;

  bool has_array() const { return array_m2 > 0.0 || upright_array_m2 > 0.0; }
  // What the cells give under a beam, W/m^2 straight to the sun, and light from the whole sky, W/m^2 on the
  // level. `up` is the cosine between the body's up and the sun. Of cells that stand around the body a beam
  // from the side lights those that a cylinder turns to it, 1 / pi of all, and the sky half.
  double array_w(double beam_w_m2, double up, double sky_w_m2) const {
    const double side = std::sqrt(std::max(0.0, 1.0 - up * up)) / std::numbers::pi;
    return array_efficiency * array_clean *
           (array_m2 * (beam_w_m2 * std::max(0.0, up) + sky_w_m2) +
            upright_array_m2 * (beam_w_m2 * side + 0.5 * sky_w_m2));
  }

  bool operator==(const PowerSupply&) const = default;
};

}  // namespace slipway::sim
