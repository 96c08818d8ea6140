#pragma once

#include <optional>

#include "sim/prediction/drive_prediction.h"
#include "sim/prediction/drive_risk.h"

namespace slipway::sim {

// The drive on the mean soils but for c1 and c2, which are those of a twentieth of what is believed of each
// soil: where c1 + c2 / 2 is least, and where it is greatest. Where a soil's file gives c1 and c2 no spread,
// it is that between soils. Nothing where all ground under the way is known by slip curves alone. The two
// drives are balanced as draws are. Without a meaning where `progress` was cancelled.
std::optional<ClosureReach> closure_reach(const RoverModel& rover, double gravity_m_s2,
                                          const SoilBeliefs& beliefs, const PreparedDrive& drive,
                                          const DriveLimits& limits, std::size_t threads,
                                          const Progress& progress);

}  // namespace slipway::sim
