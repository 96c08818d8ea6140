#include "planner/problem/cost_catalogue.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "core/random.h"
#include "planner/problem/weights.h"
#include "planner/search/profile.h"

namespace slipway::planner {
namespace {

constexpr std::array kFigures{
    &DriveFigures::length_m,       &DriveFigures::turned_rad,    &DriveFigures::duration_s,
    &DriveFigures::energy_j,       &DriveFigures::slip_length_m, &DriveFigures::unknown_length_m,
    &DriveFigures::expected_stops, &DriveFigures::embedding,     &DriveFigures::risk};

DriveFigures some_figures(std::uint64_t key) {
  DriveFigures figures;
  for (std::size_t k = 0; k < kFigures.size(); ++k) figures.*kFigures[k] = 100.0 * random_uniform(key, k);
  return figures;
}

DriveFigures sum_of(const DriveFigures& a, const DriveFigures& b) {
  DriveFigures sum;
  for (const auto figure : kFigures) sum.*figure = a.*figure + b.*figure;
  return sum;
}

TEST(CostCatalogue, EveryTermOfADriveIsTheSumOfItsStretches) {
  for (const CostTerm& term : cost_catalogue()) {
    const DriveFigures a = some_figures(1), b = some_figures(2);
    EXPECT_EQ(term.value({}), 0.0) << term.name;
    EXPECT_NEAR(term.value(sum_of(a, b)), term.value(a) + term.value(b), 1e-9) << term.name;
  }
}

TEST(DriveFigures, OfADrawTakeWhatItDoesNotComeToFromTheMeanSoils) {
  sim::DrivePrediction mean;
  mean.length_m = 100.0;
  mean.duration_s = 4000.0;
  mean.energy_j = 8e4;
  mean.mean_slip_ratio = 0.1;
  mean.unknown_length_m = 30.0;
  const sim::DrawFigures half{.driven_m = 50.0,
                              .duration_s = 3000.0,
                              .energy_j = 5e4,
                              .slip_length_m = 10.0,
                              .stops = 2,
                              .embedded = true,
                              .breaks_a_limit = true};
  const DriveFigures figures = figures_of(mean, half);
  EXPECT_DOUBLE_EQ(figures.duration_s, 5000.0);
  EXPECT_DOUBLE_EQ(figures.energy_j, 9e4);
  EXPECT_DOUBLE_EQ(figures.slip_length_m, 15.0);
  EXPECT_EQ(figures.unknown_length_m, 30.0);
  EXPECT_EQ(figures.expected_stops, 2.0);
  EXPECT_EQ(figures.embedding, 1.0);
  EXPECT_EQ(figures.risk, 1.0);
}

TEST(Weights, AreTheCataloguesUntilTheyAreSetAndAddUpByRow) {
  Weights weights;
  ASSERT_EQ(weights.terms().size(), cost_catalogue().size());
  const DriveFigures figures = some_figures(3);
  double sum = 0.0;
  for (const CostTerm& term : cost_catalogue()) {
    EXPECT_EQ(weights.of(term.name), term.weight.initial);
    sum += term.weight.initial * term.value(figures);
  }
  EXPECT_NEAR(weights.cost(figures), sum, 1e-9);
  weights.set("slip", 7.0);
  weights.set("no_such_term", 9.0);
  EXPECT_EQ(weights.of("slip"), 7.0);
  EXPECT_EQ(weights.of("no_such_term"), 0.0);
  EXPECT_NEAR(weights.cost(figures) - sum, 3.0 * figures.slip_length_m / 100.0, 1e-9);
}

TEST(Profiles, NameTermsOfTheCatalogueAndKeepTheWeightsThatTheyDoNotName) {
  Weights asked;
  for (std::size_t row = 0; row < asked.terms().size(); ++row) asked[row] = 2.0 + static_cast<double>(row);
  for (const Profile& profile : profiles({.by = RankBy::kCvar})) {
    const Weights weights = profile.weights(asked);
    for (std::size_t row = 0; row < asked.terms().size(); ++row) {
      double expected = asked[row];
      for (const ProfileWeight& changed : profile.changed)
        if (changed.term == asked.terms()[row].name)
          expected = std::clamp(changed.share_of_asked * asked[row], changed.min, changed.max);
      EXPECT_EQ(weights[row], expected) << profile.name << " " << asked.terms()[row].name;
    }
    for (const ProfileWeight& changed : profile.changed)
      EXPECT_NE(asked.of(changed.term), 0.0) << changed.term;
  }
}

TEST(Profiles, NeverTurnARequestsOwnPreferenceRound) {
  const auto ratio = [](const Weights& weights, std::string_view first) {
    return weights.of(first) / weights.of("duration");
  };
  Weights asked;
  asked.set("slip", 400.0);
  for (const char* term : {"stops", "embedding", "risk"}) asked.set(term, 900.0);
  const auto of = [&](std::string_view name) {
    const auto rows = profiles();
    return std::find_if(rows.begin(), rows.end(), [&](const Profile& p) { return p.name == name; })
        ->weights(asked);
  };
  EXPECT_GE(ratio(of("least_slip"), "slip"), ratio(asked, "slip"));
  for (const char* term : {"stops", "embedding", "risk"})
    EXPECT_GE(ratio(of("least_risk"), term), ratio(asked, term)) << term;
  asked.set("duration", 500.0);
  EXPECT_LE(ratio(of("shortest"), "slip"), ratio(asked, "slip"));
}

}  // namespace
}  // namespace slipway::planner
