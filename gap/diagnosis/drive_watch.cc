#include "gap/diagnosis/drive_watch.h"

#include <fmt/format.h>

#include <utility>

#include "gap/diagnosis/follow/since_reference.h"

namespace slipway::gap {
Result<DriveWatch> watch_drives(const DriveCampaign& campaign, const DriveCampaign* reference,
                                const WatchOptions& watch, const DiagnosisOptions& options,
                                Progress& progress) {
  const std::size_t own = reference == nullptr ? static_cast<std::size_t>(watch.learn) : 0;
  const std::size_t all = campaign.drives.size();
  if (own >= all)
    return fail(
        ErrorCode::kInvalidRequest,
        fmt::format("the campaign has {} drives, and the first {} are learnt from: none is left to watch",
                    all, own),
        {{"/learn", fmt::format("must be below {}, the number of drives", all)}});
  const DriveCampaign healthy = reference == nullptr ? drives_between(campaign, 0, own) : *reference;
  const DriveCampaign watched = drives_between(campaign, own, all);
  // Before the work of learning.
  if (const auto checked = check_reference(healthy, watched); !checked) return fail(checked.error());
  const auto learnt = learn_reference(healthy, options, progress);
  if (!learnt) return fail(learnt.error());
  const auto since = since_reference(*learnt, watched, options);
  if (!since) return fail(since.error());

  DriveWatch result;
  result.campaign = campaign.name;
  result.campaign_fingerprint = campaign.fingerprint;
  result.reference = healthy.name;
  result.reference_fingerprint = healthy.fingerprint;
  result.learnt_drives = healthy.drives.size();
  result.notes = since->notes;
  auto followed = follow_drives(*since, watch.change, options, progress);
  if (!followed) return fail(followed.error());
  static_cast<FollowedDrives&>(result) = std::move(*followed);
  if (!result.alarm || !watch.diagnose) return result;
  const std::size_t first = own + result.diagnosed_since;
  const DriveCampaign changed = drives_between(campaign, first, all);
  // Drives before the change are healthy too, where they are of the same campaign.
  const auto asked = reference == nullptr
                         ? since_reference(drives_between(campaign, 0, first), changed, options, progress)
                         : since_reference(*learnt, changed, options);
  if (!asked) return fail(asked.error());
  auto diagnosis = diagnose(*asked, options, progress);
  if (!diagnosis) return fail(diagnosis.error());
  result.diagnosis = std::move(*diagnosis);
  result.diagnosed = changed;
  return result;
}

}  // namespace slipway::gap
