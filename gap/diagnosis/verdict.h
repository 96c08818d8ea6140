#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "gap/diagnosis/diagnosis.h"
#include "gap/diagnosis/naming.h"
#include "gap/diagnosis/search/explanation_search.h"
#include "gap/diagnosis/search/prepared_campaign.h"

namespace slipway::gap {

// 90 % interval of a fit's parameter.
Interval parameter_interval(const FittedExplanation& fit, std::size_t parameter);

// The share of the screened variants that drives would not surely have shown at VerdictOptions::small_effect
// of their usual size; 1 where none was screened.
double hidden_share(std::span<const ScreenedVariant> screened, const VerdictOptions& options);

// What the chosen candidate and the named effects mean: the verdict, its reason and what would overturn it,
// the effects found, or how small ones could have hidden. d has its `marginals`.
void judge(const DriveCampaign& campaign, const PreparedCampaign& prepared, const ExplanationSearch& search,
           const Naming& naming, const DiagnosisOptions& options, Diagnosis& d);

// The cause from outside that a candidate has, with its parameters; nothing, where it has none.
std::optional<OutsideFinding> outside_finding(const ExplanationSearch& search, std::size_t candidate,
                                              const DriveCampaign& campaign);

// Not certain of effects that predicted harsh drives worse than re-tuned parameters did, by more than chance.
void doubt_what_does_not_extrapolate(const VerdictOptions& options, Diagnosis& d);

// Effects with which drives held out of the fit are told no better than re-tuned (their log density gains
// nothing) are not named, however probable they are on the drives that they were fitted to.
void withdraw_what_tells_no_better(double log_density_gain, Diagnosis& d);

// An answer that leaves far more than the floor on drives held out of the fit, or that needs a parameter at
// the end of what it may be, is none: the cause is unknown, and nothing is named unless it may stand beside
// something unknown (see naming.h); then the answer is a partial one. `reported`: the fit that the answer
// stands for; d has its `gap`.
void doubt_what_leaves_a_gap(const FittedExplanation& reported, const VerdictOptions& options, Diagnosis& d);

}  // namespace slipway::gap
