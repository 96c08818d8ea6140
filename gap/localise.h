#pragma once

#include <Eigen/Core>
#include <vector>

#include "gap/diagnosis.h"
#include "gap/prepared_campaign.h"

namespace slipway::gap {

// What a gap may depend on, of one window.
struct WindowVariables {
  double slope_deg = 0.0;        // along the travel, positive uphill
  double cross_slope_deg = 0.0;  // positive: left side up
  double slip = 0.0;             // measured
  double speed_m_s = 0.0;        // commanded, negative backwards
  double curvature_1_m = 0.0;
  double temperature_c = 0.0;
  double turning = 0.0;
  double time_s = 0.0;  // since the drive began
};
constexpr int kWindowVariables = 8;
const char* variable_name(int variable);
double variable_of(const WindowVariables& of, int variable);
std::vector<WindowVariables> window_variables(const PreparedCampaign& prepared,
                                              const DriveCampaign& campaign);

// Every channel and wheel: its gap against its noise. Significance by flipping the signs of whole drives'
// residuals: largest |t| over all channels, wheels and five functions of the circumstances.
std::vector<ChannelGap> channel_gaps(const PreparedCampaign& prepared, const DriveCampaign& campaign,
                                     const Eigen::VectorXd& residuals, const DiagnosisOptions& options);

// Slices of one and two conditions whose windows hold more of a channel's squared residuals than of the data.
// Significance by permuting drives, largest excess over all slices. Best first, `most` at most, p below 0.1.
std::vector<Regime> regimes_of(const PreparedCampaign& prepared, const DriveCampaign& campaign,
                               const Eigen::VectorXd& residuals, const DiagnosisOptions& options,
                               std::size_t most);

// Discs on the terrains that hold a gap that the rest has not.
std::vector<GapPlace> gap_places(const PreparedCampaign& prepared, const DriveCampaign& campaign,
                                 const Eigen::VectorXd& residuals, const DiagnosisOptions& options);

}  // namespace slipway::gap
