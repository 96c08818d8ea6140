#pragma once

#include <vector>

#include "gap/diagnosis/held_out/linear_held_out.h"
#include "gap/diagnosis/model/drive_resampling.h"
#include "gap/diagnosis/result/result.h"
#include "gap/diagnosis/search/prepared_campaign.h"

namespace slipway::gap {

// The ladder's last rung above the floor, into `channels`: the error on held-out drives of an explanation
// with the discrepancy term beside it, of the most probable of its sizes, from imprecision to something else.
// What nobody has named is thereby described as far as it repeats from drive to drive. Both are learnt from
// the other folds, linearly (see linear_held_out). Intervals are over resamples of drives.
void add_discrepancy_rung(const PreparedCampaign& prepared, const LinearHeldOut& held_out,
                          const FittedExplanation& fit, const DriveResampling& drives,
                          const DiscrepancyOptions& options, std::vector<ChannelClosure>& channels);

}  // namespace slipway::gap
