#include "gap/diagnosis/describe/next_drives.h"

#include <gtest/gtest.h>

#include <cmath>

namespace slipway::gap {
namespace {

using Outcomes = std::vector<std::vector<ExpectedReading>>;

// Readings whose error is 1.
std::vector<ExpectedReading> readings(std::initializer_list<double> values) {
  std::vector<ExpectedReading> all;
  for (const double value : values) all.push_back({value, 1.0});
  return all;
}

TEST(InformationBits, AreNoneWhereExplanationsPredictTheSame) {
  EXPECT_NEAR(information_bits(Outcomes{readings({1.0, 2.0}), readings({1.0, 2.0})}, std::vector{0.7, 0.3}),
              0.0, 1e-14);
  EXPECT_EQ(information_bits(Outcomes{readings({5.0})}, std::vector{1.0}), 0.0);
}

TEST(InformationBits, AreTheEntropyWhereTheyPredictFarApart) {
  EXPECT_NEAR(information_bits(Outcomes{readings({0.0}), readings({100.0})}, std::vector{0.5, 0.5}), 1.0,
              1e-12);
  EXPECT_NEAR(information_bits(Outcomes{readings({0.0}), readings({100.0}), readings({-100.0})},
                               std::vector{0.5, 0.25, 0.25}),
              1.5, 1e-12);
}

// Of two equally probable normals a distance d apart: 1 - log2(1 + exp(-d^2 / 8)).
TEST(InformationBits, OfTwoNormalsFollowTheirBhattacharyyaDistance) {
  for (const double d : {0.5, 2.0, 4.0})
    EXPECT_NEAR(
        information_bits(Outcomes{readings({0.0, 0.0}), readings({0.6 * d, 0.8 * d})}, std::vector{0.5, 0.5}),
        1.0 - std::log2(1.0 + std::exp(-d * d / 8.0)), 1e-12)
        << d;
}

TEST(InformationBits, AreFewerWhereMuchIsLeftToSomethingUnknown) {
  const Outcomes apart{readings({0.0}), readings({100.0})};
  EXPECT_NEAR(information_bits(apart, std::vector{0.1, 0.1}), 0.2, 1e-12);
}

// An error that is a share of the value hides no difference: 2 and 3 A, read within 1 %, are 40 errors apart.
TEST(InformationBits, SeeCurrentsWhoseErrorIsAShareOfThem) {
  const Outcomes apart{{{2.0, 0.02}}, {{3.0, 0.03}}};
  EXPECT_NEAR(information_bits(apart, std::vector{0.5, 0.5}), 1.0, 1e-12);
}

// Of normals around one value with deviations 1 and s: exp(-B) = sqrt(2 s / (1 + s^2)).
TEST(InformationBits, CountDifferentErrorsToo) {
  constexpr double kOther = 3.0;
  const Outcomes alike{{{5.0, 1.0}}, {{5.0, kOther}}};
  EXPECT_NEAR(information_bits(alike, std::vector{0.5, 0.5}),
              1.0 - std::log2(1.0 + std::sqrt(2.0 * kOther / (1.0 + kOther * kOther))), 1e-12);
}

NextDrive with(double tilt, double heading, double bits) {
  return {tilt, heading, 0.04, 0.0, 20.0, bits};
}

TEST(OneOfAKind, LeavesOutNeighboursAndWhatSaysNothing) {
  NextDriveOptions options;
  options.max_drives = 3;
  const std::vector<NextDrive> chosen =
      one_of_a_kind({with(5.0, 0.0, 0.5), with(10.0, 0.0, 0.9), with(0.0, 0.0, 0.4), with(10.0, 90.0, 0.3),
                     with(15.0, 180.0, 1e-4)},
                    options);
  ASSERT_EQ(chosen.size(), 3U);
  EXPECT_EQ(chosen[0].tilt_deg, 10.0);
  EXPECT_EQ(chosen[1].tilt_deg, 0.0) << "5 deg is within 6 deg of the best";
  EXPECT_EQ(chosen[2].heading_deg, 90.0);
  options.max_drives = 9;
  EXPECT_EQ(one_of_a_kind({with(10.0, 0.0, 0.9), with(15.0, 180.0, 1e-4)}, options).size(), 1U);
}

}  // namespace
}  // namespace slipway::gap
