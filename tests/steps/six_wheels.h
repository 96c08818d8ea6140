#pragma once

#include "core/angle.h"
#include "sim/rover/rover_model.h"

namespace slipway::steps {

// A rover of Curiosity's size on six wheels without cleats.
inline sim::RoverModel six_wheels() {
  sim::RoverModel rover;
  rover.name = "six_wheels";
  rover.mass_kg = 900.0;
  rover.com_m = {0.0, 0.0, 0.7};
  const auto add = [&](const char* name, double x_m, double y_m, bool on_bogie) {
    sim::WheelModel wheel;
    wheel.name = name;
    wheel.position_m = {x_m, y_m, 0.25};
    wheel.radius_m = 0.25;
    wheel.width_m = 0.4;
    wheel.side = y_m > 0.0 ? sim::Side::kLeft : sim::Side::kRight;
    wheel.on_bogie = on_bogie;
    rover.wheels.push_back(std::move(wheel));
  };
  add("lf", 1.06, 1.12, false);
  add("lm", 0.0, 1.24, true);
  add("lr", -1.06, 1.12, true);
  add("rf", 1.06, -1.12, false);
  add("rm", 0.0, -1.24, true);
  add("rr", -1.06, -1.12, true);
  rover.suspension.rocker_pivot_m = {0.2, 0.85, 0.75};
  rover.suspension.bogie_pivot_m = {-0.53, 1.05, 0.55};
  rover.drive.torque_constant_nm_per_a = 0.03;
  rover.drive.gear_ratio = 1000.0;
  rover.drive.gear_efficiency = 0.55;
  rover.drive.no_load_current_a = 0.2;
  rover.drive.max_wheel_rate_rad_s = rad_from_deg(12.0);
  rover.belly_clearance_m = 0.6;
  rover.body_length_m = 2.65;
  rover.body_width_m = 2.9;
  return rover;
}

}  // namespace slipway::steps
