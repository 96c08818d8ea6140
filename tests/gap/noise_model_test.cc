#include "gap/diagnosis/model/noise_model.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/random.h"
#include "gap/diagnosis/model/block_whitening.h"

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

constexpr Eigen::Index kSharedCauses = 3;

Eigen::MatrixXd drawn_matrix(Eigen::Index rows, Eigen::Index columns, std::uint64_t key) {
  Eigen::MatrixXd m(rows, columns);
  for (Eigen::Index i = 0; i < m.size(); ++i) m(i) = random_normal(key, static_cast<std::uint64_t>(i));
  return m;
}

// A drive of windows with 4 to 8 rows each, with the same covariance written out.
struct WindowedDrive {
  BlockWhitening whitening;
  Eigen::MatrixXd dense;
};

WindowedDrive windowed_drive(int windows, bool with_dense) {
  WindowedDrive made;
  std::vector<Eigen::MatrixXd> own, shared;
  Eigen::Index rows = 0;
  for (int w = 0; w < windows; ++w) {
    const auto n = static_cast<Eigen::Index>(4 + w % 5);
    const Eigen::MatrixXd root = drawn_matrix(n, n, 10 + static_cast<std::uint64_t>(w));
    own.push_back(root * root.transpose() + 0.1 * Eigen::MatrixXd::Identity(n, n));
    shared.push_back(drawn_matrix(n, kSharedCauses, 1000 + static_cast<std::uint64_t>(w)));
    made.whitening.add(own.back(), shared.back());
    rows += n;
  }
  if (!with_dense) return made;
  Eigen::MatrixXd u(rows, kSharedCauses);
  made.dense = Eigen::MatrixXd::Zero(rows, rows);
  Eigen::Index row = 0;
  for (std::size_t w = 0; w < own.size(); ++w) {
    made.dense.block(row, row, own[w].rows(), own[w].rows()) = own[w];
    u.middleRows(row, shared[w].rows()) = shared[w];
    row += own[w].rows();
  }
  made.dense += u * u.transpose();
  return made;
}

TEST(BlockWhitening, WhitensByTheWholeCovariance) {
  const WindowedDrive made = windowed_drive(40, true);
  const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(made.dense.rows(), made.dense.rows());
  const Eigen::MatrixXd w = made.whitening.whiten(one);
  EXPECT_LT((w * made.dense * w.transpose() - one).cwiseAbs().maxCoeff(), 1e-9);
  const Eigen::LLT<Eigen::MatrixXd> llt(made.dense);
  EXPECT_NEAR(made.whitening.log_determinant(), 2.0 * llt.matrixLLT().diagonal().array().log().sum(), 1e-8);
}

// With a triangular root a spike of 6 at the first of two readings of correlation 0.9 cost 57.6 by the fits'
// robust loss, and one at the second 47.1: which wheel stands first in a list mattered.
TEST(BlockWhitening, DoesNotDependOnTheOrderOfRowsInABlock) {
  const Eigen::MatrixXd root = drawn_matrix(5, 5, 1), shared = drawn_matrix(5, kSharedCauses, 2),
                        columns = drawn_matrix(10, 2, 3);
  const Eigen::MatrixXd own = root * root.transpose() + 0.1 * Eigen::MatrixXd::Identity(5, 5);
  const std::vector<Eigen::Index> turned{3, 0, 4, 2, 1}, both{3, 0, 4, 2, 1, 8, 5, 9, 7, 6};
  BlockWhitening straight, permuted;
  for (int block = 0; block < 2; ++block) {
    straight.add(own, shared);
    permuted.add(own(turned, turned), shared(turned, Eigen::all));
  }
  const Eigen::MatrixXd expected = straight.whiten(columns);
  const Eigen::MatrixXd found = permuted.whiten(columns(both, Eigen::all));
  EXPECT_LT((found - expected(both, Eigen::all)).cwiseAbs().maxCoeff(), 1e-12);
}

// A dense factor of 16 times as many windows would take 256 times as much.
TEST(BlockWhitening, GrowsWithTheNumberOfWindows) {
  const BlockWhitening small = windowed_drive(50, false).whitening,
                       large = windowed_drive(800, false).whitening;
  EXPECT_EQ(large.rows(), 16 * small.rows());
  EXPECT_LE(large.bytes(), 16 * small.bytes());
}

}  // namespace
}  // namespace slipway::gap
