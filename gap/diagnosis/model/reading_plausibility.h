#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gap/diagnosis/model/drive_campaign.h"

namespace slipway::gap {

// How large the readings of a kind of column usually are at most, and can be at most, in the unit of the
// campaign's files. A reading beyond them was recorded in another unit, or wrongly.
struct ReadingLimit {
  std::string_view column;    // how the names of such columns end, as in "drive-campaign/1"
  std::string_view readings;  // what they are, in the plural
  std::string_view unit;
  double likely = 0.0, possible = 0.0;            // of the size
  std::string_view likely_since, possible_since;  // why
  // The reading of a wheel in a row, in the unit; rows' own readings are the same for all wheels.
  double (*of)(const DriveSample& sample, std::size_t wheel) = nullptr;
};

// Those of the campaign's rover at its gravity and commanded speeds.
std::vector<ReadingLimit> reading_limits(const DriveCampaign& campaign);

// The fastest wheel's commanded rate, rad/s.
double greatest_commanded_rate(const DriveCampaign& campaign, const MeasuredDriveSeries& drive);

// How far drives led from their first pose, over the commanded way: slip may be near 1, never far below 0.
inline constexpr double kShortestWay = 0.02, kLongestWay = 3.0;

// The median of that over the drives; none where no drive had a way to go, as in turns in place.
std::optional<double> median_way_share(const DriveCampaign& campaign);

// A note of each kind of reading of which half are beyond what is likely, and of ways that are far from the
// commanded ones. Such drives are read all the same.
std::vector<std::string> notes_of_implausible_readings(const DriveCampaign& campaign);

}  // namespace slipway::gap
