#include "gap/estimate/least_squares.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "core/random.h"

namespace slipway::gap {
namespace {

constexpr LeastSquaresOptions kUnknownNoise{.residual_std_known = false};

Unknown unknown(const char* name, double start, double step_scale) {
  return {.name = name, .start = start, .step_scale = step_scale, .prior = {}};
}

struct Point {
  double y, x;
};

// NIST Statistical Reference Datasets, nonlinear regression, Misra1a (lower level of difficulty).
constexpr std::array kMisra1a{
    Point{10.07, 77.6},  Point{14.73, 114.9}, Point{17.94, 141.1}, Point{23.93, 190.8}, Point{29.61, 239.9},
    Point{35.18, 289.0}, Point{40.02, 332.8}, Point{44.82, 378.4}, Point{50.76, 434.8}, Point{55.05, 477.3},
    Point{61.01, 536.8}, Point{66.40, 593.1}, Point{75.47, 689.1}, Point{81.78, 760.0}};
// MGH09 (higher level of difficulty).
constexpr std::array kMgh09{Point{0.1957, 4.0},    Point{0.1947, 2.0},   Point{0.1735, 1.0},
                            Point{0.1600, 0.5},    Point{0.0844, 0.25},  Point{0.0627, 0.167},
                            Point{0.0456, 0.125},  Point{0.0342, 0.1},   Point{0.0323, 0.0833},
                            Point{0.0235, 0.0714}, Point{0.0246, 0.0625}};

// Estimates, standard errors and the residual sum of squares agree with the certified ones.
void expect_certified(const LeastSquaresFit& fit, const std::vector<double>& estimate,
                      const std::vector<double>& standard_error, double sum_of_squares) {
  EXPECT_TRUE(fit.converged) << fit.message;
  EXPECT_TRUE(fit.undetermined.empty());
  for (std::size_t k = 0; k < estimate.size(); ++k) {
    EXPECT_NEAR(fit.estimate[k] / estimate[k], 1.0, 2e-6) << k;
    ASSERT_TRUE(fit.standard_error(k)) << k;
    EXPECT_NEAR(*fit.standard_error(k) / standard_error[k], 1.0, 1e-5) << k;
  }
  EXPECT_NEAR(2.0 * fit.cost / sum_of_squares, 1.0, 1e-8);
}

TEST(LeastSquares, ReachesTheCertifiedAnswerOfMisra1aFromBothStarts) {
  const ResidualFunction model = [](std::span<const double> b, std::span<double> r) {
    for (std::size_t i = 0; i < kMisra1a.size(); ++i)
      r[i] = b[0] * (1.0 - std::exp(-b[1] * kMisra1a[i].x)) - kMisra1a[i].y;
    return true;
  };
  for (const auto& [b1, b2] : {std::pair{500.0, 1e-4}, std::pair{250.0, 5e-4}}) {
    NoProgress progress;
    const std::vector<Unknown> unknowns{unknown("b1", b1, 100.0), unknown("b2", b2, 1e-4)};
    const auto fit = fit_least_squares(unknowns, kMisra1a.size(), model, kUnknownNoise, progress);
    ASSERT_TRUE(fit) << fit.error().detail;
    expect_certified(*fit, {2.3894212918e+02, 5.5015643181e-04}, {2.7070075241e+00, 7.2668688436e-06},
                     1.2455138894e-01);
  }
}

TEST(LeastSquares, ReachesTheCertifiedAnswerOfMgh09FromBothStarts) {
  const ResidualFunction model = [](std::span<const double> b, std::span<double> r) {
    for (std::size_t i = 0; i < kMgh09.size(); ++i) {
      const double x = kMgh09[i].x;
      r[i] = b[0] * (x * x + x * b[1]) / (x * x + x * b[2] + b[3]) - kMgh09[i].y;
    }
    return true;
  };
  for (const double far : {100.0, 1.0}) {
    NoProgress progress;
    const std::vector<Unknown> unknowns{unknown("b1", 0.25 * far, 0.1), unknown("b2", 0.39 * far, 0.1),
                                        unknown("b3", 0.415 * far, 0.1), unknown("b4", 0.39 * far, 0.1)};
    const auto fit = fit_least_squares(unknowns, kMgh09.size(), model, kUnknownNoise, progress);
    ASSERT_TRUE(fit) << fit.error().detail;
    expect_certified(*fit, {1.9280693458e-01, 1.9128232873e-01, 1.2305650693e-01, 1.3606233068e-01},
                     {1.1435312227e-02, 1.9633220911e-01, 8.0842031232e-02, 9.0025542308e-02},
                     3.0750560385e-04);
  }
}

// Residuals that know a + b and c, but not a - b.
bool sum_and_one(std::span<const double> x, std::span<double> r) {
  for (std::size_t i = 0; i < 6; ++i) {
    const double t = static_cast<double>(i);
    r[i] = (x[0] + x[1]) * t + x[2] - (3.0 * t + 1.0);
  }
  return true;
}

TEST(LeastSquares, NamesTheDirectionThatTheDataDoNotDetermine) {
  NoProgress progress;
  const std::vector<Unknown> unknowns{unknown("a", 0.5, 10.0), unknown("b", 0.5, 10.0),
                                      unknown("c", 0.0, 10.0)};
  const auto fit = fit_least_squares(unknowns, 6, sum_and_one, {}, progress);
  ASSERT_TRUE(fit) << fit.error().detail;
  EXPECT_NEAR(fit->estimate[0] + fit->estimate[1], 3.0, 1e-8);
  ASSERT_EQ(fit->undetermined.size(), 1U);
  EXPECT_EQ(fit->undetermined[0].words.find(" c"), std::string::npos) << fit->undetermined[0].words;
  EXPECT_NEAR(std::abs(fit->undetermined[0].components[0]), std::sqrt(0.5), 1e-6);
  EXPECT_NEAR(fit->undetermined[0].components[0], -fit->undetermined[0].components[1], 1e-6);
  EXPECT_FALSE(fit->standard_error(0));
  EXPECT_FALSE(fit->standard_error(1));
  ASSERT_TRUE(fit->standard_error(2));
  EXPECT_GT(*fit->standard_error(2), 0.1);
}

TEST(LeastSquares, APriorDeterminesWhatTheDataDoNot) {
  NoProgress progress;
  std::vector<Unknown> unknowns{unknown("a", 0.5, 10.0), unknown("b", 0.5, 10.0), unknown("c", 0.0, 10.0)};
  unknowns[0].prior = Prior{1.0, 0.25};
  const auto fit = fit_least_squares(unknowns, 6, sum_and_one, {}, progress);
  ASSERT_TRUE(fit) << fit.error().detail;
  EXPECT_TRUE(fit->undetermined.empty());
  EXPECT_NEAR(fit->estimate[0], 1.0, 1e-6);
  EXPECT_NEAR(fit->estimate[1], 2.0, 1e-6);
  // The data fit exactly whatever a is: its posterior is its prior.
  EXPECT_NEAR(fit->standard_error(0).value(), 0.25, 1e-6);
  EXPECT_EQ(fit->residuals.size(), 6U);
}

TEST(LeastSquares, ABoundHoldsAndIsReported) {
  NoProgress progress;
  std::vector<Unknown> unknowns{unknown("slope", 0.5, 1.0), unknown("offset", 0.0, 1.0)};
  unknowns[0].lowest = 0.0;
  unknowns[0].highest = 2.0;
  double largest_asked = 0.0;
  const ResidualFunction line = [&](std::span<const double> x, std::span<double> r) {
    largest_asked = std::max(largest_asked, x[0]);
    for (std::size_t i = 0; i < 5; ++i)
      r[i] = x[0] * static_cast<double>(i) + x[1] - 3.0 * static_cast<double>(i);
    return true;
  };
  const auto fit = fit_least_squares(unknowns, 5, line, {}, progress);
  ASSERT_TRUE(fit) << fit.error().detail;
  EXPECT_DOUBLE_EQ(fit->estimate[0], 2.0);
  EXPECT_NEAR(fit->estimate[1], 2.0, 1e-8);  // the mean of what the slope leaves over
  EXPECT_TRUE(fit->on_bound[0]);
  EXPECT_FALSE(fit->on_bound[1]);
  EXPECT_LE(largest_asked, 2.0);  // the model is never asked beyond it
}

// A line y = 2 t + 1 with small noise and one reading that is far off.
bool line_with_outlier(std::span<const double> x, std::span<double> r) {
  for (std::size_t i = 0; i < 20; ++i) {
    const double t = 0.1 * static_cast<double>(i);
    const double y = 2.0 * t + 1.0 + 0.01 * random_normal(5, i) + (i == 17 ? 30.0 : 0.0);
    r[i] = (x[0] * t + x[1] - y) / 0.01;
  }
  return true;
}

TEST(LeastSquares, ARobustLossIsNotDrawnByAnOutlier) {
  const std::vector<Unknown> unknowns{unknown("slope", 1.0, 1.0), unknown("offset", 0.0, 1.0)};
  const auto slope_error = [&](RobustLoss loss) {
    NoProgress progress;
    const auto fit = fit_least_squares(unknowns, 20, line_with_outlier, {.loss = loss}, progress);
    EXPECT_TRUE(fit && fit->converged);
    return std::abs(fit->estimate[0] - 2.0);
  };
  EXPECT_GT(slope_error(RobustLoss::kNone), 1.0);
  EXPECT_LT(slope_error(RobustLoss::kHuber), 0.03);
  EXPECT_LT(slope_error(RobustLoss::kCauchy), 0.02);
}

TEST(LeastSquares, SeveralStartsFindTheLowerOfTwoValleys) {
  // Cost with a shallow minimum near 3 and the deep one at -2.
  const ResidualFunction valleys = [](std::span<const double> x, std::span<double> r) {
    r[0] = (x[0] - 3.0) * (x[0] + 2.0);
    r[1] = 0.3 * (x[0] + 2.0);
    return true;
  };
  std::vector<Unknown> unknowns{unknown("x", 3.5, 1.0)};
  unknowns[0].lowest = -5.0;
  unknowns[0].highest = 5.0;
  NoProgress progress;
  const auto one = fit_least_squares(unknowns, 2, valleys, {}, progress);
  const auto several = fit_least_squares(unknowns, 2, valleys, {.starts = 8}, progress);
  const auto again = fit_least_squares(unknowns, 2, valleys, {.starts = 8}, progress);
  ASSERT_TRUE(one && several && again);
  EXPECT_GT(one->estimate[0], 2.0);
  EXPECT_NEAR(several->estimate[0], -2.0, 1e-6);
  EXPECT_EQ(several->estimate[0], again->estimate[0]);
}

TEST(LeastSquares, AModelWithoutAnAnswerThereIsSteppedAround) {
  // sqrt(x) = 0.1 from a start whose full step leads below zero.
  const ResidualFunction root = [](std::span<const double> x, std::span<double> r) {
    if (x[0] < 0.0) return false;
    r[0] = std::sqrt(x[0]) - 0.1;
    return true;
  };
  NoProgress progress;
  const std::vector<Unknown> unknowns{unknown("x", 4.0, 0.1)};
  const auto fit = fit_least_squares(unknowns, 1, root, {}, progress);
  ASSERT_TRUE(fit) << fit.error().detail;
  EXPECT_NEAR(fit->estimate[0], 0.01, 1e-6);

  const ResidualFunction never = [](std::span<const double>, std::span<double>) { return false; };
  const auto none = fit_least_squares(unknowns, 1, never, {}, progress);
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().code, ErrorCode::kNotConverged);
}

TEST(LeastSquares, EveryFaultOfTheQuestionIsNamed) {
  std::vector<Unknown> unknowns{unknown("a", 5.0, 0.0), unknown("b", 0.0, 1.0)};
  unknowns[0].highest = 4.0;
  unknowns[1].prior = Prior{0.0, -1.0};
  NoProgress progress;
  const auto fit = fit_least_squares(unknowns, 6, sum_and_one, {.starts = 0}, progress);
  ASSERT_FALSE(fit);
  EXPECT_EQ(fit.error().code, ErrorCode::kInvalidRequest);
  std::vector<std::string> pointers;
  for (const Fault& fault : fit.error().faults) pointers.push_back(fault.pointer);
  EXPECT_EQ(pointers, (std::vector<std::string>{"/unknowns/0/step_scale", "/unknowns/0/start",
                                                "/unknowns/1/prior/std", "/options/starts"}));
}

class GivenUp final : public Progress {
 public:
  void report(std::string_view /*stage*/, double /*fraction*/) override {}
  bool cancelled() const override { return ++asked_ > 10; }

 private:
  mutable int asked_ = 0;
};

TEST(LeastSquares, IsGivenUpWhenNobodyWantsItAnyMore) {
  GivenUp progress;
  const std::vector<Unknown> unknowns{unknown("a", 0.5, 1.0), unknown("b", 0.5, 1.0), unknown("c", 0.0, 1.0)};
  const auto fit = fit_least_squares(unknowns, 6, sum_and_one, {.starts = 1000}, progress);
  ASSERT_FALSE(fit);
  EXPECT_EQ(fit.error().code, ErrorCode::kCancelled);
}

}  // namespace
}  // namespace slipway::gap
