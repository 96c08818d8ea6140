#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

namespace slipway::gap {

// Evidence that something has changed in a sequence of drives, which holds at any time that one looks.
//
// As long as nothing has changed, the whitened residuals of a drive are r = X u + noise with u normal of
// deviation 1, the same for all drives. Since a drive c they may be r = X u + Z_j v + noise with one kind j
// of change, v normal of deviation `size`. With B_cj(t) the ratio of the likelihoods of drives 1..t, u and v
// averaged over,
//
//   M_t = sum_c w_c sum_j pi_j mean over sizes of B_cj(t)^share,    B = 1 for c > t,    sum w_c = sum pi_j =
//   1,
//
// is a martingale that starts at 1 while nothing has changed (below one where share < 1), so that it ever
// reaches 1 / alpha with a probability of alpha at most [Ville 1939; Shafer et al. 2011, Statistical Science
// 26]. w_c falls as 1 / (c log^2 c), the slowest that adds up.
struct ChangeOptions {
  // Drives running, repeats counted once, at which the evidence stands at 1 / alpha before an alarm: one odd
  // drive is no change. (An alarm is then rarer still than alpha.)
  int confirmed_by = 2;
  double alpha = 0.01;  // chance of an alarm while nothing changes, however long one watches
  double share = 0.5;   // of the log likelihood ratios that is believed: drives scatter more than is modelled
  std::vector<double> sizes{0.3, 1.0, 3.0};  // of a change, in what its columns are
  std::size_t kept = 50;                     // latest drives of which each may be the first that differs
  double forgotten = 1e-6;  // part of the evidence below which an older one is no longer followed
};

// A kind of change: columns of Z, and what it is believed by (the priors of all kinds add up to 1).
struct ChangeKind {
  Eigen::Index first = 0, count = 0;
  double prior = 0.0;
};

class ChangeDetector {
 public:
  ChangeDetector(ChangeOptions options, std::vector<ChangeKind> kinds);

  // One more drive, whitened: residuals, what may be re-tuned, and the kinds' columns. Returns log M, which
  // stays 0 where there is no kind of change. A repeat of the drive before it does not confirm that one.
  double add(const Eigen::VectorXd& residuals, const Eigen::MatrixXd& known, const Eigen::MatrixXd& changes,
             bool repeats_last = false);

  bool alarmed() const { return above_ >= options_.confirmed_by; }
  double log_evidence() const { return log_evidence_; }
  // Of M at the last drive: the first drive that differs, from 0, and the kinds' shares, which add up to 1
  // with what has not changed left out.
  std::size_t most_probable_start() const { return start_; }
  const std::vector<double>& kind_shares() const { return kind_shares_; }
  // What each drive so far has of M as the first that differs; they add up to 1 as the kinds' shares do. That
  // of a drive which is no longer followed is 0.
  const std::vector<double>& start_shares() const { return start_shares_; }

 private:
  struct Drive {
    Eigen::MatrixXd crossed, squares;  // X^T Z, Z^T Z
    Eigen::VectorXd product;           // Z^T r
    bool followed = true;
  };
  // log mean over sizes of B^share, of one kind: `information` and `score` with X projected out.
  double log_ratio(const Eigen::MatrixXd& information, const Eigen::VectorXd& score) const;

  ChangeOptions options_;
  std::vector<ChangeKind> kinds_;
  double log_alpha_ = 0.0;
  std::vector<Drive> drives_;
  Eigen::MatrixXd known_squares_;  // 1 + sum X^T X
  Eigen::VectorXd known_product_;  // sum X^T r
  double log_evidence_ = 0.0;
  int above_ = 0;  // drives running, up to the last, at which the evidence stands at 1 / alpha
  std::size_t start_ = 0;
  std::vector<double> kind_shares_, start_shares_;
};

// Drives running, by their numbers, and what they have of the evidence together.
struct DriveRange {
  std::size_t first = 0, last = 0;
  double share = 0.0;
};
// The fewest drives running that hold the one with most and have `part` of all shares at least; where several
// are as few, those with most. All of them where rounding leaves the sum below `part`.
DriveRange fewest_with(std::span<const double> shares, double part);

// w_c of the c-th drive, from 1.
double start_weight(std::size_t c);

}  // namespace slipway::gap
