#include "gap/rival_outcomes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace slipway::gap {
namespace {

// Two rivals and one parameter; drives of one observation each, told apart by so many deviations.
RivalOutcomes two_rivals(std::initializer_list<double> apart, std::initializer_list<double> response,
                         double parameter_std) {
  RivalOutcomes outcomes;
  const auto count = static_cast<Eigen::Index>(apart.size());
  outcomes.means = Eigen::MatrixXd::Zero(count, 2);
  outcomes.responses = Eigen::MatrixXd::Zero(count, 1);
  for (Eigen::Index d = 0; d < count; ++d) {
    outcomes.means(d, 1) = apart.begin()[d];
    outcomes.responses(d, 0) = response.begin()[d];
    outcomes.first_row.push_back(d);
  }
  outcomes.first_row.push_back(count);
  outcomes.covariance = Eigen::MatrixXd::Constant(1, 1, parameter_std * parameter_std);
  outcomes.weights = {3.0, 3.0};
  outcomes.family = {0, 1};
  return outcomes;
}

TEST(MostTellingDrives, TellFromNoneToOneBitOfTwoRivals) {
  const auto chosen = most_telling_drives(two_rivals({0.0, 2.0, 40.0}, {0.0, 0.0, 0.0}, 1.0), 1, 1e-6);
  ASSERT_EQ(chosen.size(), 1U);
  EXPECT_EQ(chosen[0].drive, 2U);
  EXPECT_NEAR(chosen[0].bits, 1.0, 1e-9);
  const auto two = most_telling_drives(two_rivals({2.0}, {0.0}, 1.0), 1, 1e-6);
  EXPECT_NEAR(two[0].bits, 1.0 - std::log2(1.0 + std::exp(-0.5)), 1e-12) << "exp(-2^2 / 8)";
  EXPECT_TRUE(most_telling_drives(two_rivals({0.0}, {0.0}, 1.0), 1, 1e-6).empty());
}

// What re-tuning takes up does not count, however large it is.
TEST(MostTellingDrives, LeaveOutWhatAnOpenParameterTakesUp) {
  EXPECT_EQ(most_telling_drives(two_rivals({9.0, 2.0}, {10.0, 0.0}, 1.0), 1, 1e-6)[0].drive, 1U);
  EXPECT_EQ(most_telling_drives(two_rivals({9.0, 2.0}, {10.0, 0.0}, 0.01), 1, 1e-6)[0].drive, 0U)
      << "known well enough, the parameter takes up nothing";
}

// Two drives that the parameter moves alike say together what neither does alone.
TEST(MostTellingDrives, CountWhatADriveAddsToThoseBeforeIt) {
  const auto chosen = most_telling_drives(two_rivals({3.0, 3.0, -3.0}, {10.0, 10.0, 10.0}, 1.0), 2, 1e-6);
  ASSERT_EQ(chosen.size(), 2U);
  EXPECT_EQ(chosen[0].drive, 0U);
  EXPECT_EQ(chosen[1].drive, 2U) << "the same again tells next to nothing";
  EXPECT_GT(chosen[1].bits, 10.0 * chosen[0].bits);
}

TEST(MostTellingDrives, OfOneFamilyNothingIsAsked) {
  RivalOutcomes outcomes = two_rivals({40.0}, {0.0}, 1.0);
  outcomes.family = {0, 0};
  EXPECT_TRUE(most_telling_drives(outcomes, 1, 1e-6).empty());
}

TEST(MostTellingDrives, BelieveAShareOfTheEvidence) {
  RivalOutcomes outcomes = two_rivals({4.0}, {0.0}, 1.0);
  outcomes.believed = 0.25;
  EXPECT_NEAR(most_telling_drives(outcomes, 1, 1e-6)[0].bits,
              most_telling_drives(two_rivals({2.0}, {0.0}, 1.0), 1, 1e-6)[0].bits, 1e-12);
}

}  // namespace
}  // namespace slipway::gap
