#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "gap/diagnosis/search/huber_loss.h"
#include "gap/diagnosis/search/prepared_campaign.h"

namespace slipway::gap {

// Rows of observations by the fold of their drive, whether they are compared, and the deviation of their
// noise.
struct FoldedRows {
  std::vector<int> fold;
  std::vector<bool> compared;
  Eigen::VectorXd deviation;
  // Of residuals in deviations, as in the fits: a few windows of a nearly stuck rover would otherwise hold
  // most of the squares, whatever explains the others.
  HuberLoss loss{std::numeric_limits<double>::infinity()};
};

// Measurement less prediction on drives that an explanation has not seen, its derivatives being taken for
// constant: each fold's parameters are solved for from the other folds' rows (whitened, with a prior of
// deviation 1 and held within their bounds), and predictions move along the derivatives. NaN of rows that are
// not compared. `more` has columns behind the fit's own (observations x columns, by prior deviations), and
// `white_more` the same whitened, rows weighed as in the fit; both may be empty. `precision`: of the prior
// where reference drives told of it, see Hypothesis::prior_precision(); `more` then begins with what they
// left open, which is behind the fit's white columns already.
Eigen::VectorXd linear_held_out(const PosteriorMode& fit, std::span<const Parameter> parameters,
                                const Eigen::MatrixXd& more, const Eigen::MatrixXd& white_more,
                                const FoldedRows& rows, int folds, const Eigen::MatrixXd& precision = {});
// Their root mean square in deviations of the noise, with twice the loss in the place of the square.
double linear_held_out_rms(const PosteriorMode& fit, std::span<const Parameter> parameters,
                           const Eigen::MatrixXd& more, const Eigen::MatrixXd& white_more,
                           const FoldedRows& rows, int folds, const Eigen::MatrixXd& precision = {});

// The same of a campaign's explanations. It costs no prediction, so that every explanation can be asked.
class LinearHeldOut {
 public:
  // `groups`: of each drive, see learnt_from_in. What is given must outlive it.
  LinearHeldOut(const PreparedCampaign& prepared, std::span<const std::size_t> groups, int folds,
                const FitOptions& fit);

  // The root mean square, by the loss of the campaign's fits.
  double operator()(const FittedExplanation& fit, const Eigen::MatrixXd& more = {}) const;
  Eigen::VectorXd residuals(const FittedExplanation& fit, const Eigen::MatrixXd& more = {}) const;

 private:
  const PreparedCampaign& prepared_;
  FoldedRows rows_;
  int folds_;
};

}  // namespace slipway::gap
