#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "gap/diagnosis/result/result.h"
#include "gap/diagnosis/search/explanation_search.h"
#include "gap/diagnosis/search/prepared_campaign.h"

namespace slipway::gap {

// 90 % interval of a fit's parameter, cut at the ends of what it may be.
Interval parameter_interval(const FittedExplanation& fit, std::size_t parameter);

// Of a fit's effects of the library those that are named, with their parameters and their probabilities among
// the marginals.
std::vector<FoundEffect> found_effects(const FittedExplanation& fit, std::span<const std::string> names,
                                       std::span<const EffectMarginal> marginals);

// The cause from outside that a fit has, with its parameters; nothing, where it has none. Probability and
// share are left to the caller.
std::optional<OutsideFinding> outside_finding(const FittedExplanation& fit, const DriveCampaign& campaign);

// The least size of each effect that these drives would surely have shown, of its first variant's first
// field.
std::vector<LeastDetectable> least_detectable_of(std::span<const ScreenedVariant> screened,
                                                 const DescriptionOptions& options);

// The share of the screened variants that drives would not surely have shown at half their usual size; 1
// where none was screened.
double hidden_share(std::span<const ScreenedVariant> screened, const DescriptionOptions& options);

// How much more probable the drives are when soils and motors may differ from the nominal ones, closures
// being free in either case: a difference of log evidences.
double gain_of_parameters(const PreparedCampaign& prepared, const DriveCampaign& campaign,
                          const DiagnosisOptions& options);

}  // namespace slipway::gap
