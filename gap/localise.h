#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "gap/diagnosis.h"
#include "gap/prepared_campaign.h"
#include "gap/window_variables.h"

namespace slipway::gap {

std::vector<WindowVariables> window_variables(const PreparedCampaign& prepared,
                                              const DriveCampaign& campaign);

// Every channel and wheel: its gap against its noise. Significance by flipping the signs of whole drives'
// residuals: largest |t| over all channels, wheels and five functions of the circumstances.
std::vector<ChannelGap> channel_gaps(const PreparedCampaign& prepared, const DriveCampaign& campaign,
                                     const Eigen::VectorXd& residuals, const DiagnosisOptions& options);

// Slices of one and two conditions whose windows hold more of a channel's squared residuals than of the data.
// Significance by permuting drives, largest excess over all slices. Best first, `most` at most, p below 0.1.
// Channels whose residuals are within their noise have none. Of a trace, which has no noise, `shares` are
// given: slices of a channel in which little happens come later, and a channel that has a tenth of it is not
// left out for being small.
std::vector<Regime> regimes_of(const PreparedCampaign& prepared, const DriveCampaign& campaign,
                               const Eigen::VectorXd& residuals, const DiagnosisOptions& options,
                               std::size_t most, std::span<const ChannelShare> shares = {});

// Each channel's share of the squared residuals in deviations, a window's being the mean over its wheels, the
// largest first; none where there are none.
std::vector<ChannelShare> channel_shares(const PreparedCampaign& prepared, const Eigen::VectorXd& residuals);

// Discs on the terrains that hold a gap that the rest has not.
std::vector<GapPlace> gap_places(const PreparedCampaign& prepared, const DriveCampaign& campaign,
                                 const Eigen::VectorXd& residuals, const DiagnosisOptions& options);

}  // namespace slipway::gap
