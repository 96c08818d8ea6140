#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "gap/diagnosis/model/drive_resampling.h"
#include "gap/diagnosis/search/explanation_search.h"
#include "gap/diagnosis/search/prepared_campaign.h"

namespace slipway::gap {

// The evidence of a linearised explanation, made of its parts by groups of drives: whitened residuals and
// columns of prior deviation 1.
class GroupedEvidence {
 public:
  GroupedEvidence(const Eigen::VectorXd& residuals, const Eigen::MatrixXd& columns,
                  std::span<const std::size_t> group_of_row, std::size_t group_count);
  // log_marginal of the drives with each group counted so many times.
  double counted(std::span<const int> times) const;

 private:
  std::vector<double> square_;
  std::vector<Eigen::VectorXd> gradient_;
  std::vector<Eigen::MatrixXd> hessian_;
};

// Which candidate would have been the most probable had other drives of the same kinds been made: drives,
// with their repeats, drawn with replacement. Fits are not repeated: a drive that counts twice does so in the
// linearised evidence of each explanation. Candidates below SelectionOptions::min_running have no part.
// Returns, of each candidate, the share of the resamples in which it is the most probable.
std::vector<double> resample_selection(const ExplanationSearch& search, const PreparedCampaign& prepared,
                                       const DriveCampaign& campaign, const DiagnosisOptions& options,
                                       const DriveResampling& drives);

}  // namespace slipway::gap
