#include "sim/dynamic/dynamic_options.h"

#include <fmt/format.h>

#include <cmath>

namespace slipway::sim {

std::vector<Fault> faults_of(std::span<const DriveLeg> legs, const DynamicOptions& options) {
  std::vector<Fault> faults;
  for (std::size_t i = 0; i < legs.size(); ++i) {
    const DriveLeg& leg = legs[i];
    const double duration = commanded_duration_s(leg);
    if (!(duration > 0.0) || !std::isfinite(duration))
      faults.push_back(
          {fmt::format("/legs/{}", i), "a leg needs a length or a turn, and a speed that is not 0"});
  }
  if (legs.empty()) faults.push_back({"/legs", "a drive needs a leg"});
  if (!(options.relative_tolerance >= 1e-10 && options.relative_tolerance <= 1e-2))
    faults.push_back(
        {"/relative_tolerance",
         fmt::format("relative_tolerance = {:g}, must be in [1e-10, 0.01]", options.relative_tolerance)});
  if (options.contact_points < 1 || options.contact_points > 9)
    faults.push_back(
        {"/contact_points", fmt::format("contact_points = {}, must be in [1, 9]", options.contact_points)});
  if (!(options.sample_interval_s > 0.0))
    faults.push_back({"/sample_interval_s", "sample_interval_s must be above 0"});
  return faults;
}

}  // namespace slipway::sim
