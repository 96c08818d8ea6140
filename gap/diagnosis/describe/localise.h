#pragma once

#include <Eigen/Core>
#include <vector>

#include "gap/diagnosis/describe/regimes.h"
#include "gap/diagnosis/model/window_variables.h"
#include "gap/diagnosis/result/result.h"
#include "gap/diagnosis/search/diagnosis_options.h"
#include "gap/diagnosis/search/prepared_campaign.h"

namespace slipway::gap {

std::vector<WindowVariables> window_variables(const PreparedCampaign& prepared,
                                              const DriveCampaign& campaign);

// Every channel and wheel: its gap against its noise. Significance by flipping the signs of whole drives'
// residuals: largest |t| over all channels, wheels and five functions of the circumstances.
std::vector<ChannelGap> channel_gaps(const PreparedCampaign& prepared, const DriveCampaign& campaign,
                                     const Eigen::VectorXd& residuals, const DiagnosisOptions& options);

// The slices that hold more than their share: see regimes_in.
std::vector<Regime> regimes_of(const PreparedCampaign& prepared, const DriveCampaign& campaign,
                               const Eigen::VectorXd& residuals, LookedAt looked_at,
                               const DiagnosisOptions& options, std::size_t most);

// Each channel's share of a trace: see shares_of.
std::vector<ChannelShare> channel_shares(const PreparedCampaign& prepared, const Eigen::VectorXd& residuals);

// Discs on the terrains that hold a gap that the rest has not.
std::vector<GapPlace> gap_places(const PreparedCampaign& prepared, const DriveCampaign& campaign,
                                 const Eigen::VectorXd& residuals, const DiagnosisOptions& options);

}  // namespace slipway::gap
