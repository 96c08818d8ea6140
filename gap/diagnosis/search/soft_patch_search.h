#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "gap/diagnosis/search/explanation.h"

namespace slipway::gap {

// Places where an effect with a region, such as weaker soil, could be at work: discs around measured
// stations, those first that would raise the evidence of the fit most, none overlapping a better one by more
// than half.
struct PatchSearch {
  std::vector<EffectVariant> variants;
  std::size_t looks = 0;  // how many discs that are much different were looked at
};

// `effect` must have variant_at.
PatchSearch search_soft_patches(const sim::Effect& effect, const DriveCampaign& campaign,
                                const WindowModel& model, const NoiseModel& noise,
                                const FittedExplanation& fit, const SoftPatchOptions& options);

// Which of a fit's effects is at work at a place.
std::optional<std::size_t> placed_effect(const FittedExplanation& fit);

// The patch of a fitted explanation moved and resized while that raises its evidence.
FittedExplanation refine_soft_patch(const DriveCampaign& campaign, const WindowModel& model,
                                    const NoiseModel& noise, FittedExplanation fit, const FitOptions& options,
                                    const SoftPatchOptions& patch_options, std::size_t threads);

// The best discs, none overlapping a better one by more than half of their radii's sum; `most` at most.
struct ScoredDisc {
  sim::Disc disc;
  double gain = 0.0;
};
std::vector<sim::Disc> best_apart(std::vector<ScoredDisc> discs, std::size_t most);

}  // namespace slipway::gap
