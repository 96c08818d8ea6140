// Against the density with the whole covariance written out, and its slope against differences.
#include "gap/diagnosis/model/scatter_likelihood.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <cstdint>
#include <vector>

#include "tests/gap/linear_model.h"

namespace slipway::gap {
namespace {

using testing::random_matrix;

constexpr Eigen::Index kResponses = 7, kSystematic = 4;

// Rows of slip, of a share of some current and of a sensor alone, in turn.
Eigen::VectorXd variances(const NoiseScales& s, Eigen::Index rows) {
  Eigen::VectorXd v(rows);
  for (Eigen::Index i = 0; i < rows; ++i) {
    const double left_over = i % 3 == 0 ? s.slip : i % 3 == 1 ? 0.5 * s.current_share : 0.0;
    v[i] = 1e-6 + left_over * left_over;
  }
  return v;
}

std::vector<ScatterLikelihood::Drive> some_drives(int drives, int windows) {
  std::vector<ScatterLikelihood::Drive> made(static_cast<std::size_t>(drives));
  std::uint64_t seed = 1;
  for (ScatterLikelihood::Drive& drive : made) {
    for (int w = 0; w < windows; ++w, seed += 20) {
      const Eigen::Index n = 4 + w % 3;
      Eigen::MatrixXd response = 0.1 * random_matrix(n, kResponses, seed);
      const Eigen::MatrixXd columns = 0.02 * random_matrix(n, 1 + kSystematic, seed + 10);
      drive.windows.push_back({response, columns, [n](const NoiseScales& s) { return variances(s, n); }});
    }
  }
  return made;
}

double dense_likelihood(const std::vector<ScatterLikelihood::Drive>& drives, const NoiseScales& s) {
  const Eigen::Vector3d soil(s.stiffness, s.friction, s.shear_modulus);
  const Eigen::Vector4d map(s.lean_rad, s.lean_rad, s.load_shift_m, s.load_shift_m);
  Eigen::Index rows = 0;
  for (const auto& drive : drives)
    for (const auto& window : drive.windows) rows += window.columns.rows();
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(rows, rows), columns(rows, 1 + kSystematic);
  Eigen::Index row = 0;
  for (const auto& drive : drives) {
    const Eigen::Index first = row;
    Eigen::MatrixXd of_soil(rows, 3);
    for (const auto& window : drive.windows) {
      const Eigen::Index n = window.columns.rows();
      const Eigen::MatrixXd own_soil = window.response.leftCols(3) * soil.asDiagonal();
      const Eigen::MatrixXd own_map = window.response.rightCols(4) * map.asDiagonal();
      of_soil.middleRows(row, n) = own_soil;
      columns.middleRows(row, n) = window.columns;
      covariance.block(row, row, n, n) =
          s.within_drives * s.within_drives * own_soil * own_soil.transpose() + own_map * own_map.transpose();
      covariance.block(row, row, n, n).diagonal() += window.variances(s);
      row += n;
    }
    const auto own = of_soil.middleRows(first, row - first);
    covariance.block(first, first, row - first, row - first) += own * own.transpose();
  }
  const Eigen::MatrixXd a = columns.rightCols(kSystematic);
  const Eigen::LLT<Eigen::MatrixXd> llt(covariance + a * a.transpose());
  return -0.5 * columns.col(0).dot(llt.solve(columns.col(0))) -
         llt.matrixLLT().diagonal().array().log().sum();
}

TEST(ScatterLikelihood, IsTheDensityUnderTheWholeCovariance) {
  for (const int drives : {1, 3, 11}) {
    ScatterLikelihood likelihood(some_drives(drives, 4), 2);
    for (const double times : {1.0, 0.3, 5.0}) {
      NoiseScales scales;
      scales.slip *= times;
      scales.friction *= times;
      scales.load_shift_m *= times;
      const double expected = dense_likelihood(some_drives(drives, 4), scales);
      EXPECT_NEAR(likelihood.at(scales), expected, 1e-9 * std::abs(expected));
    }
  }
}

TEST(ScatterLikelihood, SlopeIsThatOfDifferences) {
  ScatterLikelihood likelihood(some_drives(9, 3));
  NoiseScales scales;
  scales.stiffness = 0.2;
  likelihood.at(scales);
  const ScatterLikelihood::Slope slope = likelihood.slope();
  for (int k = 0; k < kNoiseScales; ++k) {
    const auto at = [&](double step) {
      NoiseScales moved = scales;
      *numbers_of(moved)[static_cast<std::size_t>(k)] *= std::exp(step);
      return likelihood.at(moved);
    };
    EXPECT_NEAR(slope.by_scale[k], (at(1e-4) - at(-1e-4)) / 2e-4, 1e-5 * (1.0 + std::abs(slope.by_scale[k])))
        << kScaleNames[static_cast<std::size_t>(k)];
  }
}

// The average of the expected and the observed information is the same whichever thread sums it, symmetric,
// and nothing that a scale without a row is told by.
TEST(ScatterLikelihood, InformationIsSymmetricAndPositive) {
  ScatterLikelihood likelihood(some_drives(9, 3), 1), in_threads(some_drives(9, 3), 4);
  likelihood.at({});
  in_threads.at({});
  const Eigen::MatrixXd information = likelihood.slope().information;
  EXPECT_EQ(information, in_threads.slope().information);
  EXPECT_LT((information - information.transpose()).norm(), 1e-9 * information.norm());
  const Eigen::MatrixXd shifted =
      information + 1e-9 * information.norm() * Eigen::MatrixXd::Identity(kNoiseScales, kNoiseScales);
  EXPECT_EQ(shifted.llt().info(), Eigen::Success);
  EXPECT_EQ(information(9, 9), 0.0) << "no row is of an attitude";
  EXPECT_GT(information(6, 6), 0.0) << "slip";
}

}  // namespace
}  // namespace slipway::gap
