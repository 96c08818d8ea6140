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
                                   std::span<const double> probabilities, const NextDriveOptions& options,
                                   const Progress& progress);

// What an explanation expects of one channel, and the standard error with which one drive would measure it:
// an error may be a share of the value, so that each explanation has its own.
struct ExpectedReading {
  double value = 0.0, error = 1.0;
};

// What an outcome is expected to say of which of the explanations is true, each an independent normal in
// every channel: a lower bound, never more than their entropy, nothing where none of them is [Kolchinsky &
// Tracey 2017, Entropy 19, section 3, by Bhattacharyya distances]. `probabilities` may add up to less than 1:
// what is missing is an explanation of which nothing is known.
double information_bits(std::span<const std::vector<ExpectedReading>> outcomes,
                        std::span<const double> probabilities);

// The drives of most information, neighbours that say as much left out.
std::vector<NextDrive> one_of_a_kind(std::vector<NextDrive> drives, const NextDriveOptions& options);

}  // namespace slipway::gap
