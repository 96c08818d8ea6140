#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "sealed_campaign.h"

namespace slipway::gap_benchmark {

// What observations of a stretch may depend on, and what is observed, by the diagnosis' names.
constexpr std::array<const char*, 8> kTraceVariables{"slope_deg", "cross_slope_deg", "slip",
                                                     "speed_m_s", "curvature_1_m",   "temperature_c",
                                                     "turning",   "time_s"};
enum TraceChannel { kSlip, kSideSlip, kYawRate, kRoll, kPitch, kCurrent, kSinkage };
constexpr std::array<const char*, 7> kTraceChannels{"slip",  "side_slip", "yaw_rate", "roll",
                                                    "pitch", "current",   "sinkage"};

// What the hidden causes do to a stretch of a drive (1.5 m of commanded way, or 0.8 rad of a turn).
struct EffectTrace {
  std::string drive;
  std::array<double, kTraceVariables.size()> variables{};
  // Squared, mean over the wheels of a wheel's channel; nothing where it is not observed there.
  std::array<std::optional<double>, kTraceChannels.size()> mean_square;
};

// Of every stretch: mean reading less the one that the same rover on the same soil at the same poses would
// give without the hidden causes, over the deviation of a stretch's mean: of its sensors, and of what the
// soil scatters from drive to drive. None where nothing is hidden.
std::vector<EffectTrace> effect_traces(const SealedCampaign& campaign);

// traces.csv: campaign, drive, the variables, then NAME_mean_square of each channel.
std::string traces_header();
std::string traces_rows(const std::string& campaign, const std::vector<EffectTrace>& traces);

}  // namespace slipway::gap_benchmark
