#pragma once

#include <cstddef>
#include <vector>

#include "core/progress.h"
#include "gap/diagnosis.h"
#include "gap/explanation_search.h"
#include "gap/prepared_campaign.h"

namespace slipway::gap {

// Drives on planes of the campaign's first soil that would tell best which effects are at work, each beside
// those before it, with the bits that it is expected to add. Rivals are the explanations that were fitted
// and, of every other effect, as much as the drives leave open. What differs between two of them counts in
// the scatter of a drive and with what is left open of re-tuned parameters projected out, by the share of the
// evidence that is believed. At most `most`; none where it was cancelled.
std::vector<NextDrive> next_drives(const DriveCampaign& campaign, const PreparedCampaign& prepared,
                                   const ExplanationSearch& search, std::size_t most, std::size_t threads,
                                   const Progress& progress);

}  // namespace slipway::gap
