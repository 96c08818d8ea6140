#include <gtest/gtest.h>

#include <cmath>

#include "gap/diagnosis/search/effect_screening.h"
#include "gap/diagnosis/search/soft_patch_search.h"
#include "tests/gap/linear_model.h"

namespace slipway::gap {
namespace {

using testing::parameter;
using testing::random_matrix;

// Of one column a beside nothing: estimate a.r / (1 + a.a), gain (a.r)^2 / 2 (1 + a.a) - log(1 + a.a) / 2.
TEST(LinearGain, OfOneColumnHasAClosedForm) {
  const Eigen::Vector3d r(3.0, -1.0, 2.0), a(1.0, 0.0, 2.0);
  const LinearGain found = linear_gain(r, Eigen::MatrixXd(3, 0), a, std::vector<Parameter>{parameter(0.1)});
  EXPECT_NEAR(found.estimate[0], 7.0 / 6.0, 1e-14);
  EXPECT_NEAR(found.gain, 49.0 / 12.0 - 0.5 * std::log(6.0), 1e-13);
}

// What known columns explain is not gained twice: the column projected on them is worth next to nothing.
TEST(LinearGain, BesideAColumnThatExplainsTheSameIsALoss) {
  const Eigen::VectorXd a = 50.0 * random_matrix(10, 1, 3);
  const Eigen::VectorXd r = 0.7 * a;
  EXPECT_GT(linear_gain(r, Eigen::MatrixXd(10, 0), a, std::vector<Parameter>{parameter(1.0)}).gain, 1000.0);
  EXPECT_LT(linear_gain(r, a, a, std::vector<Parameter>{parameter(1.0)}).gain, 0.0);
}

TEST(LinearGain, LeavesOutWhatWouldHaveTheWrongSignAndStaysWithinBounds) {
  const Eigen::Vector2d r(-3.0, 4.0);
  const Eigen::Matrix2d columns = Eigen::Matrix2d::Identity();
  const std::vector<Parameter> positive{parameter(1.0, 0.0, 9.0), parameter(0.5, 0.0, 0.6)};
  const LinearGain found = linear_gain(r, Eigen::MatrixXd(2, 0), columns, positive);
  EXPECT_EQ(found.estimate[0], 0.0) << "it would be -1.5";
  EXPECT_DOUBLE_EQ(found.estimate[1], 1.2) << "2 prior deviations, of which 0.6 / 0.5 are allowed";
  EXPECT_NEAR(found.gain, 16.0 / 4.0 - 0.5 * std::log(2.0) + std::log(2.0), 1e-13)
      << "its prior lies on one side";
  const LinearGain none = linear_gain(Eigen::Vector2d(-1.0, -1.0), Eigen::MatrixXd(2, 0), columns, positive);
  EXPECT_EQ(none.gain, 0.0);
  EXPECT_TRUE(none.estimate.isZero());
}

// By Schur's complement, the gain of one more column is the difference of two log marginals.
TEST(ColumnBeside, HasTheGainOfTheLogMarginal) {
  const Eigen::MatrixXd known = random_matrix(15, 4, 7);
  const Eigen::VectorXd r = 2.0 * random_matrix(15, 1, 100);
  const ColumnBeside beside(r, known);
  int positive = 0;
  for (std::uint64_t seed = 200; seed < 220; ++seed) {
    const Eigen::VectorXd column = random_matrix(15, 1, seed);
    Eigen::MatrixXd all(15, 5);
    all << known, column;
    const auto gain = beside.gain(column);
    const auto opposite = beside.gain(-column);
    EXPECT_NE(gain.has_value(), opposite.has_value()) << "soil can only be weaker";
    positive += gain ? 1 : 0;
    EXPECT_NEAR(gain ? *gain : *opposite, log_marginal(r, all) - log_marginal(r, known), 1e-10) << seed;
  }
  EXPECT_GT(positive, 3);
  EXPECT_LT(positive, 17);
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
