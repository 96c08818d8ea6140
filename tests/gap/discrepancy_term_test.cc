#include "gap/diagnosis/search/discrepancy_term.h"

#include <gtest/gtest.h>

#include <cmath>

#include "gap/diagnosis/describe/unexplained.h"
#include "tests/gap/linear_model.h"

namespace slipway::gap {
namespace {

bool never() {
  return false;
}

// A fit that left so much in one row, with nothing re-tuned in it.
PosteriorMode fit_leaving(double residual) {
  PosteriorMode fit;
  fit.white_linear = Eigen::Vector3d(residual, 0.0, 0.0);
  fit.white_jacobian = Eigen::Vector3d(0.0, 0.0, 1.0);
  return fit;
}

// Of a term of one unit column a with coefficient N(0, s^2): log N(r; 0, 1 + s^2) - log N(r; 0, 1).
double gain_at(double residual, double size) {
  const double variance = 1.0 + size * size;
  return 0.5 * residual * residual * (1.0 - 1.0 / variance) - 0.5 * std::log(variance);
}

double mean_of(double residual, const std::vector<double>& sizes) {
  double sum = 0.0;
  for (const double size : sizes) sum += std::exp(gain_at(residual, size));
  return std::log(sum / static_cast<double>(sizes.size()));
}

const WhiteTerm kTerm{Eigen::Vector3d(1.0, 0.0, 0.0), {0}};
const Eigen::MatrixXd kNoForm(3, 0);

WhiteTerm all_may_be_single(Eigen::MatrixXd columns) {
  WhiteTerm term{std::move(columns), {}};
  for (Eigen::Index c = 0; c < term.columns.cols(); ++c) term.single.push_back(c);
  return term;
}

TEST(DiscrepancyGain, AveragesTheEvidenceOverTheSizes) {
  DiscrepancyOptions options;
  options.sizes = {0.5, 1.0, 4.0};
  options.imprecision = 0.2;
  options.imprecision_shares = {0.1, 0.5, 1.0};
  for (const double residual : {0.0, 2.0, 5.0}) {
    const DiscrepancyGain gain = discrepancy_gain(fit_leaving(residual), kTerm, kNoForm, options, never);
    EXPECT_NEAR(gain.imprecision, mean_of(residual, {0.02, 0.1, 0.2}), 1e-12) << residual;
    std::vector<double> single;
    for (const double share : {0.02, 0.1, 0.2})
      for (const double size : {0.5, 1.0, 4.0}) single.push_back(std::hypot(share, size));
    const double either =
        0.5 * std::exp(mean_of(residual, {0.5, 1.0, 4.0})) + 0.5 * std::exp(mean_of(residual, single));
    EXPECT_NEAR(gain.something_else, std::log(either), 1e-12) << residual;
  }
}

// One column of many that explains what is left is more probable than all of them at once.
TEST(DiscrepancyGain, FindsWhatEntersAtOnePoint) {
  constexpr Eigen::Index kRows = 400, kColumns = 100;
  PosteriorMode fit;
  fit.white_jacobian = testing::random_matrix(kRows, 1, 1000);
  const WhiteTerm term = all_may_be_single(testing::random_matrix(kRows, kColumns, 2000));
  fit.white_linear = testing::random_matrix(kRows, 1, 3000);
  const DiscrepancyGain none = discrepancy_gain(fit, term, Eigen::MatrixXd(kRows, 0), {}, never);
  EXPECT_LT(none.something_else, none.imprecision);
  fit.white_linear += 0.6 * term.columns.col(40);
  DiscrepancyOptions options;
  const DiscrepancyGain one = discrepancy_gain(fit, term, Eigen::MatrixXd(kRows, 0), options, never);
  EXPECT_GT(one.something_else, one.imprecision + 5.0);
  const DiscrepancyEstimate found = estimate_discrepancy(fit, term, options, never);
  Eigen::Index largest = 0;
  found.mean.cwiseAbs().maxCoeff(&largest);
  EXPECT_EQ(largest, 40);
  EXPECT_NEAR(found.mean[40], 0.6, 3.0 * found.error[40]);
  WhiteTerm throughout = term;
  throughout.single.erase(throughout.single.begin() + 40);
  EXPECT_LT(discrepancy_gain(fit, throughout, Eigen::MatrixXd(kRows, 0), options, never).something_else,
            one.something_else - 5.0)
      << "what is off throughout is not something else";
  options.single_share = 0.0;
  const DiscrepancyGain all = discrepancy_gain(fit, term, Eigen::MatrixXd(kRows, 0), options, never);
  EXPECT_LT(all.something_else, all.imprecision) << "all at once are too many for it";
}

// What one column more of the covariance does is found in closed form.
TEST(DiscrepancyGain, OfASingleColumnIsThatOfItsCovariance) {
  constexpr Eigen::Index kRows = 30;
  PosteriorMode fit;
  fit.white_jacobian = testing::random_matrix(kRows, 2, 1000);
  fit.white_linear = 2.0 * testing::random_matrix(kRows, 1, 3000);
  const WhiteTerm term = all_may_be_single(testing::random_matrix(kRows, 3, 2000));
  DiscrepancyOptions options;
  options.sizes = {0.7, 0.7, 0.7};
  options.imprecision_shares = {1.0, 1.0, 1.0};
  options.single_share = 1.0;
  const LinearProblem linear = linear_problem(fit);
  double sum = 0.0;
  for (Eigen::Index c = 0; c < term.columns.cols(); ++c) {
    Eigen::Vector3d size = Eigen::Vector3d::Constant(options.imprecision);
    size[c] = std::hypot(options.imprecision, 0.7);
    Eigen::MatrixXd columns(kRows, linear.columns.cols() + term.columns.cols());
    columns << linear.columns, term.columns * size.asDiagonal();
    sum +=
        std::exp(log_marginal(linear.residuals, columns) - log_marginal(linear.residuals, linear.columns)) /
        static_cast<double>(term.columns.cols());
  }
  const DiscrepancyGain gain = discrepancy_gain(fit, term, Eigen::MatrixXd(kRows, 0), options, never);
  EXPECT_NEAR(gain.something_else, std::log(sum), 1e-9);
}

TEST(DiscrepancyGain, IsALossWhereNothingIsMissingAndAGainWhereMuchIs) {
  EXPECT_LT(discrepancy_gain(fit_leaving(0.0), kTerm, kNoForm, {}, never).something_else, 0.0);
  const DiscrepancyGain much = discrepancy_gain(fit_leaving(8.0), kTerm, kNoForm, {}, never);
  EXPECT_GT(much.something_else, much.imprecision + 10.0);
  EXPECT_EQ(discrepancy_gain(fit_leaving(8.0), kTerm, kNoForm, {}, [] { return true; }).something_else, 0.0);
}

// An effect's form that explains the residual does so for every explanation with the effect: no discrepancy.
TEST(DiscrepancyGain, IsTakenUpByTheFormOfAnEffect) {
  DiscrepancyOptions options;
  options.form_sizes = {0.0, 1.0, 1.0};
  const Eigen::MatrixXd form = 4.0 * kTerm.columns;
  const DiscrepancyGain without = discrepancy_gain(fit_leaving(6.0), kTerm, kNoForm, options, never);
  const DiscrepancyGain with = discrepancy_gain(fit_leaving(6.0), kTerm, form, options, never);
  EXPECT_LT(with.something_else - with.imprecision, without.something_else - without.imprecision);
  EXPECT_GT(with.imprecision, without.imprecision);
}

TEST(ColumnsBeside, HaveTheTermAtItsMostProbableSize) {
  DiscrepancyOptions options;
  options.sizes = {0.5, 2.0, 30.0};
  // The evidence of one residual is largest at size^2 = r^2 - 1.
  const Eigen::MatrixXd columns =
      columns_beside(fit_leaving(std::sqrt(5.0)), kTerm, kNoForm, true, options, never);
  ASSERT_EQ(columns.cols(), 2);
  EXPECT_DOUBLE_EQ(columns(0, 1), 2.0);
  EXPECT_DOUBLE_EQ(columns(2, 0), 1.0) << "the fit's own come first";
  const Eigen::MatrixXd imprecise = columns_beside(fit_leaving(0.0), kTerm, kNoForm, false, options, never);
  EXPECT_DOUBLE_EQ(imprecise(0, 1), options.imprecision * options.imprecision_shares[0]);
}

TEST(EstimateDiscrepancy, IsThePosteriorOfACoefficient) {
  DiscrepancyOptions options;
  options.sizes = {2.0, 2.0, 2.0};
  options.imprecision = 0.0;
  const DiscrepancyEstimate found = estimate_discrepancy(fit_leaving(5.0), kTerm, options, never);
  ASSERT_EQ(found.mean.size(), 1);
  EXPECT_NEAR(found.mean[0], 4.0 / 5.0 * 5.0, 1e-12) << "s^2 / (1 + s^2) r";
  EXPECT_NEAR(found.error[0], std::sqrt(4.0 / 5.0), 1e-12);
}

TEST(ShapeOf, IsALineThroughTheMiddleOrAConstant) {
  const auto line = shape_of(Circumstance::kPitch, 2.0, 0.5);
  ASSERT_EQ(line.size(), 3U);
  EXPECT_DOUBLE_EQ(line[0].second.value, -2.0);
  EXPECT_DOUBLE_EQ(line[1].second.value, 0.0);
  EXPECT_DOUBLE_EQ(line[1].second.high, 0.0);
  EXPECT_NEAR(line[2].second.high, 2.0 + 1.6449 * 0.5, 1e-4);
  const auto constant = shape_of(Circumstance::kConstant, 2.0, 0.5);
  for (const auto& [at, value] : constant) EXPECT_DOUBLE_EQ(value.value, 2.0) << at;
}

TEST(DiscrepancyNames, AreThoseOfTheDocument) {
  EXPECT_EQ(name_of(Entry::kTangentialForce), "tangential_force");
  EXPECT_EQ(name_of(Entry::kPressureSinkage), "pressure_sinkage");
  EXPECT_EQ(name_of(Entry::kTorqueToCurrent), "torque_to_current");
  EXPECT_EQ(name_of(Entry::kSinkage), "sinkage");
  EXPECT_EQ(name_of(Circumstance::kConstant), "constant");
  EXPECT_EQ(name_of(Circumstance::kTemperature), "temperature");
  EXPECT_EQ(name_of(Circumstance::kOrder), "order");
}

}  // namespace
}  // namespace slipway::gap
