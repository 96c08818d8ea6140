#pragma once

namespace slipway::sim {

// What feeds a rover and what it needs besides its drive motors, in watts at the bus.
struct PowerSupply {
  double constant_w = 0.0;        // of a source that gives the same all day
  double array_m2 = 0.0;          // solar cells, flat on the body
  double array_efficiency = 0.2;  // power over the light on clean cells
  double array_clean = 1.0;       // share of the light that dust on the cells lets through
  double battery_wh = 1.0;        // that may be used, from empty to full
  double standing_w = 0.0;
  double driving_w = 0.0;  // without the motors
  double heating_w = 0.0;  // besides, where the air is colder than
  double heating_below_c = -200.0;

  bool operator==(const PowerSupply&) const = default;
};

}  // namespace slipway::sim
