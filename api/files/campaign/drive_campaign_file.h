#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "api/files/catalogue.h"
#include "api/json/strict_reader.h"
#include "dem/soil_map.h"
#include "gap/diagnosis/model/drive_campaign.h"

namespace slipway::api::json {

// A terrain as campaign.json names it: files that nobody has opened yet. Pointers are those of the document.
struct CampaignTerrainEntry {
  std::string name;
  std::string pointer;  // "/terrains/hills"
  std::string dem;      // "" where it is not named
  std::string soil;     // of all of it; "" where it has classes
  std::string soil_raster;
  std::vector<dem::SoilClass> classes;
};

// A drive as campaign.json names it, without what its file holds.
struct CampaignDriveEntry {
  gap::MeasuredDriveSeries drive;  // without samples
  std::string pointer;             // "/drives/3"
  std::string file;                // "" where it is not named
};

// What campaign.json of a "drive-campaign/1" says. Where something was at fault, so much as could be read.
struct DriveCampaignFile {
  std::string name;
  double gravity_m_s2 = 0.0;
  std::shared_ptr<const sim::RoverModel> rover;  // nullptr where it could not be read
  std::vector<gap::NominalSoil> soils;
  std::vector<CampaignTerrainEntry> terrains;
  gap::MeasurementStd measurement_std;
  std::map<std::string, double, std::less<>> parameter_std;  // as in gap::DriveCampaign
  std::vector<CampaignDriveEntry> drives;
  std::vector<std::string> notes;  // keys that were passed over, what was taken for granted
  std::vector<Fault> faults;
};

// What a drive of the format says besides its id and its rows: terrain (one of these, by its index in
// `drive`), commanded, repeat_of, final_only. `rover` may be null.
void read_drive_facts(ObjectReader& object, const sim::RoverModel* rover,
                      const std::vector<std::string>& terrains, gap::MeasuredDriveSeries& drive);

// The name of a campaign's document in its folder.
inline constexpr std::string_view kCampaignDocument = "campaign.json";

// Reads keys that the format has not over, and says so in the notes: whoever measured may say more. Faults
// are in the answer, so that those of the files beside it can join them. Errors: malformed_json,
// payload_too_large, with faults that name the document and the place in it.
Result<DriveCampaignFile> read_drive_campaign_file(std::string_view bytes, const Catalogue& catalogue);

}  // namespace slipway::api::json
