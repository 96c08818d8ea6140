#include "gap/diagnosis/model/drive_resampling.h"

#include <algorithm>
#include <map>
#include <string>

#include "core/random.h"

namespace slipway::gap {

std::vector<std::size_t> repeat_groups(const DriveCampaign& campaign) {
  std::map<std::string, std::size_t> numbers;
  std::vector<std::size_t> group;
  for (const MeasuredDriveSeries& drive : campaign.drives)
    group.push_back(numbers.try_emplace(drive.repeat_of.value_or(drive.id), numbers.size()).first->second);
  return group;
}

std::vector<std::vector<std::size_t>> resampled_indices(std::size_t count, int resamples,
                                                        std::uint64_t seed) {
  std::vector<std::vector<std::size_t>> all;
  for (int b = 0; b < resamples; ++b) {
    const std::uint64_t key = random_key(seed, static_cast<std::uint64_t>(b));
    std::vector<std::size_t> picks;
    for (std::size_t k = 0; k < count; ++k)
      picks.push_back(static_cast<std::size_t>(random_uniform(key, k) * static_cast<double>(count)));
    all.push_back(std::move(picks));
  }
  return all;
}

DriveResampling resample_drives(const DriveCampaign& campaign, int resamples, std::uint64_t seed) {
  DriveResampling drives{repeat_groups(campaign), 0, {}};
  for (const std::size_t group : drives.groups) drives.group_count = std::max(drives.group_count, group + 1);
  drives.resamples = resampled_indices(drives.group_count, resamples, seed);
  return drives;
}

}  // namespace slipway::gap
