#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>
#include <vector>

#include "core/progress.h"
#include "core/result.h"
#include "gap/diagnosis/model/reference_belief.h"
#include "gap/diagnosis/search/prepared_campaign.h"

namespace slipway::gap {

// What healthy drives teach: parameters and difference together, as one normal belief. The difference between
// model and drives is a sum of the columns of difference_columns.h, whose coefficients b are believed to be 0
// with a deviation a group (three of each channel), of ReferenceOptions::sizes. Beside the null's columns A
// in prior deviations and B those of the coefficients, both whitened, the belief of (u, b) given the drives
// is normal with precision [A B]^T [A B] + 1.
struct LearntReference {
  PreparedCampaign prepared;       // of the reference drives; refers to the campaign that was learnt from
  std::vector<std::string> names;  // of its nuisances; a soil's has the soil's name behind
  Eigen::VectorXd mean;            // x
  Eigen::VectorXd coefficients;
  Eigen::MatrixXd covariance;  // of (u, b)
  Eigen::VectorXd left_over;   // of every observation: what neither parameters nor difference explain
  SmoothScale scale;
  SmoothRange range;
};

// The campaign must outlive what is learnt. Errors: invalid_request at /reference where no drive has a window
// of use; cancelled.
Result<LearntReference> learn_reference(const DriveCampaign& reference, const DiagnosisOptions& options,
                                        Progress& progress);

// The belief for a campaign that asks what has changed since. Soils are matched by name; one that the
// reference did not have is believed as if nothing had been told.
std::shared_ptr<const ReferenceBelief> belief_for(const LearntReference& learnt,
                                                  const DriveCampaign& campaign,
                                                  const ReferenceOptions& options);

// Deviations of the coefficients of each group of columns, as whitened residuals tell of them beside known
// columns of prior deviation 1: the root mean square of `sizes` and 0, each weighed by its probability beside
// the other groups' most probable ones (found by raising and lowering them in turn). Where the drives could
// not have shown a difference, the larger sizes are left in, so that what lies beyond them is open.
std::vector<double> believed_sizes(const Eigen::VectorXd& residuals, const Eigen::MatrixXd& known,
                                   const Eigen::MatrixXd& columns, std::span<const std::size_t> groups,
                                   std::span<const double> sizes);

}  // namespace slipway::gap
