#pragma once

#include <optional>
#include <vector>

#include "gap/diagnosis/model/drive_campaign.h"
#include "sim/effects/effect.h"

namespace slipway::gap {

// For each wheel: the median, over all rows in which the wheels turn, of its measured rate divided by its
// commanded rate; these medians are then divided by the median over all wheels. 0.85: the wheel turned 15 %
// slower than the others. Nothing where rates were not measured for each wheel.
std::optional<std::vector<double>> measured_rate_shares(const DriveCampaign& campaign);

// A wheel can't have turned slower than it was measured to: of variants that act on one wheel's rate, that
// field's lower bound is raised to the measured share, less an error of it. Without measured rates they stay
// as they are.
void bound_by_measured_rates(const DriveCampaign& campaign, std::vector<sim::EffectVariant>& variants);

}  // namespace slipway::gap
