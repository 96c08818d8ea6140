#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "gap/diagnosis/result/result.h"
#include "gap/diagnosis/search/prepared_campaign.h"

namespace slipway::gap {

// What remains beside a fit, by where it enters and what it depends on, the largest shares first; before
// them the cause from outside that is in the fit, if there is one. Every place of entry is there once with
// what it depends on: what else enters where that cause does counts to its share.
std::vector<ResidualShape> describe_unexplained(const PreparedCampaign& prepared,
                                                const FittedExplanation& fit,
                                                const std::optional<OutsideFinding>& outside,
                                                const DiagnosisOptions& options);

// A column's effect at the lowest (-1), middle (0) and highest (1) value of its circumstance, of its
// coefficient's mean and standard error: being linear, three points say its shape. 90 % intervals.
std::vector<std::pair<double, Interval>> shape_of(Circumstance circumstance, double mean, double error);

}  // namespace slipway::gap
