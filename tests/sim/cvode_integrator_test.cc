#include "sim/dynamic/cvode_integrator.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace slipway::sim {
namespace {

// Runs to t_end; returns y there.
std::vector<double> run_to(CvodeIntegrator& integrator, double t_end) {
  for (double t = 0.0; t < t_end;) {
    const auto step = integrator.step(t_end);
    if (!step) {
      ADD_FAILURE() << step.error().detail;
      break;
    }
    t = step->t;
  }
  return {integrator.state().begin(), integrator.state().end()};
}

StiffSystem robertson() {
  return {.size = 3, .derivative = [](double, const double* y, double* rate) {
            rate[0] = -0.04 * y[0] + 1e4 * y[1] * y[2];
            rate[2] = 3e7 * y[1] * y[1];
            rate[1] = -rate[0] - rate[2];
            return true;
          }};
}

// Kinetics over eleven decades of rates; values at t = 40 from the literature [Hairer & Wanner 1996].
TEST(CvodeIntegrator, SolvesRobertsonsStiffKinetics) {
  CvodeIntegrator integrator(robertson(), 1e-8, {1e-10, 1e-14, 1e-10}, 1e6);
  integrator.start(0.0, std::array{1.0, 0.0, 0.0});
  const std::vector<double> y = run_to(integrator, 40.0);
  EXPECT_NEAR(y[0], 0.7158270688, 1e-7);
  EXPECT_NEAR(y[1], 9.185534765e-6, 2e-12);
  EXPECT_NEAR(y[2], 0.2841637457, 1e-7);
  EXPECT_LT(integrator.work().steps, 1000);
}

TEST(CvodeIntegrator, RepeatsToTheBit) {
  std::vector<std::vector<double>> ends;
  for (int run = 0; run < 2; ++run) {
    CvodeIntegrator integrator(robertson(), 1e-5, {1e-8, 1e-12, 1e-8}, 1e6);
    integrator.start(0.0, std::array{1.0, 0.0, 0.0});
    ends.push_back(run_to(integrator, 40.0));
  }
  EXPECT_EQ(ends[0], ends[1]);
}

StiffSystem falling_ball() {
  return {.size = 2,
          .derivative =
              [](double, const double* y, double* rate) {
                rate[0] = y[1];
                rate[1] = -9.81;
                return true;
              },
          .event_count = 1,
          .events =
              [](double, const double* y, double* value) {
                value[0] = y[0];
                return true;
              }};
}

TEST(CvodeIntegrator, StopsWhereABallMeetsTheGround) {
  CvodeIntegrator integrator(falling_ball(), 1e-9, {1e-12, 1e-12}, 1.0);
  integrator.start(0.0, std::array{2.0, 0.0});
  CvodeIntegrator::Step step;
  do {
    step = integrator.step(10.0).value();
  } while (!step.event && step.t < 10.0);
  EXPECT_NEAR(step.t, std::sqrt(2.0 * 2.0 / 9.81), 1e-7);
  EXPECT_EQ(integrator.event_directions()[0], -1);
}

// CVODE itself gives up on an event that is 0 to the last bit for longer than rounding.
TEST(CvodeIntegrator, ContinuesPastAnEventThatStaysAtZero) {
  StiffSystem still = falling_ball();
  still.derivative = [](double t, const double*, double* rate) {
    rate[0] = t < 1.0 ? -1.0 : 0.0;
    rate[1] = 0.0;
    return true;
  };
  still.events = [](double, const double* y, double* value) {
    value[0] = std::max(0.0, y[0] - 0.5);
    return true;
  };
  CvodeIntegrator integrator(still, 1e-6, {1e-9, 1e-9}, 0.1);
  integrator.start(0.0, std::array{1.0, 0.0});
  EXPECT_NEAR(run_to(integrator, 2.0)[0], 0.0, 1e-4);
}

TEST(CvodeIntegrator, InterpolatesWithinItsLastStep) {
  CvodeIntegrator integrator(falling_ball(), 1e-9, {1e-12, 1e-12}, 0.1);
  integrator.start(0.0, std::array{100.0, 0.0});
  double t = 0.0;
  while (t < 1.0) t = integrator.step(5.0)->t;
  const double before = t;
  t = integrator.step(5.0)->t;
  std::array<double, 2> y{};
  integrator.interpolate(0.5 * (before + t), y);
  const double at = 0.5 * (before + t);
  EXPECT_NEAR(y[0], 100.0 - 0.5 * 9.81 * at * at, 1e-6);
}

TEST(CvodeIntegrator, GivesASentenceAsTheReasonWhereItGivesUp) {
  StiffSystem nowhere = falling_ball();
  nowhere.derivative = [](double, const double*, double*) { return false; };
  CvodeIntegrator integrator(nowhere, 1e-6, {1e-9, 1e-9}, 1.0);
  integrator.start(0.0, std::array{1.0, 0.0});
  const auto step = integrator.step(2.0);
  ASSERT_FALSE(step);
  EXPECT_EQ(step.error().code, ErrorCode::kNotConverged);
  EXPECT_NE(step.error().detail.find("left what the model knows"), std::string::npos) << step.error().detail;
}

TEST(CvodeIntegrator, LetsNoExceptionPassThroughTheLibrary) {
  StiffSystem throwing = falling_ball();
  throwing.derivative = [](double, const double*, double*) -> bool { throw std::runtime_error("no"); };
  CvodeIntegrator integrator(throwing, 1e-6, {1e-9, 1e-9}, 1.0);
  integrator.start(0.0, std::array{1.0, 0.0});
  EXPECT_FALSE(integrator.step(1.0));
}

}  // namespace
}  // namespace slipway::sim
