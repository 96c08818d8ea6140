#include "api/files/noise_scales.h"

#include "core/angle.h"

namespace slipway::api::json {

void write_noise_scales(Writer& w, const gap::NoiseScales& noise) {
  w.begin_object();
  w.significant("soil_stiffness", noise.stiffness).significant("soil_friction", noise.friction);
  w.significant("soil_shear_modulus", noise.shear_modulus).significant("within_drives", noise.within_drives);
  w.significant("lean_deg", deg_from_rad(noise.lean_rad)).significant("load_shift_m", noise.load_shift_m);
  w.significant("slip", noise.slip).significant("side_slip", noise.side_slip);
  w.significant("yaw_rate_deg_s", deg_from_rad(noise.yaw_rate_rad_s));
  w.significant("attitude_deg", deg_from_rad(noise.attitude_rad));
  w.significant("current_share", noise.current_share).significant("sinkage_m", noise.sinkage_m);
  w.end_object();
}

gap::NoiseScales read_noise_scales(ObjectReader reader) {
  gap::NoiseScales noise;
  const auto number = [&](std::string_view key, std::string_view unit, double& out) {
    reader.number(key, kRequired, {unit, 0.0, 1e3}, out);
  };
  const auto angle = [&](std::string_view key, std::string_view unit, double& out) {
    reader.angle_deg(key, kRequired, {unit, 0.0, 1e3}, out);
  };
  number("soil_stiffness", "", noise.stiffness);
  number("soil_friction", "", noise.friction);
  number("soil_shear_modulus", "", noise.shear_modulus);
  number("within_drives", "", noise.within_drives);
  angle("lean_deg", "deg", noise.lean_rad);
  number("load_shift_m", "m", noise.load_shift_m);
  number("slip", "", noise.slip);
  number("side_slip", "", noise.side_slip);
  angle("yaw_rate_deg_s", "deg/s", noise.yaw_rate_rad_s);
  angle("attitude_deg", "deg", noise.attitude_rad);
  number("current_share", "", noise.current_share);
  number("sinkage_m", "m", noise.sinkage_m);
  reader.refuse_unknown();
  return noise;
}

}  // namespace slipway::api::json
