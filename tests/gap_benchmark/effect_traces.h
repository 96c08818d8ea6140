#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "sealed_campaign.h"
#include "stretch_reading.h"

namespace slipway::gap_benchmark {

// The variables on which observations of a stretch may depend, by the diagnosis's names.
constexpr std::array<const char*, 8> kTraceVariables{"slope_deg", "cross_slope_deg", "slip",
                                                     "speed_m_s", "curvature_1_m",   "temperature_c",
                                                     "turning",   "time_s"};

// The action of the hidden causes in a stretch of a drive.
struct EffectTrace {
  std::string drive;
  std::array<double, kTraceVariables.size()> variables{};
  // The squared change in units of its standard deviation, for wheels' channels the mean over wheels; empty
  // where the channel is not observed.
  std::array<std::optional<double>, kTraceChannels.size()> mean_square;
};

// For every stretch: the mean reading less the one that the same rover on the same soil at the same poses
// would give without the hidden causes, over the standard deviation of a stretch's mean, which is that of its
// sensors and of the soil's scatter from drive to drive. Empty where nothing is hidden.
std::vector<EffectTrace> effect_traces(const SealedCampaign& campaign);

// traces.csv: campaign, drive, the variables, then NAME_mean_square of each channel.
std::string traces_header();
std::string traces_rows(const std::string& campaign, const std::vector<EffectTrace>& traces);

}  // namespace slipway::gap_benchmark
