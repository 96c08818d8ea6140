#include "gap/estimate/parameter_sweep.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <set>

namespace slipway::gap {
namespace {

// Case 0 wants a = 3.3, case 1 wants b = 200, case 2 both.
std::optional<double> bowl(std::size_t number, std::span<const double> x) {
  const double a = x[0] - 3.3, b = std::log10(x[1] / 200.0);
  return number == 0 ? std::abs(a) : number == 1 ? std::abs(b) : std::hypot(a, b);
}

const std::vector<double> kOne{1.0}, kThree{1.0, 1.0, 1.0};
const std::vector<SweptParameter> kBowl{
    {.name = "a", .lowest = 0.0, .highest = 10.0, .coarse = 6, .fine = 9},
    {.name = "b", .lowest = 1.0, .highest = 1e4, .coarse = 5, .fine = 5, .logarithmic = true}};

TEST(ParameterSweep, TheFineGridLiesBetweenTheNeighboursOfTheCoarseBest) {
  NoProgress progress;
  const auto sweep = sweep_coarse_then_fine(kBowl, kThree, bowl, 2, progress);
  ASSERT_TRUE(sweep) << sweep.error().detail;
  EXPECT_EQ(sweep->coarse.axes[0], (std::vector<double>{0, 2, 4, 6, 8, 10}));
  EXPECT_EQ(sweep->points[sweep->best_coarse].x, (std::vector<double>{4.0, 100.0}));
  EXPECT_DOUBLE_EQ(sweep->fine.axes[0].front(), 2.0);
  EXPECT_DOUBLE_EQ(sweep->fine.axes[0].back(), 6.0);
  EXPECT_DOUBLE_EQ(sweep->fine.axes[1].front(), 10.0);
  EXPECT_DOUBLE_EQ(sweep->fine.axes[1].back(), 1000.0);
  const SweepPoint& best = sweep->points[sweep->best];
  EXPECT_DOUBLE_EQ(best.x[0], 3.5);
  EXPECT_NEAR(best.x[1], std::pow(10.0, 2.5), 1e-9 * best.x[1]);
  const double a = 0.2, b = 2.5 - std::log10(200.0);
  EXPECT_NEAR(*best.score, std::sqrt((a * a + b * b + a * a + b * b) / 3.0), 1e-12);
  EXPECT_LE(*best.score, *sweep->points[sweep->best_coarse].score);
}

TEST(ParameterSweep, APointOfBothGridsIsTriedOnce) {
  std::atomic<int> calls{0};
  const ScoreOfCase counted = [&](std::size_t number, std::span<const double> x) {
    ++calls;
    return bowl(number, x);
  };
  NoProgress progress;
  const auto sweep = sweep_coarse_then_fine(kBowl, kThree, counted, 2, progress);
  ASSERT_TRUE(sweep);
  std::set<std::vector<double>> different;
  for (const SweepPoint& point : sweep->points) different.insert(point.x);
  EXPECT_EQ(different.size(), sweep->points.size());
  EXPECT_EQ(sweep->points.size(), 30U + 45U - 9U);
  EXPECT_EQ(calls, 3 * 66);
  EXPECT_EQ(sweep->fine.points.size(), 45U);
}

TEST(ParameterSweep, ThreadsDoNotChangeTheResult) {
  NoProgress progress;
  const auto one = sweep_coarse_then_fine(kBowl, kThree, bowl, 1, progress);
  const auto four = sweep_coarse_then_fine(kBowl, kThree, bowl, 4, progress);
  ASSERT_TRUE(one && four);
  ASSERT_EQ(one->points.size(), four->points.size());
  for (std::size_t i = 0; i < one->points.size(); ++i) {
    EXPECT_EQ(one->points[i].x, four->points[i].x);
    EXPECT_EQ(one->points[i].cases, four->points[i].cases);
    EXPECT_EQ(one->points[i].score, four->points[i].score);
  }
  EXPECT_EQ(one->best, four->best);
}

TEST(ParameterSweep, ABestAtTheEndOfARangeIsRefinedTowardsTheInside) {
  NoProgress progress;
  const std::vector<SweptParameter> one{{.name = "a", .lowest = 4.0, .highest = 8.0, .coarse = 5, .fine = 3}};
  const ScoreOfCase away = [](std::size_t, std::span<const double> x) { return std::abs(x[0] - 1.0); };
  const auto sweep = sweep_coarse_then_fine(one, kOne, away, 1, progress);
  ASSERT_TRUE(sweep);
  EXPECT_EQ(sweep->fine.axes[0], (std::vector<double>{4.0, 4.5, 5.0}));
  EXPECT_EQ(sweep->best, sweep->best_coarse);
}

TEST(ParameterSweep, APointWithoutAnAnswerInACaseIsNotTheBest) {
  NoProgress progress;
  const ScoreOfCase hole = [](std::size_t number, std::span<const double> x) -> std::optional<double> {
    if (number == 1 && x[0] < 5.0) return std::nullopt;
    return bowl(number, x);
  };
  const auto sweep = sweep_coarse_then_fine(kBowl, kThree, hole, 2, progress);
  ASSERT_TRUE(sweep);
  EXPECT_EQ(sweep->points[sweep->best].x[0], 5.0);
  EXPECT_FALSE(sweep->points[0].score);
  const std::size_t answered[] = {0, 2};
  EXPECT_TRUE(score_over(sweep->points[0], answered, kThree));
  const ScoreOfCase none = [](std::size_t, std::span<const double>) { return std::optional<double>(); };
  const auto nothing = sweep_coarse_then_fine(kBowl, kThree, none, 2, progress);
  ASSERT_FALSE(nothing);
  EXPECT_EQ(nothing.error().code, ErrorCode::kNotConverged);
}

TEST(ParameterSweep, TheSurfaceOverTwoOfThreeIsTheBestThatTheThirdAllows) {
  NoProgress progress;
  const std::vector<SweptParameter> three{
      {.name = "a", .lowest = 0.0, .highest = 4.0, .coarse = 5, .fine = 2},
      {.name = "b", .lowest = 0.0, .highest = 2.0, .coarse = 3, .fine = 2},
      {.name = "c", .lowest = 0.0, .highest = 4.0, .coarse = 5, .fine = 2}};
  const ScoreOfCase valley = [](std::size_t, std::span<const double> x) {
    return std::abs(x[0] - x[2]) + std::abs(x[1] - 1.0);
  };
  const auto sweep = sweep_coarse_then_fine(three, kOne, valley, 1, progress);
  ASSERT_TRUE(sweep);
  const ScoreSurface surface = score_surface(*sweep, sweep->coarse, 0, 1);
  ASSERT_EQ(surface.scores.size(), 15U);
  for (std::size_t j = 0; j < 3; ++j)
    for (std::size_t i = 0; i < 5; ++i)
      EXPECT_DOUBLE_EQ(*surface.scores[5 * j + i], std::abs(static_cast<double>(j) - 1.0));
  const ScoreSurface curve = score_surface(*sweep, sweep->coarse, 1, 1);
  EXPECT_EQ(curve.scores.size(), 3U);
  EXPECT_TRUE(curve.y_values.empty());
  EXPECT_DOUBLE_EQ(*curve.scores[2], 1.0);
}

TEST(ParameterSweep, ACaseCountsAsMuchAsItsWeight) {
  const SweepPoint point{.x = {}, .cases = {3.0, 1.0, 5.0}, .score = {}};
  const std::size_t first_two[] = {0, 1};
  EXPECT_DOUBLE_EQ(*score_over(point, first_two, std::vector{1.0, 3.0, 9.0}), std::sqrt((9.0 + 3.0) / 4.0));
}

TEST(ParameterSweep, RefusesWhatCanNotBeSwept) {
  NoProgress progress;
  const auto refused = [&](std::vector<SweptParameter> parameters, const char* pointer) {
    const auto sweep = sweep_coarse_then_fine(parameters, kThree, bowl, 1, progress);
    ASSERT_FALSE(sweep);
    EXPECT_EQ(sweep.error().code, ErrorCode::kInvalidRequest);
    ASSERT_FALSE(sweep.error().faults.empty());
    EXPECT_EQ(sweep.error().faults[0].pointer, pointer);
  };
  refused({}, "/parameters");
  refused({{.name = "a", .lowest = 2.0, .highest = 1.0}}, "/parameters/0/lowest");
  refused({{.name = "a", .lowest = 0.0, .highest = 1.0, .logarithmic = true}}, "/parameters/0/lowest");
  refused({{.name = "a", .coarse = 1}}, "/parameters/0/coarse");
  refused({{.name = "a"}, {.name = "a"}}, "/parameters/1/name");
  refused({{.name = "a", .coarse = 2000}, {.name = "b", .coarse = 2000}}, "/parameters");
}

TEST(ParameterSweep, CanBeGivenUp) {
  class Never final : public Progress {
    void report(std::string_view, double) override {}
    bool cancelled() const override { return true; }
  } never;
  const auto sweep = sweep_coarse_then_fine(kBowl, kThree, bowl, 2, never);
  ASSERT_FALSE(sweep);
  EXPECT_EQ(sweep.error().code, ErrorCode::kCancelled);
}

}  // namespace
}  // namespace slipway::gap
