#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "gap/diagnosis/search/prepared_campaign.h"

namespace slipway::gap {

// Residuals of all observations by what was learnt from those that were `seen`, to which `retuned` was
// fitted.
using Correction =
    std::function<Eigen::VectorXd(const FittedExplanation& retuned, const std::vector<bool>& seen)>;
// `explanation` fitted again to what was seen; all three must outlive it.
Correction refitted(const PreparedCampaign& prepared, const FittedExplanation& explanation,
                    const DiagnosisOptions& options);
// Nothing but what was re-tuned.
Correction uncorrected();

// The re-tuned null, learnt from what was seen.
FittedExplanation retuned_on(const PreparedCampaign& prepared, const std::vector<bool>& seen,
                             const DiagnosisOptions& options);

// Rows of the windows of these drives.
std::vector<bool> rows_of(const WindowModel& model, const std::vector<bool>& drives);

// Sums over observations of drives held out of a fit: of squares, and of squares in deviations of their
// noise.
struct HeldOutErrors {
  // By channel.
  std::vector<double> nominal = zeros(), retuned = zeros(), with = zeros(), floor = zeros(), count = zeros();
  double scaled_nominal = 0.0, scaled_retuned = 0.0, scaled_with = 0.0, scaled_count = 0.0;
  double log_gain = 0.0;  // of the logarithm of the density, of the correction over the re-tuned null

  void add(const HeldOutErrors& e);

 private:
  static std::vector<double> zeros() { return std::vector<double>(channel_count(), 0.0); }
};

// What a window that was held out adds; nothing where it has no observation to compare.
class HeldOutComparison {
 public:
  // Residuals of all observations by either. Log densities are those of the whitened residuals under the
  // fits' loss. `prepared` must outlive it.
  HeldOutComparison(const PreparedCampaign& prepared, const Eigen::VectorXd& retuned,
                    const Eigen::VectorXd& corrected, const FitOptions& options);

  // Whether an observation has numbers to compare. Of a slip beyond the censoring there are none.
  bool compares(std::size_t window, std::size_t observation) const;
  HeldOutErrors errors(std::size_t window) const;
  double retuned(std::size_t row) const { return retuned_[static_cast<Eigen::Index>(row)]; }
  double corrected(std::size_t row) const { return corrected_[static_cast<Eigen::Index>(row)]; }

 private:
  const PreparedCampaign& prepared_;
  HuberLoss loss_;
  Eigen::VectorXd retuned_, corrected_, white_retuned_, white_corrected_;
};

}  // namespace slipway::gap
