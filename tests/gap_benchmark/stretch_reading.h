#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "sealed_campaign.h"

namespace slipway::gap_benchmark {

// The observed channels, by the diagnosis's names.
enum TraceChannel { kSlip, kSideSlip, kYawRate, kRoll, kPitch, kCurrent, kSinkage };
constexpr std::array<const char*, 7> kTraceChannels{"slip",  "side_slip", "yaw_rate", "roll",
                                                    "pitch", "current",   "sinkage"};

// A reading of slip above it only says that the slip was high.
constexpr double kStuckSlip = 0.9;

// 1.5 m of commanded distance, or 0.8 rad of a turn in place.
struct Stretch {
  std::size_t from = 0, to = 0;  // rows, both in it
  std::size_t middle() const { return (from + to) / 2; }
};

// Stretches of nearly equal time; neighbours share a row.
std::vector<Stretch> stretches_of(const MadeDrive& drive);

// One value for each wheel in a channel of the wheels, otherwise a single one; none where the channel is not
// observed.
using Reading = std::array<std::vector<double>, kTraceChannels.size()>;

// The readings of sensors without noise. The motion is computed as from a log, with the recorded heading and
// attitude.
Reading reading_of(const DriveOrder& order, const DriveRow& row);

// The standard deviation of the mean of a stretch's readings due to its sensors alone; for speeds and rates
// that of the line through positions or headings.
double sensor_deviation(std::size_t channel, const DriveOrder& order, std::span<const DriveRow> rows,
                        std::size_t surveyed, double mean);

// The drive's rows `at` as they would be in another world.
std::vector<std::optional<DriveRow>> replayed(const SealedCampaign& campaign, const World& world,
                                              const MadeDrive& drive, std::span<const DriveRow> at);

// The means of a stretch's readings, and what the hidden causes change of them. Sinkage is read in surveyed
// rows alone.
struct MeanReading {
  Reading mean, change;
  std::array<std::size_t, kTraceChannels.size()> rows{};  // that were read
};
// `without`: every row of the drive as it would be without the hidden causes; rows without one do not count.
MeanReading mean_reading_of(const MadeDrive& drive, const Stretch& stretch,
                            std::span<const std::optional<DriveRow>> without);

}  // namespace slipway::gap_benchmark
