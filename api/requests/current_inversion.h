#pragma once

#include <optional>
#include <string>
#include <vector>

#include "api/files/catalogue.h"
#include "core/result.h"
#include "sim/rover/effect_setting.h"
#include "sim/single_wheel/current_inverse.h"

namespace slipway::api {

// The question which slip a wheel's measured current means, and how much pull is left. Empty values stand for
// defaults.
struct CurrentInversionRequest {
  std::string rover;
  std::string wheel;  // the rover's first where it is empty
  std::string soil;
  double current_a = 0.0;
  std::optional<double> load_n;  // an equal share of the rover's weight where it is empty
  double gravity_m_s2 = 3.71;
  std::optional<double> speed_m_s;     // of the rim; the rover's cruise speed where it is empty
  std::optional<double> motor_temp_c;  // the motor's reference temperature where it is empty
  std::vector<sim::EffectSetting> effects;
  sim::InverseOptions options;
};

struct CurrentInversion {
  CurrentInversionRequest request;  // with the defaults filled in
  sim::CurrentInverse answer;
};

// Errors: invalid_request with all faults.
Result<CurrentInversion> invert_current(const Catalogue& catalogue, const CurrentInversionRequest& request);

}  // namespace slipway::api
