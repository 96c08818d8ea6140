#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "api/catalogue.h"
#include "gap/drive_campaign.h"

namespace slipway::api {

// The folder of the data folder that holds the drives that ship.
inline constexpr std::string_view kShippedCampaigns = "gap-practice";

// What the campaign.json of drives that ship says, without a look into the drives' own files.
struct ShippedCampaign {
  std::string name;  // of its folder: by which requests ask for it
  std::string rover;
  double gravity_m_s2 = 0.0;
  std::vector<std::string> soils, terrains;
  std::vector<gap::MeasuredDriveSeries> drives;  // without samples; terrains are indices into those above
};

// Sorted by name. Names alone of those whose campaign.json is at fault: whoever asks for one is told why.
std::vector<ShippedCampaign> shipped_campaigns(const std::filesystem::path& data, const Catalogue& catalogue);

}  // namespace slipway::api
