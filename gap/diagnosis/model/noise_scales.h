#pragma once

#include <array>
#include <string_view>

namespace slipway::gap {

// What makes drives of the same kind differ, besides the sensors: the soil of each drive and each of its
// windows, and what the model leaves over in every window. One standard deviation each.
struct NoiseScales {
  // Of each drive's soil around the campaign's: logarithms of stiffness, tan(friction angle), shear modulus.
  double stiffness = 0.1, friction = 0.02, shear_modulus = 0.1;
  double within_drives = 0.7;  // of the same from window to window, over that from drive to drive
  // Of each window, for what the map's detail does: the attitude under which weights act, the centre of load.
  double lean_rad = 0.002, load_shift_m = 0.003;
  double slip = 0.004, side_slip = 0.004, yaw_rate_rad_s = 0.0002, attitude_rad = 0.003;
  double current_share = 0.01;  // of the current
  double sinkage_m = 0.0005;
};
constexpr int kNoiseScales = 12;
constexpr int kWithinScale = 3;  // the position of within_drives

// In the order of NoiseScales.
inline std::array<double*, kNoiseScales> numbers_of(NoiseScales& s) {
  return {&s.stiffness, &s.friction,  &s.shear_modulus,  &s.within_drives, &s.lean_rad,      &s.load_shift_m,
          &s.slip,      &s.side_slip, &s.yaw_rate_rad_s, &s.attitude_rad,  &s.current_share, &s.sinkage_m};
}

constexpr std::array<std::string_view, kNoiseScales> kScaleNames{"the soil's stiffness",
                                                                 "the soil's friction",
                                                                 "the soil's shear modulus",
                                                                 "the soil within a drive",
                                                                 "the ground's attitude",
                                                                 "the centre of load",
                                                                 "slip",
                                                                 "side slip",
                                                                 "yaw rate",
                                                                 "attitude",
                                                                 "currents",
                                                                 "sinkage"};

}  // namespace slipway::gap
