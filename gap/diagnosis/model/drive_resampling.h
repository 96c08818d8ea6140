#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "gap/diagnosis/model/drive_campaign.h"

namespace slipway::gap {

// A number for each drive, from 0 in their order; repeats share that of the drive they repeat.
std::vector<std::size_t> repeat_groups(const DriveCampaign& campaign);

// Resamples of a campaign's drives: of groups, with replacement.
struct DriveResampling {
  std::vector<std::size_t> groups;  // of each drive, as repeat_groups
  std::size_t group_count = 0;
  std::vector<std::vector<std::size_t>> resamples;
};
DriveResampling resample_drives(const DriveCampaign& campaign, int resamples, std::uint64_t seed);

// Bootstrap: each resample is `count` indices below `count`, drawn with replacement. The same seed gives the
// same.
std::vector<std::vector<std::size_t>> resampled_indices(std::size_t count, int resamples, std::uint64_t seed);

}  // namespace slipway::gap
