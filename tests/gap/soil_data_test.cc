#include <gtest/gtest.h>

#include <cmath>

#include "soil_tests.h"

namespace slipway::gap {
namespace {

constexpr std::array<bool, kSoilChannels> kAll{true, true, true, true, true, true, true};

// Plates of these radii in a soil with these moduli.
SoilData made_plates(const sim::BekkerModuli& moduli, const std::vector<double>& radii, double noise) {
  SoilData data;
  for (const double radius : radii) {
    PlateRecord plate{radius, {}, {}};
    for (std::uint64_t i = 1; i <= 15; ++i) {
      const double z = 0.003 * static_cast<double>(i);
      plate.sinkage_m.push_back(z);
      plate.pressure_pa.push_back(moduli.stiffness(radius) * std::pow(z, moduli.n) *
                                  (1.0 + noise * random_normal(data.plates.size(), i)));
    }
    data.plates.push_back(plate);
  }
  return data;
}

TEST(SoilObservations, AllWheelsAtOnceAreAsEachOnTheRig) {
  const sim::Soil soil = dry_sand();
  const SoilData data = made_wheel_tests(soil, {.pull = true, .current = true});
  SoilObservations observations(data, {}, kAll);
  std::vector<double> values(observations.data().size());
  // From another soil, so that the wheels have to move.
  for (const double friction_deg : {36.0, 24.0, 28.0}) {
    sim::Soil at = soil;
    at.friction_angle_rad = rad_from_deg(friction_deg);
    ASSERT_TRUE(observations.predict(at, values));
  }
  for (std::size_t i = 0; i < values.size(); ++i)
    EXPECT_NEAR(values[i] / observations.data()[i].measured, 1.0, 1e-6)
        << name_of(observations.data()[i].channel) << " of test " << observations.data()[i].test;
  EXPECT_EQ(observations.sunk(), 0U);
}

TEST(SoilObservations, AWheelThatNoDepthCarriesIsHeldAtTheAxle) {
  SoilData data = made_wheel_tests(dry_sand(), {.count = 10});
  data.wheels[0].test.load_n = 1e5;
  SoilObservations observations(data, {}, kAll);
  std::vector<double> values(observations.data().size());
  ASSERT_TRUE(observations.predict(dry_sand(), values));
  EXPECT_EQ(observations.sunk(), 1U);
}

TEST(EstimateSoil, PlatesGiveANegativeKcToo) {
  sim::Soil truth = dry_sand();
  truth.pressure = {-30e3, 2.2e6, 1.2};
  const auto e =
      estimate(start_49_percent_off(dry_sand()), made_plates(truth.pressure, {0.03, 0.06, 0.1}, 0.0));
  ASSERT_TRUE(e) << e.error().detail;
  EXPECT_NEAR(of(*e, SoilParameter::kKc).value / truth.pressure.k_c, 1.0, 0.03);
  EXPECT_NEAR(of(*e, SoilParameter::kKphi).value / truth.pressure.k_phi, 1.0, 0.01);
  EXPECT_NEAR(of(*e, SoilParameter::kN).value, truth.pressure.n, 0.01);
  EXPECT_LT(of(*e, SoilParameter::kKc).high, 0.0);
  EXPECT_EQ(e->parameters.size(), 3U);
}

TEST(EstimateSoil, PlatesOfOneSizeCannotTellKcFromKphiAndItSaysSo) {
  const SoilData data = made_plates(dry_sand().pressure, {0.05, 0.05}, 0.01);
  const auto e = estimate(start_49_percent_off(dry_sand()), data,
                          {.free = {SoilParameter::kKc, SoilParameter::kKphi, SoilParameter::kN}});
  ASSERT_TRUE(e) << e.error().detail;
  EXPECT_EQ(of(*e, SoilParameter::kKc).determination, Determination::kUndetermined);
  EXPECT_EQ(of(*e, SoilParameter::kKphi).determination, Determination::kUndetermined);
  EXPECT_EQ(of(*e, SoilParameter::kN).determination, Determination::kDetermined);
  ASSERT_EQ(e->open.size(), 1U);
  EXPECT_NE(e->open[0].words.find("k_c"), std::string::npos);
  ASSERT_FALSE(e->notes.empty());
  const auto merged = estimate(start_49_percent_off(dry_sand()), data);
  ASSERT_TRUE(merged) << merged.error().detail;
  EXPECT_TRUE(merged->open.empty());
  EXPECT_EQ(of(*merged, SoilParameter::kBekker).determination, Determination::kDetermined);
}

TEST(EstimateSoil, WheelsAndPlatesTogetherTellAllSix) {
  const sim::Soil truth = dry_sand();
  SoilData data = made_wheel_tests(truth, {.count = 20});
  data.plates = made_plates(truth.pressure, {0.02, 0.1}, 0.0).plates;
  const auto e = estimate(start_49_percent_off(truth), data);
  ASSERT_TRUE(e) << e.error().detail;
  ASSERT_EQ(e->parameters.size(), 6U);
  EXPECT_LT(std::abs(off(*e, SoilParameter::kKphi, truth)), 0.03);
  EXPECT_LT(std::abs(off(*e, SoilParameter::kN, truth)), 0.01);
  EXPECT_LT(std::abs(off(*e, SoilParameter::kFrictionAngle, truth)), 0.03);
}

TEST(EstimateSoil, CurrentsAloneTellTheStrengthButNotEverything) {
  const sim::Soil truth = dry_sand();
  const auto data = made_wheel_tests(
      truth, {.noise = 0.01, .torque = false, .thrust = false, .sinkage = false, .current = true});
  const auto e = estimate(start_49_percent_off(truth), data, {.noise = {.share = 0.01}});
  ASSERT_TRUE(e) << e.error().detail;
  for (const EstimatedParameter& p : e->parameters) {
    const double value = value_of(*p.parameter.soil, truth, e->width_m);
    // 90 % intervals of one seed: a tenth of room besides.
    EXPECT_GE(value, p.low - 0.1 * std::abs(value)) << p.words;
    EXPECT_LE(value, p.high + 0.1 * std::abs(value)) << p.words;
  }
  EXPECT_EQ(of(*e, SoilParameter::kFrictionAngle).determination, Determination::kDetermined);
  EXPECT_NE(of(*e, SoilParameter::kBekker).determination, Determination::kDetermined);
}

TEST(EstimateSoil, NothingIsDeterminedWhereTheModelDoesNotHold) {
  sim::Soil truth = dry_sand();
  const sim::Soil searched = truth;
  truth.n1 = 1.0;  // sinks deeper the more it slips: no soil that is searched does
  const auto e = estimate(start_49_percent_off(searched),
                          made_wheel_tests(truth, {.noise = 0.005, .seed = 3}), {.noise = {.share = 0.005}});
  ASSERT_TRUE(e) << e.error().detail;
  ASSERT_GT(e->residual_variance, 25.0);
  for (const EstimatedParameter& p : e->parameters) {
    EXPECT_EQ(p.determination, Determination::kUndetermined);
    EXPECT_NE(p.words.find("the model does not hold"), std::string::npos) << p.words;
  }
}

TEST(EstimateSoil, ALossLeavesOutliersAlone) {
  const sim::Soil truth = dry_sand();
  SoilData data = made_wheel_tests(truth, {.noise = 0.02, .seed = 5});
  for (std::size_t i = 0; i < data.wheels.size(); i += 7) *data.wheels[i][SoilChannel::kTorque].value *= 2.0;
  const auto plain = estimate(start_49_percent_off(truth), data);
  const auto robust = estimate(start_49_percent_off(truth), data, {.loss = RobustLoss::kCauchy});
  ASSERT_TRUE(plain) << plain.error().detail;
  ASSERT_TRUE(robust) << robust.error().detail;
  EXPECT_LT(std::abs(off(*robust, SoilParameter::kFrictionAngle, truth)), 0.05);
  EXPECT_LT(std::abs(off(*robust, SoilParameter::kFrictionAngle, truth)),
            std::abs(off(*plain, SoilParameter::kFrictionAngle, truth)));
  std::size_t outliers = 0;
  for (const FittedDatum& d : robust->data) outliers += d.outlier ? 1 : 0;
  EXPECT_GE(outliers, 7U);
  EXPECT_LE(outliers, 10U);
}

TEST(EstimateSoil, BoundsAreKept) {
  const sim::Soil truth = dry_sand();
  const auto e = estimate(start_49_percent_off(truth), made_wheel_tests(truth, {.count = 20}),
                          {.bounds = {{SoilParameter::kN, 1.2, 1.5}}});
  ASSERT_TRUE(e) << e.error().detail;
  EXPECT_NEAR(of(*e, SoilParameter::kN).value, 1.2, 1e-6);
  EXPECT_TRUE(of(*e, SoilParameter::kN).on_bound);
}

TEST(EstimateSoil, WithTheSoilsOwnSpreadItStaysNearerToTheSoil) {
  const sim::Soil truth = dry_sand();
  const auto data = made_wheel_tests(truth, {.count = 10, .noise = 0.02});
  const auto start = start_49_percent_off(truth);
  const auto wide = estimate(start, data), own = estimate(start, data, {.priors = SoilPriors::kSoil});
  ASSERT_TRUE(wide && own);
  EXPECT_GT(off(*own, SoilParameter::kN, truth), off(*wide, SoilParameter::kN, truth));
}

TEST(EstimateSoil, TheSoilToPlanWithHasTheEstimateAsMeanAndItsSpread) {
  const sim::Soil truth = dry_sand();
  const auto e = estimate(start_49_percent_off(truth), made_wheel_tests(truth, {.noise = 0.02}));
  ASSERT_TRUE(e) << e.error().detail;
  EXPECT_DOUBLE_EQ(e->soil.mean.pressure.n, of(*e, SoilParameter::kN).value);
  EXPECT_NEAR(e->soil.std.n, *of(*e, SoilParameter::kN).std, 1e-12);
  EXPECT_NEAR(e->soil.std.friction_angle_rad, *of(*e, SoilParameter::kFrictionAngle).std, 1e-12);
  EXPECT_GT(e->soil.correlation(0, 1), 0.5);  // stiffness and n
  EXPECT_NO_THROW(sim::draw_soil(e->soil, sim::SoilNormals::Ones()));
}

TEST(EstimateSoil, TheSameDataAndSeedGiveTheSameNumbers) {
  const auto data = made_wheel_tests(dry_sand(), {.count = 15, .noise = 0.3});
  const auto a = estimate(start_49_percent_off(dry_sand()), data),
             b = estimate(start_49_percent_off(dry_sand()), data);
  ASSERT_TRUE(a && b);
  for (std::size_t i = 0; i < a->parameters.size(); ++i) {
    EXPECT_EQ(a->parameters[i].value, b->parameters[i].value);
    EXPECT_EQ(a->parameters[i].words, b->parameters[i].words);
  }
}

TEST(EstimateSoil, WhatCannotBeAskedIsRefusedWithEveryFault) {
  const auto data = made_wheel_tests(dry_sand(), {.count = 10});
  const auto e = estimate(start_49_percent_off(dry_sand()), data,
                          {.free = {SoilParameter::kKc, SoilParameter::kN, SoilParameter::kN},
                           .bounds = {{SoilParameter::kCohesion, 1.0, 2.0}, {SoilParameter::kN, 2.0, 1.0}}});
  ASSERT_FALSE(e);
  EXPECT_EQ(e.error().code, ErrorCode::kInvalidRequest);
  EXPECT_EQ(e.error().faults.size(), 4U);
  EXPECT_EQ(estimate(start_49_percent_off(dry_sand()), {}).error().code, ErrorCode::kNoData);
}

class Cancelled final : public Progress {
 public:
  void report(std::string_view /*stage*/, double /*fraction*/) override {}
  bool cancelled() const override { return true; }
};

TEST(EstimateSoil, GivenUpItSaysSo) {
  Cancelled progress;
  const auto data = made_wheel_tests(dry_sand(), {.count = 10});
  const auto e = estimate_soil(start_49_percent_off(dry_sand()), data, {}, progress);
  ASSERT_FALSE(e);
  EXPECT_EQ(e.error().code, ErrorCode::kCancelled);
}

}  // namespace
}  // namespace slipway::gap
