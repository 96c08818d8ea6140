#pragma once

namespace slipway::gap_benchmark {

// One standard deviation of a reading, as every campaign.json states them.
constexpr double kPositionStd_m = 0.003, kAttitudeStd_deg = 0.2, kCurrentRel = 0.02, kCurrentStd_a = 0.003,
                 kSinkageStd_m = 0.001;

}  // namespace slipway::gap_benchmark
