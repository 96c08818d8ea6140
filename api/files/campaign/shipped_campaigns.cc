#include "api/files/campaign/shipped_campaigns.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <system_error>
#include <utility>

#include "api/files/campaign/drive_campaign_file.h"

namespace slipway::api {

ShippedCampaign described_campaign(const std::filesystem::path& folder, const std::string& name,
                                   const Catalogue& catalogue) {
  ShippedCampaign campaign;
  campaign.name = name;
  campaign.folder = folder;
  std::ifstream in(folder / "campaign.json", std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  auto file = json::read_drive_campaign_file(bytes, catalogue);
  if (!file || !file->faults.empty() || !file->rover) return campaign;
  campaign.rover = file->rover->name;
  campaign.gravity_m_s2 = file->gravity_m_s2;
  for (const gap::NominalSoil& soil : file->soils) campaign.soils.push_back(soil.name);
  for (const json::CampaignTerrainEntry& terrain : file->terrains) campaign.terrains.push_back(terrain.name);
  for (json::CampaignDriveEntry& entry : file->drives) campaign.drives.push_back(std::move(entry.drive));
  return campaign;
}

std::vector<ShippedCampaign> shipped_campaigns(const std::filesystem::path& data,
                                               const Catalogue& catalogue) {
  std::vector<ShippedCampaign> campaigns;
  std::error_code error;
  for (const char* const folder : {"gap-practice", "drive-campaigns"})
    for (const auto& entry : std::filesystem::directory_iterator(data / folder, error))
      if (std::filesystem::is_regular_file(entry.path() / "campaign.json", error))
        campaigns.push_back(described_campaign(entry.path(), entry.path().filename().string(), catalogue));
  std::sort(campaigns.begin(), campaigns.end(),
            [](const ShippedCampaign& a, const ShippedCampaign& b) { return a.name < b.name; });
  return campaigns;
}

}  // namespace slipway::api
