#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "core/progress.h"
#include "core/result.h"
#include "gap/diagnosis/model/block_whitening.h"
#include "gap/diagnosis/model/noise_scales.h"
#include "gap/diagnosis/model/window_model.h"

namespace slipway::gap {

class ScatterLikelihood;

struct NoiseOptions {
  NoiseScales initial;     // what the scales are believed to be before the drives
  double prior_std = 1.2;  // of the logarithms of the scales around them: a factor of 3 is no surprise
  double censored_slip_std = 0.3;  // a slip beyond the censoring says little but that it is there
};

// The covariance of all residuals: blocks of one drive each (drives are independent),
//
//   V_d = diag(sensor^2 + left over^2) + G_d S G_d^T + sum over windows (w^2 G_w S G_w^T + H_w T H_w^T)
//
// with G the derivatives by the soil's three logarithms, H those by pitch and roll of the weight and by the
// centre of mass forward and to the left, S and T the diagonals of their variances.
class NoiseModel {
 public:
  // response: observations x 7, derivatives by those seven; expected: the model's own values there.
  // Observations that are not `used` have no part.
  NoiseModel(const WindowModel& model, Eigen::MatrixXd response, std::vector<double> expected,
             std::vector<bool> used, const NoiseOptions& options = {});

  // Takes the derivatives by the soil's three logarithms (observations x 3) and the values of another fit:
  // what a soil's scatter does to a rover whose wheel drags, or on another soil, is not what it does to the
  // nominal rover. Rows of zeros, which the fit does not answer, keep what the model was made with, as do the
  // other four derivatives. Counts from the next set() on.
  void respond(const Eigen::MatrixXd& to_soil, std::span<const double> expected);
  void set(const NoiseScales& scales, std::size_t threads = 1);
  const NoiseScales& scales() const { return scales_; }
  // Finds the scales that make the residuals most likely, everything that `systematic` columns (prior
  // deviation 1 each) could explain taken out: what is left is the drives' own scatter. Weak priors around
  // the scales above.
  void estimate(const Eigen::VectorXd& residuals, const Eigen::MatrixXd& systematic, std::size_t threads = 1);

  // W r with W V W^T = 1, see block_whitening.h. Rows not used are 0.
  Eigen::MatrixXd whiten(const Eigen::MatrixXd& columns) const;
  // What the scales were believed to be before the drives, and how probable that makes those of now.
  const NoiseScales& believed() const { return options_.initial; }
  // How far each scale's logarithm lies above what was believed of it, in its prior's deviations. The scatter
  // within drives is relative to that between them and has none of its own.
  Eigen::VectorXd deviations_above_belief() const;
  // What has to be added to log N(r; 0, V) without its determinant to compare residuals under other scales.
  double log_normalisation() const { return log_prior(scales_) - 0.5 * log_determinant_; }
  double log_determinant() const { return log_determinant_; }
  // What W takes: it grows with the drives' lengths and not with their squares, since the windows of a drive
  // share three numbers only.
  std::size_t whitening_bytes() const;
  // Square root of V's diagonal; 0 where not used.
  const Eigen::VectorXd& deviation() const { return deviation_; }
  const std::vector<bool>& used() const { return used_; }
  std::size_t used_count() const;
  bool cancelled() const { return model_.cancelled(); }

 private:
  struct WindowRows {
    std::size_t window = 0;
    std::vector<Eigen::Index> rows;
  };
  struct Block {
    std::size_t drive = 0;
    std::vector<WindowRows> windows;  // in their order
    BlockWhitening whitening;
  };
  static std::vector<Eigen::Index> rows_of(const Block& block);
  // Of all blocks, for these residuals and systematic columns.
  ScatterLikelihood likelihood_of(const Eigen::VectorXd& residuals, const Eigen::MatrixXd& systematic,
                                  std::size_t threads) const;
  void make_whitening(Block& block);  // by the scales
  double log_prior(const NoiseScales& scales) const;
  // Of sensors and of what is left over.
  Eigen::VectorXd variances_of(const WindowRows& part, const NoiseScales& scales) const;

  const WindowModel& model_;
  Eigen::MatrixXd response_;
  std::vector<double> expected_;
  Eigen::MatrixXd made_with_to_soil_;  // the first three columns, and the values, before any respond()
  std::vector<double> made_with_expected_;
  std::vector<bool> used_;
  std::vector<Block> blocks_;
  NoiseOptions options_;
  NoiseScales scales_;
  double log_determinant_ = 0.0;
  Eigen::VectorXd deviation_;
};

// log N(r; 0, V + A A^T) for whitened residuals r and whitened columns A of prior deviation 1, without the
// constant n/2 log(2 pi) and without 1/2 log |V|.
double log_marginal(const Eigen::VectorXd& residuals, const Eigen::MatrixXd& columns);
// The same of r^T r, A^T r and the lower half of A^T A.
double log_marginal(double residual_square, const Eigen::VectorXd& products, Eigen::MatrixXd squares);

}  // namespace slipway::gap
