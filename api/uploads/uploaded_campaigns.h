#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "api/files/campaign/shipped_campaigns.h"
#include "api/files/catalogue.h"
#include "api/json/json_value.h"
#include "api/uploads/upload_folder.h"
#include "core/progress.h"
#include "core/result.h"
#include "gap/diagnosis/model/drive_campaign.h"

namespace slipway::api {

// A drive campaign that is to be made: of an archive, or of another one with further drives.
struct CampaignOrder {
  std::string upload;   // the archive's id; or
  std::string follows;  // a campaign's name, and
  std::optional<json::JsonValue>
      drives;        // drives of "drive-campaign/1" with their rows as "csv" in the place of "file"
  Asker asker = {};  // whose it is then; the same files that somebody else sent before stay theirs
};

struct CampaignTaken {
  ShippedCampaign campaign;
  UploadOrigin origin;
  std::vector<std::string> notes;  // of what was passed over or taken for granted
};

// Makes a campaign of the uploads. It never changes afterwards: its name is "dc-" and a hash of its files, so
// that the same files have the same name, and drives that are appended make another one. The archive is
// unpacked and every file of it read in a child process with limits and without network (see run_confined()).
// Errors: invalid_request with all faults of all files at /upload or /drives; unreadable_data with those of
// the campaign, their pointers begin with the file; not_found, damaged_store, storage, storage_full,
// cancelled.
Result<CampaignTaken> take_campaign(UploadFolder& uploads, const CampaignOrder& order,
                                    const Catalogue& catalogue, Progress& progress);

// The folder of an uploaded campaign; nothing where there is none.
std::optional<std::filesystem::path> uploaded_campaign(const UploadFolder& uploads, std::string_view name);
// Errors: not_found, damaged_store where a file is not what was taken, and those of load_drive_campaign.
Result<gap::DriveCampaign> load_uploaded_campaign(const UploadFolder& uploads, const std::string& name,
                                                  const Catalogue& catalogue);

struct UploadedCampaign {
  ShippedCampaign campaign;
  UploadOrigin origin;
};
// Sorted by name.
std::vector<UploadedCampaign> uploaded_campaigns(const UploadFolder& uploads, const Catalogue& catalogue);

}  // namespace slipway::api
