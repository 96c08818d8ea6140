#include "steps/ground_chain.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/angle.h"
#include "core/random.h"
#include "six_wheels.h"
#include "steps/step_forecaster.h"
#include "steps/step_scores.h"

namespace slipway::steps {
namespace {

sim::SoilDistribution soil(const std::string& name, double stiffness, double friction_deg, double shear_m) {
  sim::SoilDistribution out;
  out.name = name;
  out.mean.pressure = {0.0, stiffness, 1.0};
  out.mean.cohesion_pa = 500.0;
  out.mean.friction_angle_rad = rad_from_deg(friction_deg);
  out.mean.shear_modulus_x_m = out.mean.shear_modulus_y_m = shear_m;
  out.mean.c1 = 0.18;
  out.mean.c2 = 0.32;
  return out;
}

// Firm ground nearly everywhere, a soil that slips much in patches of 10 m.
sim::SoilDistribution mostly_firm() {
  sim::SoilDistribution belief = soil("ground", 3e6, 32.0, 0.01);
  const auto firm = std::make_shared<const sim::SoilDistribution>(soil("firm", 3e6, 32.0, 0.01));
  const auto loose = std::make_shared<const sim::SoilDistribution>(soil("loose", 6e5, 26.0, 0.045));
  belief.drawn_apart = false;
  belief.alternatives_by = sim::AlternativesBy::kUnit;
  belief.correlation_length_m = 10.0;
  belief.alternatives = {{"firm", firm, 0.97, 0.97, false}, {"loose", loose, 0.03, 0.03, true}};
  return belief;
}

GroundChain chain() {
  static const sim::SoilDistribution belief = mostly_firm();
  const sim::SoilDistribution* const one = &belief;
  return {six_wheels(), 3.71, std::span(&one, 1)};
}

TEST(StepNoise, IsADistributionWhoseSlopeIsItsDensity) {
  const StepNoise noise;
  for (const double slip : {0.0, 0.3}) {
    EXPECT_NEAR(noise.below(-10.0, slip), 0.0, 1e-6);
    EXPECT_NEAR(noise.below(10.0, slip), 1.0, 1e-6);
    EXPECT_DOUBLE_EQ(noise.below(0.0, slip), 0.5);
    constexpr double kStep = 1e-6;
    for (const double at : {-0.1, 0.0, 0.02})
      EXPECT_NEAR((noise.below(at + kStep, slip) - noise.below(at - kStep, slip)) / (2.0 * kStep),
                  noise.density(at, slip), 1e-4);
  }
}

TEST(PlaneSlips, RiseWithTheClimbAndDoNotDependOnTheSideOfTheRoll) {
  const PlaneSlips slips(six_wheels(), 3.71, soil("firm", 3e6, 32.0, 0.01).mean);
  double last = -2.0;
  for (double climb = -20.0; climb <= 20.0; climb += 1.0) {
    const double here = slips.at(rad_from_deg(climb), 0.0);
    EXPECT_GE(here, last) << climb;
    last = here;
    EXPECT_EQ(slips.at(rad_from_deg(climb), 0.2), slips.at(rad_from_deg(climb), -0.2));
  }
}

// Odometry that reckons with a radius too large counts a way that is not made.
TEST(PlaneSlips, HoldWhatOdometryCountsTooMuch) {
  sim::RoverModel rover = six_wheels();
  const sim::Soil ground = soil("firm", 3e6, 32.0, 0.01).mean;
  const double true_slip = PlaneSlips(rover, 3.71, ground).at(0.0, 0.0);
  for (sim::WheelModel& wheel : rover.wheels) wheel.software_radius_m = 1.025 * wheel.radius_m;
  EXPECT_NEAR(1.0 - PlaneSlips(rover, 3.71, ground).at(0.0, 0.0), (1.0 - true_slip) / 1.025, 1e-3);
}

TEST(GroundChain, KeepsTheSharesOfTheGroundWhereNothingIsMeasured) {
  const GroundChain ground = chain();
  const std::vector<ChainStep> steps(50);
  const Eigen::ArrayXd shares = ground.grounds[0].shares;
  const ChainPass pass = follow(ground, steps, Eigen::ArrayXXd::Ones(2, 50), shares, {shares});
  for (Eigen::Index t = 0; t < 50; ++t) EXPECT_NEAR(pass.before(1, t), shares[1], 1e-12);
  EXPECT_NEAR(pass.smoothed.sum(), 50.0, 1e-9);
  EXPECT_NEAR(pass.smoothed(1, 25), shares[1], 1e-9);
  EXPECT_NEAR(pass.log_likelihood, 0.0, 1e-12);
}

TEST(GroundChain, AfterALooseStepTheNextIsLikelyLooseAndFarOnItIsAsBefore) {
  const GroundChain ground = chain();
  std::vector<ChainStep> steps(80);
  steps[20].slip = ground.predicted_slips(steps[20])[1];
  for (ChainStep& step : steps)
    if (step.slip == 0.0) step.slip = ground.predicted_slips(step)[0];
  StepForecaster forecaster(ground, StepLearning::kDrive);
  const SolForecast forecast = forecaster.next_sol(steps);
  EXPECT_LT(forecast.steps[20].over_0_2, 0.05);
  EXPECT_GT(forecast.steps[21].over_0_2, 10.0 * forecast.steps[20].over_0_2);
  EXPECT_LT(forecast.steps[79].over_0_2, 0.05);
}

// What is forecast of a step must not know the step, nor any later one.
TEST(StepForecaster, KnowsNothingOfWhatComes) {
  const GroundChain ground = chain();
  for (const StepLearning learning : {StepLearning::kNone, StepLearning::kSols, StepLearning::kDrive}) {
    std::vector<ChainStep> steps(30), others(30);
    for (std::size_t i = 15; i < 30; ++i) others[i].slip = 0.7;
    StepForecaster one(ground, learning), other(ground, learning);
    const SolForecast a = one.next_sol(steps), b = other.next_sol(others);
    for (std::size_t i = 0; i <= 15; ++i) {
      EXPECT_EQ(a.steps[i].slip_p50, b.steps[i].slip_p50);
      EXPECT_EQ(a.steps[i].over_0_4, b.steps[i].over_0_4);
    }
    if (learning == StepLearning::kDrive) continue;
    EXPECT_EQ(a.steps[29].over_0_4, b.steps[29].over_0_4);
  }
}

TEST(StepForecaster, LearnsFromSolsOnlyWhereItIsAskedTo) {
  const GroundChain ground = chain();
  std::vector<ChainStep> loose(40);
  for (ChainStep& step : loose) step.slip = ground.predicted_slips(step)[1];
  std::vector<double> before, after;
  for (const StepLearning learning : {StepLearning::kNone, StepLearning::kSols}) {
    StepForecaster forecaster(ground, learning);
    before.push_back(forecaster.next_sol(loose).steps[30].over_0_2);
    after.push_back(forecaster.next_sol(loose).steps[30].over_0_2);
  }
  EXPECT_EQ(before[0], after[0]);
  EXPECT_GT(after[1], 1.5 * before[1]);
}

// Ways drawn from the chain itself: the band holds as often as it says, and the probabilities come true.
TEST(StepScores, OfTheChainsOwnWaysAreCalibrated) {
  const GroundChain ground = chain();
  const Eigen::ArrayXd weights = ground.entry_weights(ground.grounds[0].shares);
  StepForecaster forecaster(ground, StepLearning::kNone);
  std::vector<ScoredSol> sols;
  for (std::uint64_t s = 0; s < 300; ++s) {
    ScoredSol sol{static_cast<int>(s), {}, {}};
    Eigen::Index here = random_uniform(s, 0) < ground.grounds[0].shares[1] ? 1 : 0;
    for (std::uint64_t t = 1; t <= 40; ++t) {
      if (random_uniform(s, 3 * t) < 1.0 - std::exp(-1.0 / ground.chord_m[here]))
        here = random_uniform(s, 3 * t + 1) < weights[1] ? 1 : 0;
      ChainStep step{.pitch_rad = rad_from_deg(-5.0 + 10.0 * random_uniform(random_key(s, 1), t))};
      const double slip = ground.predicted_slips(step)[here];
      // Student's t with four degrees of freedom, from five normal numbers.
      double squares = 0.0;
      for (std::uint64_t k = 1; k <= 4; ++k)
        squares += std::pow(random_normal(random_key(s, 2), 5 * t + k), 2);
      const double student = random_normal(random_key(s, 2), 5 * t) / std::sqrt(squares / 4.0);
      step.slip = slip + (ground.noise.least + ground.noise.share * std::abs(slip)) * student;
      sol.steps.push_back(step);
    }
    sol.forecast = forecaster.next_sol(sol.steps);
    sols.push_back(std::move(sol));
  }
  const StepScores scores = score(sols);
  EXPECT_EQ(scores.steps, 12000U);
  EXPECT_NEAR(scores.in_band.value, 0.9, 0.02);
  EXPECT_LT(scores.in_band.low, scores.in_band.value);
  EXPECT_NEAR(scores.step_over_0_2.expected / static_cast<double>(scores.step_over_0_2.above), 1.0, 0.25);
  EXPECT_NEAR(scores.sol_over_0_2.expected / static_cast<double>(scores.sol_over_0_2.above), 1.0, 0.25);
}

}  // namespace
}  // namespace slipway::steps
