#include "gap/diagnosis/model/noise_model.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>

#include "core/random.h"

namespace slipway::gap {
namespace {

// Against the density with the whole covariance written out.
TEST(LogMarginal, IsTheDensityUnderTheWholeCovariance) {
  constexpr int kRows = 12, kColumns = 3;
  Eigen::VectorXd r(kRows);
  Eigen::MatrixXd a(kRows, kColumns);
  for (int i = 0; i < kRows; ++i) {
    r[i] = random_normal(1, static_cast<std::uint64_t>(i));
    for (int c = 0; c < kColumns; ++c)
      a(i, c) = random_normal(2 + static_cast<std::uint64_t>(c), static_cast<std::uint64_t>(i));
  }
  const Eigen::MatrixXd v = Eigen::MatrixXd::Identity(kRows, kRows) + a * a.transpose();
  const Eigen::LLT<Eigen::MatrixXd> llt(v);
  const double expected = -0.5 * r.dot(llt.solve(r)) - llt.matrixLLT().diagonal().array().log().sum();
  EXPECT_NEAR(log_marginal(r, a), expected, 1e-10);
}

}  // namespace
}  // namespace slipway::gap
