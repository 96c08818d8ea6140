#include "gap/diagnosis/held_out/effect_marginals.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "gap/diagnosis/held_out/linear_held_out.h"
#include "gap/diagnosis/held_out/search_record_of.h"
#include "tests/gap/linear_model.h"
#include "tests/sim/reference_models.h"

namespace slipway::gap {
namespace {

using testing::LinearModel;
using testing::parameter;
using testing::random_matrix;

// Of a linear model the folds' fits are exact: each fold fitted anew gives the same.
TEST(LinearHeldOutRms, IsThatOfFoldsFittedAnew) {
  constexpr Eigen::Index kRows = 40;
  constexpr int kFolds = 4;
  const Eigen::MatrixXd a = random_matrix(kRows, 2, 5);
  const Eigen::VectorXd y = a * Eigen::Vector2d(0.7, -1.1) + 0.3 * random_matrix(kRows, 1, 9);
  const Eigen::VectorXd deviation = Eigen::VectorXd::Constant(kRows, 0.3);
  const LinearModel model(a, y, deviation, {parameter(2.0), parameter(0.5)});
  const std::vector<double> start{0.0, 0.0};
  const PosteriorMode all = find_mode(model, start, testing::to_the_end());
  FoldedRows rows{{}, std::vector<bool>(kRows, true), deviation};
  for (Eigen::Index i = 0; i < kRows; ++i) rows.fold.push_back(static_cast<int>(i / 3) % kFolds);
  double squares = 0.0;
  for (int f = 0; f < kFolds; ++f) {
    std::vector<bool> learnt;
    for (const int of : rows.fold) learnt.push_back(of != f);
    const PosteriorMode anew = find_mode(model, start, testing::to_the_end(), learnt);
    for (Eigen::Index i = 0; i < kRows; ++i)
      if (!learnt[static_cast<std::size_t>(i)]) squares += std::pow(anew.residuals[i] / 0.3, 2);
  }
  EXPECT_NEAR(linear_held_out_rms(all, model.parameters(), {}, {}, rows, kFolds), std::sqrt(squares / kRows),
              1e-6);

  // A column beside a fit does as one in it.
  const LinearModel first(a.leftCols(1), y, deviation, {parameter(2.0)});
  const PosteriorMode alone = find_mode(first, std::vector<double>{0.0}, testing::to_the_end());
  const Eigen::MatrixXd more = 0.5 * a.rightCols(1);
  EXPECT_NEAR(linear_held_out_rms(alone, first.parameters(), more, more / 0.3, rows, kFolds),
              linear_held_out_rms(all, model.parameters(), {}, {}, rows, kFolds), 1e-6);
}

// One window of a nearly stuck rover, far off whatever explains the others, must not decide what is closed.
TEST(LinearHeldOutRms, ByTheFitsLossIsNotThatOfOneWildRow) {
  constexpr Eigen::Index kRows = 400;
  const Eigen::MatrixXd a = random_matrix(kRows, 1, 5);
  Eigen::VectorXd y = 3.0 * a + 0.3 * random_matrix(kRows, 1, 9);
  y[7] += 90.0;
  const Eigen::VectorXd deviation = Eigen::VectorXd::Constant(kRows, 0.3);
  FoldedRows rows{{}, std::vector<bool>(kRows, true), deviation};
  for (Eigen::Index i = 0; i < kRows; ++i) rows.fold.push_back(static_cast<int>(i) % 4);
  const LinearModel with(a, y, deviation, {parameter(5.0)}), without(0.0 * a, y, deviation, {parameter(5.0)});
  const std::vector<double> start{0.0};
  const PosteriorMode told = find_mode(with, start, testing::to_the_end()),
                      nothing = find_mode(without, start, testing::to_the_end());
  const auto closed = [&] {
    const double left = linear_held_out_rms(told, with.parameters(), {}, {}, rows, 4);
    return 1.0 - left / linear_held_out_rms(nothing, without.parameters(), {}, {}, rows, 4);
  };
  EXPECT_LT(closed(), 0.15) << "by squares";
  rows.loss = HuberLoss{4.0};
  EXPECT_GT(closed(), 0.4) << "by the loss";
}

Candidate candidate(std::vector<std::string> effects, std::size_t fit, double probability) {
  Candidate c;
  c.effects = std::move(effects);
  c.fit = fit;
  c.probability = probability;
  return c;
}

// Fits are told apart by their evidence, which here is their rms.
ExplanationSearch search_with(std::vector<double> rms) {
  DriveCampaign campaign;
  campaign.rover = std::make_shared<sim::RoverModel>(sim::six_wheeler());
  campaign.soils.resize(1);
  ExplanationSearch search;
  for (const double r : rms) {
    search.fits.push_back({{}, Hypothesis(campaign, {})});
    search.fits.back().x = search.fits.back().hypothesis.neutral();
    search.fits.back().log_evidence = r;
  }
  return search;
}
double rms_of(const FittedExplanation& fit, const Eigen::MatrixXd& more) {
  return more.cols() == 0 ? fit.log_evidence : 2.5;
}

TEST(ClosedShares, OfAPairAddUpToWhatThePairCloses) {
  // Nothing 3, a alone 2, b alone 2.6, both 1.2; the floor is 1.
  ExplanationSearch search = search_with({3.0, 2.0, 2.6, 1.2});
  search.candidates = {candidate({"a", "b"}, 3, 0.7), candidate({"a"}, 1, 0.2), candidate({"b"}, 2, 0.06),
                       candidate({}, 0, 0.04)};
  ScreenedVariant weak;
  weak.variant.effect = "c";
  weak.columns = Eigen::MatrixXd::Zero(1, 1);
  search.screened.push_back(weak);
  const ClosedShares shares(&rms_of, search);
  EXPECT_NEAR(shares.of("a"), 0.5 * (1.0 + 1.4) / 2.0, 1e-12);
  EXPECT_NEAR(shares.of("b"), 0.5 * (0.4 + 0.8) / 2.0, 1e-12);
  EXPECT_NEAR(shares.of("a") + shares.of("b"), 1.8 / 2.0, 1e-12);
  EXPECT_NEAR(shares.of("c"), 0.25, 1e-12) << "by its derivatives";
  EXPECT_EQ(shares.of("d"), 0.0) << "not looked for";

  const std::vector<std::string> library{"c", "b", "a"};
  const std::vector<EffectMarginal> marginals = effect_marginals(record_of(search, shares, library));
  ASSERT_EQ(marginals.size(), 3U) << "every effect of the library";
  EXPECT_EQ(marginals[0].name, "a");
  EXPECT_NEAR(marginals[0].probability, 0.9, 1e-12);
  EXPECT_NEAR(marginals[1].probability, 0.76, 1e-12);
  EXPECT_EQ(marginals[2].probability, 0.0);
}

TEST(ClosedShares, AreNoneWhereRetuningLeftNoGap) {
  ExplanationSearch search = search_with({0.98, 0.99});
  search.candidates = {candidate({}, 0, 0.9), candidate({"a"}, 1, 0.1)};
  EXPECT_EQ(ClosedShares(&rms_of, search).of("a"), 0.0);
}

}  // namespace
}  // namespace slipway::gap
