#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gap/diagnosis/diagnosis.h"
#include "gap/diagnosis/naming.h"
#include "gap/diagnosis/search/explanation_search.h"
#include "gap/diagnosis/search/prepared_campaign.h"

namespace slipway::gap {

// 90 % interval of a fit's parameter, cut at the ends of what it may be.
Interval parameter_interval(const FittedExplanation& fit, std::size_t parameter);

// How much more probable the drives are when soils and motors may differ from the nominal ones, closures
// being free in either case: a difference of log evidences.
double gain_of_parameters(const PreparedCampaign& prepared, const DriveCampaign& campaign,
                          const DiagnosisOptions& options);

// The share of the screened variants that drives would not surely have shown at VerdictOptions::small_effect
// of their usual size; 1 where none was screened.
double hidden_share(std::span<const ScreenedVariant> screened, const VerdictOptions& options);

// What the chosen candidate and the named effects mean: the verdict, its reason and what would overturn it,
// the effects found, or how small ones could have hidden. d has its `marginals`.
void judge(const DriveCampaign& campaign, const ExplanationSearch& search,
           const Naming& naming, const DiagnosisOptions& options, Diagnosis& d);

// Effects are not surely found, and not named, where more than VerdictOptions::max_nothing_share of the
// resampled campaigns show nothing missing; a partial answer stays. d's candidates have their chosen_share.
void judge_resamples(const ExplanationSearch& search, const VerdictOptions& options, Diagnosis& d);

// The cause from outside that a candidate has, with its parameters; nothing, where it has none.
std::optional<OutsideFinding> outside_finding(const ExplanationSearch& search, std::size_t candidate,
                                              const DriveCampaign& campaign);

// The library's effects of a fit, with their parameters and their probabilities among the marginals.
std::vector<FoundEffect> found_effects(const FittedExplanation& fit,
                                       std::span<const EffectMarginal> marginals);

// "dragging_wheel (probability 0.999) closes 93 % of the gap", of each effect; d has its `marginals`.
std::string closing_words(const Diagnosis& d, std::span<const std::string> effects);

// What overturns an answer with something unknown.
constexpr std::string_view kSameLook =
    "an effect of the library with another equation than the library's would look the same";

}  // namespace slipway::gap
