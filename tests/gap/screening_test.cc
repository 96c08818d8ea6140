#include <gtest/gtest.h>

#include <cmath>

#include "gap/diagnosis/search/linear_gain.h"
#include "gap/diagnosis/search/soft_patch_search.h"
#include "tests/gap/linear_model.h"

namespace slipway::gap {
namespace {

using testing::parameter;
using testing::random_matrix;

// A parameter that no drive shows, whose column is 0, once took what the first reading said for its own.
TEST(SpannedBy, HasNothingOfZerosAndOfWhatOthersMakeUp) {
  Eigen::MatrixXd columns(6, 3);
  columns << Eigen::VectorXd::Ones(6), Eigen::VectorXd::Zero(6), 2.0 * Eigen::VectorXd::Ones(6);
  const Eigen::MatrixXd basis = spanned_by(columns);
  ASSERT_EQ(basis.cols(), 1);
  EXPECT_LT((basis * basis.transpose() - Eigen::MatrixXd::Constant(6, 6, 1.0 / 6.0)).norm(), 1e-12);
  EXPECT_EQ(spanned_by(Eigen::MatrixXd::Zero(6, 2)).cols(), 0);
}

// Of one column a beside nothing: estimate a.r / (1 + a.a), gain (a.r)^2 / 2 (1 + a.a) - log(1 + a.a) / 2.
TEST(LinearGain, OfOneColumnHasAClosedForm) {
  const Eigen::Vector3d r(3.0, -1.0, 2.0), a(1.0, 0.0, 2.0);
  const Eigen::MatrixXd none(3, 0);
  const LinearGain found = linear_gain(KnownColumns(r, none), a, std::vector<Parameter>{parameter(0.1)});
  EXPECT_NEAR(found.estimate[0], 7.0 / 6.0, 1e-14);
  EXPECT_NEAR(found.gain, 49.0 / 12.0 - 0.5 * std::log(6.0), 1e-13);
}

// What known columns explain is not gained twice: the column projected on them is worth next to nothing.
TEST(LinearGain, BesideAColumnThatExplainsTheSameIsALoss) {
  const Eigen::MatrixXd a = 50.0 * random_matrix(10, 1, 3), none(10, 0);
  const Eigen::VectorXd r = 0.7 * a;
  const std::vector<Parameter> free{parameter(1.0)};
  EXPECT_GT(linear_gain(KnownColumns(r, none), a, free).gain, 1000.0);
  EXPECT_LT(linear_gain(KnownColumns(r, a), a, free).gain, 0.0);
}

TEST(LinearGain, LeavesOutWhatWouldHaveTheWrongSignAndStaysWithinBounds) {
  const Eigen::Vector2d r(-3.0, 4.0), negative(-1.0, -1.0);
  const Eigen::MatrixXd none(2, 0);
  const Eigen::Matrix2d columns = Eigen::Matrix2d::Identity();
  const std::vector<Parameter> positive{parameter(1.0, 0.0, 9.0), parameter(0.5, 0.0, 0.6)};
  const LinearGain found = linear_gain(KnownColumns(r, none), columns, positive);
  EXPECT_EQ(found.estimate[0], 0.0) << "it would be -1.5";
  EXPECT_DOUBLE_EQ(found.estimate[1], 1.2) << "2 prior deviations, of which 0.6 / 0.5 are allowed";
  EXPECT_NEAR(found.gain, 16.0 / 4.0 - 0.5 * std::log(2.0) + std::log(2.0), 1e-13)
      << "its prior lies on one side";
  const LinearGain nothing = linear_gain(KnownColumns(negative, none), columns, positive);
  EXPECT_EQ(nothing.gain, 0.0);
  EXPECT_TRUE(nothing.estimate.isZero());
}

// The gain of more columns is the difference of two log marginals, and their estimate is theirs of the joint
// one. The rows that they leave out need not be looked at.
TEST(KnownColumns, BesideThemOthersHaveTheGainOfTheLogMarginal) {
  const Eigen::MatrixXd known = random_matrix(15, 4, 7);
  const Eigen::VectorXd r = 2.0 * random_matrix(15, 1, 100);
  const KnownColumns fitted(r, known);
  for (std::uint64_t seed = 200; seed < 220; ++seed) {
    Eigen::MatrixXd more = random_matrix(15, 2, seed);
    if (seed % 2 == 0) more.topRows(3).setZero();
    if (seed % 3 == 0) more.bottomRows(5).setZero();
    Eigen::MatrixXd all(15, 6);
    all << known, more;
    const KnownColumns::Equations equations = fitted.beside(more);
    EXPECT_NEAR(gain_of(equations), log_marginal(r, all) - log_marginal(r, known), 1e-10) << seed;
    Eigen::MatrixXd squares = all.transpose() * all;
    squares.diagonal().array() += 1.0;
    const Eigen::VectorXd joint = squares.llt().solve(all.transpose() * r).tail(2);
    EXPECT_LT((equations.squares.llt().solve(equations.products) - joint).norm(), 1e-12) << seed;
  }
}

TEST(BestApart, KeepsTheBestDiscsThatDoNotOverlap) {
  const std::vector<sim::Disc> kept = best_apart({{{0.0, 0.0, 1.0}, 5.0},
                                                  {{0.5, 0.0, 1.0}, 9.0},  // best, over the first
                                                  {{3.0, 0.0, 1.0}, 4.0},
                                                  {{3.0, 0.5, 4.0}, 3.0},  // over the one before
                                                  {{-9.0, 0.0, 1.0}, 2.0}},
                                                 2);
  ASSERT_EQ(kept.size(), 2U);
  EXPECT_EQ(kept[0].x_m, 0.5);
  EXPECT_EQ(kept[1].x_m, 3.0);
}

}  // namespace
}  // namespace slipway::gap
