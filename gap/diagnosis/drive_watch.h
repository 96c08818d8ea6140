#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/progress.h"
#include "core/result.h"
#include "gap/diagnosis/diagnosis.h"
#include "gap/diagnosis/follow/change_detector.h"
#include "gap/diagnosis/follow/followed_drives.h"
#include "gap/diagnosis/model/drive_campaign.h"

namespace slipway::gap {

// Whether drives, in their order, still are what healthy ones taught.
struct WatchOptions {
  ChangeOptions change;
  int learn = static_cast<int>(kDrivesLearntFrom);  // first drives of the campaign that are taken as healthy,
                                                    // where no reference is given
  bool diagnose = true;                             // what has changed, after an alarm
};

// Of the first drives, how many a watch without a reference learns from.
inline constexpr int kFewestLearnt = 3, kMostLearnt = 2000;

struct DriveWatch : FollowedDrives {
  std::string campaign, campaign_fingerprint;
  std::string reference, reference_fingerprint;  // the campaign's own name where its first drives were learnt
  std::size_t learnt_drives = 0;
  std::vector<std::string> notes;      // of the drives, and of what was taken from the reference
  std::optional<Diagnosis> diagnosis;  // of the drives from there on
  // The campaign that was diagnosed, for documents.
  std::optional<DriveCampaign> diagnosed;
};

// `reference`: null for the campaign's own first drives. Errors: invalid_request where the reference is
// another rover's, or no drive is left to watch; cancelled.
Result<DriveWatch> watch_drives(const DriveCampaign& campaign, const DriveCampaign* reference,
                                const WatchOptions& watch, const DiagnosisOptions& options,
                                Progress& progress);

}  // namespace slipway::gap
