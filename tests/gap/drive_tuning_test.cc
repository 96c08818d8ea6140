#include "gap/estimate/drive_tuning.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "core/random.h"

namespace slipway::gap {
namespace {

// A drive of 2 m in closed form: it falls short by slip that grows with tilt, and turns with the crossfall.
Pose2 toy(double tilt_rad, double grip, double drift) {
  const double slip = std::tan(tilt_rad) / grip;
  return {2.0 * (1.0 - slip), drift * std::sin(tilt_rad), drift * slip};
}

struct Toy {
  std::vector<MeasuredDrive> drives;
  FinalPose model;
};

// Beyond `steep_rad` the measured rover grips as `steep_grip`, which no single set of the model does.
Toy toy_drives(double noise_m, double steep_rad = 2.0, double steep_grip = 0.0, std::uint64_t seed = 7) {
  Toy result;
  std::uint64_t counter = 0;
  for (const double tilt_deg : {0.085, 5.743, 10.758, 20.764}) {
    const double tilt = rad_from_deg(tilt_deg);
    MeasuredDrive drive{std::to_string(tilt_deg), tilt, {}};
    for (int repeat = 0; repeat < 3; ++repeat) {
      Pose2 end = toy(tilt, tilt < steep_rad ? 1.27 : steep_grip, 0.33);
      end.x_m += noise_m * random_normal(seed, counter++);
      end.y_m += noise_m * random_normal(seed, counter++);
      end.yaw_rad += noise_m * random_normal(seed, counter++) + (repeat == 1 ? 2.0 * std::numbers::pi : 0.0);
      drive.finals.push_back(end);
    }
    result.drives.push_back(drive);
  }
  result.model = [tilts = result.drives](std::size_t drive, std::span<const double> x) {
    return toy(tilts[drive].tilt_rad, x[0], x[1]);
  };
  return result;
}

const std::vector<TunedParameter> kParameters{
    {{.name = "grip", .lowest = 0.5, .highest = 2.5}, std::nullopt},
    {{.name = "drift", .lowest = 0.0, .highest = 1.0}, std::nullopt}};

TEST(FinalScore, CountsPlacesAndWrappedHeadingsInTheirScales) {
  const ScoreScales scales{.position_m = 0.1, .heading_rad = 0.05};
  EXPECT_NEAR(final_score({1.3, 0.4, 0.0}, {1.0, 0.0, 0.0}, scales), 5.0, 1e-12);
  EXPECT_NEAR(final_score({0, 0, 2.0 * std::numbers::pi + 0.1}, {0, 0, 0}, scales), 2.0, 1e-9);
  EXPECT_NEAR(final_score({0.3, 0, -0.2}, {0, 0, 0}, scales), 5.0, 1e-9);
}

TEST(TuneDrives, SweepAndLeastSquaresFindTheToysTruthWithinTheStatedUncertainty) {
  const Toy toy = toy_drives(0.004);
  NoProgress progress;
  const auto tuning = tune_drives(kParameters, toy.drives, toy.model, {}, progress);
  ASSERT_TRUE(tuning) << tuning.error().detail;
  const SweepPoint& best = tuning->sweep.points[tuning->sweep.best];
  EXPECT_NEAR(best.x[0], 1.27, 0.13);  // half a step of the fine grid
  EXPECT_NEAR(best.x[1], 0.33, 0.07);
  ASSERT_TRUE(tuning->fit);
  const TuningFit& fit = *tuning->fit;
  EXPECT_TRUE(fit.fit.converged);
  EXPECT_LT(fit.score, *best.score);
  const double truth[] = {1.27, 0.33};
  for (std::size_t k = 0; k < 2; ++k) {
    ASSERT_TRUE(fit.fit.standard_error(k));
    EXPECT_GT(*fit.fit.standard_error(k), 0.0);
    EXPECT_LT(*fit.fit.standard_error(k), 0.03);
    EXPECT_LT(std::abs(fit.fit.estimate[k] - truth[k]), 3.0 * *fit.fit.standard_error(k)) << k;
  }
}

TEST(TuneDrives, TheFlatIsServedByMostSetsAndTheSteepByFew) {
  const Toy toy = toy_drives(0.002);
  NoProgress progress;
  const auto tuning =
      tune_drives(kParameters, toy.drives, toy.model, {.good_enough = 0.5, .least_squares = false}, progress);
  ASSERT_TRUE(tuning) << tuning.error().detail;
  ASSERT_EQ(tuning->tilts.size(), 4U);
  EXPECT_NEAR(deg_from_rad(tuning->tilts[3].tilt_rad), 20.764, 1e-9);
  EXPECT_EQ(tuning->tilts[1].drives, (std::vector<std::size_t>{1}));
  std::vector<std::size_t> sets(4, 0);
  for (const SlopeService& service : tuning->services)
    for (std::size_t k = 0; k < 4; ++k) sets[k] += service.served[k] ? 1 : 0;
  EXPECT_EQ(sets[0], tuning->services.size());
  EXPECT_GT(sets[0], sets[1]);
  EXPECT_GT(sets[1], sets[2]);
  EXPECT_GT(sets[2], sets[3]);
  // What was tuned for the steep serves the flat too; ROAMS found the same.
  const SlopeService& steep = tuning->services[tuning->tilts[3].best];
  EXPECT_EQ(steep.served, (std::vector<bool>{true, true, true, true}));
  EXPECT_FALSE(tuning->fit);
}

TEST(TuneDrives, AModelThatIsWrongOnSteepSlopesHasNoSetForAllTilts) {
  const Toy toy = toy_drives(0.0005, rad_from_deg(15.0), 0.6);
  NoProgress progress;
  const auto tuning =
      tune_drives(kParameters, toy.drives, toy.model, {.good_enough = 0.25, .fit_each_tilt = true}, progress);
  ASSERT_TRUE(tuning) << tuning.error().detail;
  const SlopeService& gentle = tuning->services[tuning->tilts[2].best];
  EXPECT_EQ(gentle.served, (std::vector<bool>{true, true, true, false}));
  ASSERT_TRUE(gentle.range);
  EXPECT_NEAR(deg_from_rad(gentle.range->lowest_rad), 0.085, 1e-9);
  EXPECT_NEAR(deg_from_rad(gentle.range->highest_rad), 10.758, 1e-9);
  const SlopeService& steep = tuning->services[tuning->tilts[3].best];
  EXPECT_TRUE(steep.served[3]);
  EXPECT_FALSE(steep.served[2]);
  EXPECT_EQ(tuning->services[tuning->widest].count, 3);
  for (const SlopeService& service : tuning->services) EXPECT_LT(service.count, 4);
  // Each tilt by itself tells the two grips apart by far more than their uncertainties.
  for (const std::size_t k : {2U, 3U}) {
    ASSERT_TRUE(tuning->tilts[k].fit);
    const LeastSquaresFit& fit = tuning->tilts[k].fit->fit;
    EXPECT_LT(std::abs(fit.estimate[0] - (k == 2 ? 1.27 : 0.6)), 4.0 * *fit.standard_error(0)) << k;
  }
}

TEST(TuneDrives, WhatTheDrivesDoNotTellIsNamedAndAPriorTellsIt) {
  Toy toy = toy_drives(0.002);
  toy.model = [model = toy.model](std::size_t drive, std::span<const double> x) {
    return model(drive, std::array{x[0] * x[2], x[1]});
  };
  std::vector<TunedParameter> parameters = kParameters;
  parameters[0].sweep.coarse = parameters[0].sweep.fine = 3;
  parameters[1].sweep.coarse = parameters[1].sweep.fine = 3;
  parameters.push_back({{.name = "gain", .lowest = 0.5, .highest = 2.0, .coarse = 4, .fine = 3}, {}});
  NoProgress progress;
  const auto open = tune_drives(parameters, toy.drives, toy.model, {}, progress);
  ASSERT_TRUE(open) << open.error().detail;
  ASSERT_EQ(open->fit->fit.undetermined.size(), 1U);
  EXPECT_NE(open->fit->fit.undetermined[0].words.find("gain"), std::string::npos);
  EXPECT_FALSE(open->fit->fit.standard_error(0));
  EXPECT_TRUE(open->fit->fit.standard_error(1));
  parameters[2].prior = Prior{1.0, 0.05};
  const auto told = tune_drives(parameters, toy.drives, toy.model, {}, progress);
  ASSERT_TRUE(told) << told.error().detail;
  EXPECT_TRUE(told->fit->fit.undetermined.empty());
  EXPECT_NEAR(told->fit->fit.estimate[2], 1.0, 0.01);
  EXPECT_NEAR(*told->fit->fit.standard_error(2), 0.05, 0.005);
  EXPECT_NEAR(told->fit->fit.estimate[0], 1.27, 0.03);
}

TEST(TuneDrives, KnownErrorsGiveTheirUncertainty) {
  const Toy toy = toy_drives(0.0);
  NoProgress progress;
  const TuningOptions options{.scales = {.position_m = 0.01, .heading_rad = 1.0}, .scales_are_errors = true};
  const auto tuning = tune_drives(kParameters, toy.drives, toy.model, options, progress);
  ASSERT_TRUE(tuning) << tuning.error().detail;
  // x = 2 - 2 tan(tilt) / grip, three times at each tilt.
  double information = 0.0;
  for (const MeasuredDrive& drive : toy.drives)
    information += 3.0 * std::pow(2.0 * std::tan(drive.tilt_rad) / (1.27 * 1.27) / 0.01, 2);
  EXPECT_NEAR(*tuning->fit->fit.standard_error(0) * std::sqrt(information), 1.0, 0.01);
  EXPECT_NEAR(tuning->fit->fit.estimate[0], 1.27, 0.1 * *tuning->fit->fit.standard_error(0));
}

// How far the estimate of grip is from the truth, in its stated standard deviations.
double grip_off(const DriveTuning& tuning) {
  return std::abs(tuning.fit->fit.estimate[0] - 1.27) / tuning.fit->fit.standard_error(0).value();
}

TEST(TuneDrives, AGrossOutlierIsNamedAndLeavesTheEstimateWithALossAlone) {
  Toy toy = toy_drives(0.004);
  toy.drives[3].finals[1].x_m -= 1.0;  // one of the three on the steepest slope slid a metre down
  NoProgress progress;
  // The noise is not known, or taken to be what it is.
  for (const TuningOptions& options :
       {TuningOptions{},
        TuningOptions{.scales = {.position_m = 0.004, .heading_rad = 0.004}, .scales_are_errors = true}}) {
    const auto squares = tune_drives(kParameters, toy.drives, toy.model, options, progress);
    ASSERT_TRUE(squares && squares->fit);
    EXPECT_GT(grip_off(*squares), 2.5);
    EXPECT_TRUE(squares->fit->beyond.empty());
    for (const RobustLoss loss : {RobustLoss::kHuber, RobustLoss::kCauchy}) {
      TuningOptions robust = options;
      robust.loss = loss;
      const auto tuning = tune_drives(kParameters, toy.drives, toy.model, robust, progress);
      ASSERT_TRUE(tuning && tuning->fit);
      EXPECT_LT(grip_off(*tuning), 2.0);
      EXPECT_LT(tuning->fit->fit.standard_error(0).value(), 0.03);
      EXPECT_LT(tuning->fit->fit.standard_error(0).value(),
                squares->fit->fit.standard_error(0).value() / 4.0);
      const double noise_m = tuning->fit->noise * robust.scales.position_m;
      EXPECT_NEAR(noise_m, 0.004, 0.002);
      EXPECT_TRUE(std::find(tuning->fit->beyond.begin(), tuning->fit->beyond.end(), 3U) !=
                  tuning->fit->beyond.end());
    }
  }
}

TEST(TuneDrives, UncertaintyIsTheScatterOfEstimatesWithALossAndWithout) {
  NoProgress progress;
  const int repeats = 60;
  for (const RobustLoss loss : {RobustLoss::kNone, RobustLoss::kHuber, RobustLoss::kCauchy}) {
    double squares = 0.0;
    for (int set = 0; set < repeats; ++set) {
      const Toy toy = toy_drives(0.004, 2.0, 0.0, 1000 + static_cast<std::uint64_t>(set));
      const TuningOptions options{.scales = {.position_m = 0.01, .heading_rad = 0.01}, .loss = loss};
      const auto tuning = tune_drives(kParameters, toy.drives, toy.model, options, progress);
      ASSERT_TRUE(tuning && tuning->fit);
      squares += std::pow(grip_off(*tuning), 2);
    }
    EXPECT_GT(std::sqrt(squares / repeats), 0.7) << static_cast<int>(loss);
    EXPECT_LT(std::sqrt(squares / repeats), 1.3) << static_cast<int>(loss);
  }
}

TEST(TuneDrives, ErrorsThatAreStatedTooSmallAreWidenedByWhatIsLeftOver) {
  const Toy toy = toy_drives(0.004);
  NoProgress progress;
  const auto uncertainty = [&](double error) {
    const TuningOptions options{.scales = {.position_m = error, .heading_rad = error},
                                .scales_are_errors = true};
    const auto tuning = tune_drives(kParameters, toy.drives, toy.model, options, progress);
    EXPECT_NEAR(std::sqrt(tuning->fit->fit.residual_variance) * error, 0.004, 0.001);
    return tuning->fit->fit.standard_error(0).value();
  };
  EXPECT_NEAR(uncertainty(0.001) / uncertainty(0.0005), 1.0, 0.01);
  EXPECT_NEAR(uncertainty(0.016) / uncertainty(0.008), 2.0, 0.02);  // they are taken at their word
}

TEST(TuneDrives, RefusesNoDrivesAndScalesThatAreNone) {
  const Toy toy = toy_drives(0.0);
  NoProgress progress;
  const auto none = tune_drives(kParameters, {}, toy.model, {}, progress);
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().code, ErrorCode::kInvalidRequest);
  const auto scales =
      tune_drives(kParameters, toy.drives, toy.model,
                  {.scales = {.position_m = 0.0}, .loss = RobustLoss::kHuber, .loss_scale = -1.0}, progress);
  ASSERT_FALSE(scales);
  EXPECT_EQ(scales.error().faults.at(0).pointer, "/options/position_m");
  EXPECT_EQ(scales.error().faults.at(1).pointer, "/options/loss_scale");
}

}  // namespace
}  // namespace slipway::gap
