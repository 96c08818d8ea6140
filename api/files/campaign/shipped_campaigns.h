#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "api/files/catalogue.h"
#include "gap/diagnosis/model/drive_campaign.h"

namespace slipway::api {

// What the campaign.json of drives that ship says, without a look into the drives' own files.
struct ShippedCampaign {
  std::string name;              // of its folder: by which requests ask for it
  std::filesystem::path folder;  // in one of the data folder's two: gap-practice, drive-campaigns
  std::string rover;
  double gravity_m_s2 = 0.0;
  std::vector<std::string> soils, terrains;
  std::vector<gap::MeasuredDriveSeries> drives;  // without samples; terrains are indices into those above
};

// Of one campaign's folder; the name alone where its campaign.json is at fault.
ShippedCampaign described_campaign(const std::filesystem::path& folder, const std::string& name,
                                   const Catalogue& catalogue);

// Sorted by name. Names alone of those whose campaign.json is at fault: whoever asks for one gets the reason.
std::vector<ShippedCampaign> shipped_campaigns(const std::filesystem::path& data, const Catalogue& catalogue);

}  // namespace slipway::api
