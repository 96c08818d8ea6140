#pragma once

#include <cstddef>
#include <filesystem>
#include <stdexcept>
#include <utility>
#include <vector>

#include "api/files/campaign/drive_campaign_source.h"

namespace slipway::gap {

// Every so many drives of the practice campaign p05.
inline DriveCampaign some_drives(std::size_t every) {
  auto campaign = api::load_drive_campaign(std::filesystem::path(SLIPWAY_DATA_FOLDER) / "gap-practice/p05",
                                           api::Catalogue{});
  if (!campaign) throw std::runtime_error(campaign.error().detail);
  std::vector<MeasuredDriveSeries> kept;
  for (std::size_t d = 0; d < campaign->drives.size(); d += every) kept.push_back(campaign->drives[d]);
  campaign->drives = std::move(kept);
  return std::move(*campaign);
}

}  // namespace slipway::gap
