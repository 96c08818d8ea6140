#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <span>

#include "gap/diagnosis/model/hypothesis.h"

namespace slipway::gap {

// A linear fit of whitened residuals by columns of prior deviation 1, and what more columns would bring
// beside these. The known columns' products are taken once; each question then costs the products of its own
// columns with them alone.
class KnownColumns {
 public:
  // `columns` must outlive it.
  KnownColumns(const Eigen::VectorXd& residuals, const Eigen::MatrixXd& columns);

  // The normal equations of more columns of prior deviation 1 with the known ones eliminated: Schur's
  // complement S of their squares, and the products g, so that S^-1 g is their part of the joint estimate and
  // log_marginal rises by g^T S^-1 g / 2 - log |S| / 2.
  struct Equations {
    Eigen::MatrixXd squares;
    Eigen::VectorXd products;
  };
  Equations beside(const Eigen::MatrixXd& more) const;

 private:
  const Eigen::MatrixXd& columns_;
  Eigen::LLT<Eigen::MatrixXd> factor_;
  Eigen::VectorXd left_;  // the residuals less what the known columns explain
};

// An orthonormal basis of what columns span. A column of zeros, or one that others make up, adds nothing.
Eigen::MatrixXd spanned_by(const Eigen::MatrixXd& columns);

// By how much log_marginal rises with columns whose equations these are.
double gain_of(const KnownColumns::Equations& equations);

// What columns of prior deviation 1 each would add to the logarithm of the evidence beside the known ones,
// all being linear: log_marginal with them less without, and log 2 of each parameter whose prior lies on one
// side of its neutral value. Those whose estimate lies on the other side are left out, their estimate being
// 0; estimates are held within the bounds.
struct LinearGain {
  double gain = 0.0;
  Eigen::VectorXd estimate;  // in prior deviations
};
LinearGain linear_gain(const KnownColumns& known, const Eigen::MatrixXd& columns,
                       std::span<const Parameter> parameters);

}  // namespace slipway::gap
