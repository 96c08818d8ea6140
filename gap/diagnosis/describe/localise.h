#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <span>
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
                               const DiagnosisOptions& options);

// Each channel's share of a trace: see shares_of.
std::vector<ChannelShare> channel_shares(const PreparedCampaign& prepared, const Eigen::VectorXd& residuals,
                                         const DiagnosisOptions& options);

// Discs on the terrains that hold a gap that the rest has not.
std::vector<GapPlace> gap_places(const PreparedCampaign& prepared, const DriveCampaign& campaign,
                                 const Eigen::VectorXd& residuals, const DiagnosisOptions& options);

// The parts of these that need no prediction.

// Residuals in deviations times functions of the circumstances, and times what was predicted, by which a
// wrong scale or sign shows whose mean is none; summed over each drive's windows.
constexpr int kBiasFunctions = 6;
using DriveSums = std::map<std::size_t, std::array<double, kBiasFunctions>>;  // by drive
// The largest |t| over the functions, each drive's sums being one draw around 0: |sum| / sqrt(sum of
// squares), with the signs of whole drives as `flipped` says.
double largest_t(const DriveSums& drives, const std::function<double(std::size_t drive)>& sign);
// p of each group of drives' sums, against the largest |t| over all groups when whole drives' signs are drawn
// at random [a wild bootstrap of clusters: Cameron, Gelbach & Miller 2008, Review of Economics and Statistics
// 90]. Nothing where it was cancelled.
std::vector<double> sign_flip_significance(std::span<const DriveSums> groups, int resamples,
                                           std::uint64_t seed, const std::function<bool()>& cancelled);

// Where a window of a place search lies.
struct PlacedWindow {
  std::size_t terrain = 0, drive = 0;
  double x_m = 0.0, y_m = 0.0;  // its middle
  bool used = true;             // as a disc's centre
};
// Discs around windows that hold more of a channel's squares than as many windows drawn at random do, by
// permuting drives, all channels looked at together; by channel, in the order of the windows.
struct FoundPlace {
  std::size_t terrain = 0;
  double x_m = 0.0, y_m = 0.0, radius_m = 0.0, share = 0.0, excess = 0.0;
  Channel channel = Channel::kSlip;
};
std::vector<FoundPlace> places_in(std::span<const PlacedWindow> windows,
                                  std::span<const ChannelSquares> channels, const DiagnosisOptions& options,
                                  const std::function<bool()>& cancelled);

}  // namespace slipway::gap
