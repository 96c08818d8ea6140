#pragma once

#include <span>
#include <vector>

#include "core/progress.h"
#include "gap/diagnosis/result/result.h"
#include "gap/diagnosis/search/explanation.h"

namespace slipway::gap {

// Drives on planes of the campaign's first soil that would tell the explanations apart best, by the bits of
// information that one of them is expected to give about which is true.
std::vector<NextDrive> next_drives(const DriveCampaign& campaign, const NoiseScales& scatter,
                                   std::span<const FittedExplanation* const> explanations,
                                   std::span<const double> probabilities, std::size_t most,
                                   const Progress& progress);

}  // namespace slipway::gap
