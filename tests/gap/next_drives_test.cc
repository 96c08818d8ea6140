#include "gap/diagnosis/describe/next_drives.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "gap/diagnosis/model/outside_cause.h"
#include "tests/sim/reference_models.h"

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

FittedExplanation explanation(const DriveCampaign& campaign, EffectVariant variant, std::string_view field,
                              double value) {
  FittedExplanation fit{{}, Hypothesis(campaign, {std::move(variant)})};
  fit.x = fit.hypothesis.neutral();
  const auto parameters = fit.hypothesis.parameters();
  for (std::size_t p = 0; p < fit.x.size(); ++p)
    if (parameters[p].name == field) fit.x[p] = value;
  return fit;
}

// A pull against the travel is a tilt of the map as long as the rover only drives forward.
TEST(NextDrives, BackTheRoverWhereThatTellsAPullFromATilt) {
  DriveCampaign campaign;
  campaign.rover = std::make_shared<sim::RoverModel>(sim::six_wheeler());
  campaign.gravity_m_s2 = 3.71;
  campaign.soils.resize(1);
  campaign.soils[0].soil = sim::sandy_loam();
  const double weight_n = campaign.rover->mass_kg * campaign.gravity_m_s2;
  const std::vector<EffectVariant> effects = effect_variants(*campaign.rover, {});
  const auto tilt = std::find_if(effects.begin(), effects.end(), [](const EffectVariant& v) {
    return v.effect == "attitude_bias" && v.label == "map and inclinometer";
  });
  ASSERT_NE(tilt, effects.end());
  const std::vector<EffectVariant> outside = outside_variants(campaign);
  ASSERT_EQ(outside.front().effect, "pull_along_travel");
  const FittedExplanation tilted = explanation(campaign, *tilt, "attitude_bias.pitch_deg", -2.0);
  const FittedExplanation pulled = explanation(campaign, outside.front(), "pull_along_travel.force_n",
                                               -weight_n * std::sin(2.0 * std::numbers::pi / 180.0));
  const std::vector<const FittedExplanation*> both{&tilted, &pulled};
  NextDriveOptions options;
  const std::vector<NextDrive> drives =
      next_drives(campaign, {}, both, std::vector{0.5, 0.5}, options, NoProgress{});
  ASSERT_FALSE(drives.empty());
  EXPECT_LT(drives.front().speed_m_s, 0.0);
  EXPECT_GT(drives.front().information_bits, 0.9);
  options.speed_shares = {1.0, 0.5, 0.5};
  const std::vector<NextDrive> forward =
      next_drives(campaign, {}, both, std::vector{0.5, 0.5}, options, NoProgress{});
  if (!forward.empty()) {
    EXPECT_LT(forward.front().information_bits, 0.3 * drives.front().information_bits);
  }
}

}  // namespace
}  // namespace slipway::gap
