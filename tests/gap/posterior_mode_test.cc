#include "gap/diagnosis/search/posterior_mode.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>

#include "tests/gap/linear_model.h"

namespace slipway::gap {
namespace {

using testing::LinearModel;
using testing::parameter;
using testing::random_matrix;
using testing::to_the_end;

TEST(HuberLoss, IsASquareAtTheCentreAndALineBeyondTheThreshold) {
  const HuberLoss loss{2.0};
  EXPECT_DOUBLE_EQ(loss(1.5), 1.125);
  EXPECT_DOUBLE_EQ(loss(-2.0), 2.0);
  EXPECT_DOUBLE_EQ(loss(5.0), 8.0) << "2 (5 - 1)";
  EXPECT_DOUBLE_EQ(loss.weight(1.9), 1.0);
  EXPECT_DOUBLE_EQ(loss.weight(-8.0), 0.25);
  // The weighted row has the loss's slope.
  constexpr double kStep = 1e-6;
  for (const double r : {-7.0, -1.0, 0.5, 3.0})
    EXPECT_NEAR(loss.weight(r) * r, (loss(r + kStep) - loss(r - kStep)) / (2.0 * kStep), 1e-8) << r;
}

TEST(NegativeLogPosterior, AddsThePriorAndTheLossOfFittedRows) {
  const Eigen::Vector3d white(1.0, -3.0, 10.0);
  const Eigen::Vector2d u(2.0, 1.0);
  const HuberLoss loss{2.0};
  EXPECT_DOUBLE_EQ(negative_log_posterior(white, u, loss, {}), 2.5 + 0.5 + 4.0 + 18.0);
  EXPECT_DOUBLE_EQ(negative_log_posterior(white, u, loss, {true, true, false}), 2.5 + 0.5 + 4.0);
  EXPECT_EQ(loss_weights(white, loss, {true, false, true}), Eigen::Vector3d(1.0, 0.0, 0.2));
}

TEST(NormalEquations, AreThoseOfRidgeRegression) {
  const Eigen::MatrixXd a = random_matrix(7, 3, 11);
  const Eigen::VectorXd weights = random_matrix(7, 1, 5).cwiseAbs();
  const NormalEquations equations = normal_equations(a, weights);
  const Eigen::MatrixXd expected = a.transpose() * weights.asDiagonal() * a + Eigen::MatrixXd::Identity(3, 3);
  EXPECT_LT((equations.hessian - expected).norm(), 1e-12);
  EXPECT_LT((equations.covariance - expected.inverse()).norm(), 1e-12);
}

TEST(BoundedStep, IsNewtonsWhereNoBoundIsReached) {
  const Eigen::Matrix2d h{{2.0, 1.0}, {1.0, 3.0}};
  const Eigen::Vector2d g(1.0, 2.0), far(10.0, 10.0);
  const Eigen::VectorXd step = bounded_step(h, g, -far, far);
  EXPECT_NEAR(step[0], 0.2, 1e-14);
  EXPECT_NEAR(step[1], 0.6, 1e-14);
}

// With one parameter at its bound, the other's best step is that of the quadratic restricted to it.
TEST(BoundedStep, HoldsWhatWouldCrossItsBoundAndSolvesForTheRest) {
  const Eigen::Matrix2d h{{2.0, 1.0}, {1.0, 3.0}};
  const Eigen::Vector2d g(1.0, 2.0), low(-10.0, -10.0), high(10.0, 0.3);
  const Eigen::VectorXd step = bounded_step(h, g, low, high);
  EXPECT_DOUBLE_EQ(step[1], 0.3);
  EXPECT_NEAR(step[0], (1.0 - 1.0 * 0.3) / 2.0, 1e-14);
}

// The second crosses only once the first is held.
TEST(BoundedStep, FindsBoundsOneAfterTheOther) {
  const Eigen::Matrix2d h{{1.0, 0.9}, {0.9, 1.0}};
  const Eigen::Vector2d g(1.0, 0.9), low(-10.0, -10.0), high(0.5, 0.2);
  const Eigen::VectorXd step = bounded_step(h, g, low, high);
  EXPECT_DOUBLE_EQ(step[0], 0.5);
  EXPECT_DOUBLE_EQ(step[1], 0.2) << "free, it would be 0.9 - 0.9 * 0.5";
}

// What a held parameter would explain beyond its bound stays in the residuals, for an effect to explain.
TEST(LinearProblem, LeavesHeldParametersWhereTheyAre) {
  const Eigen::MatrixXd a = random_matrix(9, 2, 3);
  const Eigen::VectorXd y = a * Eigen::Vector2d(5.0, 0.3), deviation = Eigen::VectorXd::Ones(9);
  const LinearModel model(a, y, deviation, {parameter(1.0, -2.0, 2.0), parameter(1.0, -2.0, 2.0)});
  const PosteriorMode mode = find_mode(model, std::vector{0.0, 0.0}, to_the_end());
  ASSERT_DOUBLE_EQ(mode.x[0], 2.0);
  const LinearProblem problem = linear_problem(mode);
  EXPECT_TRUE(problem.columns.col(0).isZero(0.0));
  EXPECT_EQ(problem.columns.col(1), mode.white_jacobian.col(1));
  EXPECT_LT((problem.residuals - (y - 2.0 * a.col(0))).norm(), 1e-9);
  const LinearProblem unwhitened = unwhitened_problem(mode, model.parameters());
  EXPECT_TRUE(unwhitened.columns.col(0).isZero(0.0));
  EXPECT_LT((unwhitened.residuals - problem.residuals).norm(), 1e-9) << "of deviation 1 they are the same";
}

// Where a step ends is rounded.
TEST(LinearProblem, HoldsWhatIsAtItsBoundButForRounding) {
  const Eigen::MatrixXd a = random_matrix(9, 1, 3);
  const Eigen::VectorXd y = 5.0 * a, deviation = Eigen::VectorXd::Ones(9);
  const LinearModel model(a, y, deviation, {parameter(0.15, 0.1, 0.7)});
  FitOptions not_moved = to_the_end();
  not_moved.max_iterations = 0;
  EXPECT_EQ(find_mode(model, std::vector{std::nextafter(0.7, 0.0)}, not_moved).held.size(), 1U);
  EXPECT_TRUE(find_mode(model, std::vector{0.69}, not_moved).held.empty());
}

TEST(LinearProblem, FreesWhatIsAtItsBoundButDrawnInwards) {
  const Eigen::MatrixXd a = random_matrix(9, 1, 3);
  const Eigen::VectorXd y = 1.0 * a, deviation = Eigen::VectorXd::Ones(9);
  const LinearModel model(a, y, deviation, {parameter(1.0, -2.0, 2.0)});
  FitOptions not_moved = to_the_end();
  not_moved.max_iterations = 0;
  const PosteriorMode mode = find_mode(model, std::vector{2.0}, not_moved);
  EXPECT_TRUE(mode.held.empty());
  EXPECT_LT((linear_problem(mode).residuals - y).norm(), 1e-9) << "its part is put back";
}

TEST(BoundedStep, StaysWhereEverythingIsAtItsBound) {
  const Eigen::Matrix2d h = Eigen::Matrix2d::Identity();
  const Eigen::VectorXd step =
      bounded_step(h, Eigen::Vector2d(3.0, -3.0), Eigen::Vector2d(-1.0, 0.0), Eigen::Vector2d(0.0, 1.0));
  EXPECT_EQ(step, Eigen::Vector2d(0.0, 0.0));
}

TEST(ShortenedStep, IsHalvedUntilTheCostFalls) {
  const auto never = [] { return false; };
  const auto answers = [] { return true; };
  // (s - 0.2)^2 from s = 0: full and half steps are worse.
  const auto cost_at = [](double share) { return (share - 0.2) * (share - 0.2); };
  EXPECT_EQ(shortened_step(0.04, cost_at, answers, never), 0.25);
  EXPECT_EQ(shortened_step(2.0, cost_at, answers, never), 1.0);
  EXPECT_EQ(shortened_step(0.0, cost_at, answers, never), std::nullopt) << "no share is better";
  EXPECT_EQ(shortened_step(2.0, cost_at, answers, [] { return true; }), std::nullopt);
}

TEST(ShortenedStep, IsHalvedUntilTheModelAnswersAndTakenInFullWhereItDoesNot) {
  const auto never = [] { return false; };
  double tried = 0.0;
  const auto cost_at = [&](double share) {
    tried = share;
    return 1.0 - share;
  };
  EXPECT_EQ(shortened_step(
                1.0, cost_at, [&] { return tried < 0.3; }, never),
            0.25);
  EXPECT_EQ(shortened_step(
                1.0, cost_at, [] { return false; }, never),
            1.0);
  EXPECT_EQ(tried, 1.0) << "the cost was asked for last where the step ends";
}

// y = A x + e with x ~ N(0, S), e ~ N(0, V): the posterior is normal, and the evidence N(y; 0, V + A S A^T).
TEST(FindMode, OfALinearGaussianModelHasItsPosteriorAndItsEvidence) {
  constexpr Eigen::Index kRows = 12;
  const Eigen::MatrixXd a = random_matrix(kRows, 3, 21);
  const Eigen::VectorXd y = 3.0 * random_matrix(kRows, 1, 31),
                        v = random_matrix(kRows, 1, 41).cwiseAbs().array() + 0.3;
  const std::vector<Parameter> parameters{parameter(0.5), parameter(2.0), parameter(1.0)};
  const Eigen::Vector3d prior(0.25, 4.0, 1.0);  // variances
  const PosteriorMode mode =
      find_mode(LinearModel(a, y, v, parameters), std::vector<double>{0.4, -1.0, 2.0}, to_the_end());

  const Eigen::MatrixXd noise = v.cwiseAbs2().asDiagonal();
  const Eigen::MatrixXd precision =
      a.transpose() * noise.inverse() * a + Eigen::MatrixXd(prior.cwiseInverse().asDiagonal());
  const Eigen::MatrixXd covariance = precision.inverse();
  const Eigen::VectorXd mean = covariance * a.transpose() * noise.inverse() * y;
  for (Eigen::Index p = 0; p < 3; ++p) {
    EXPECT_NEAR(mode.x[static_cast<std::size_t>(p)], mean[p], 1e-9);
    for (Eigen::Index q = 0; q < 3; ++q)
      EXPECT_NEAR(mode.covariance(p, q) * std::sqrt(prior[p] * prior[q]), covariance(p, q), 1e-12);
  }
  // Up to (2 pi)^(-n/2) |V|^(-1/2), which all explanations share.
  const Eigen::MatrixXd marginal = noise + a * prior.asDiagonal() * a.transpose();
  const double expected =
      -0.5 * y.dot(marginal.inverse() * y) - 0.5 * std::log(marginal.determinant() / noise.determinant());
  EXPECT_NEAR(mode.log_evidence, expected, 1e-9);
  EXPECT_TRUE(mode.converged);
  EXPECT_LT((mode.residuals - (y - a * mean)).norm(), 1e-8);
  // What the screening of further columns starts from: residuals at the neutral parameters.
  EXPECT_LT((mode.white_linear - y.cwiseQuotient(v)).norm(), 1e-8);
}

// One parameter of prior deviation 1, observed as 0, 0 and 10 with deviation 1. Beyond the threshold 1 the
// third pulls with 1: 3 u = 1.
TEST(FindMode, WeighsDownAnOutlierAsHubersLossDoes) {
  FitOptions options = to_the_end();
  options.huber = 1.0;
  const LinearModel model(Eigen::MatrixXd::Ones(3, 1), Eigen::Vector3d(0.0, 0.0, 10.0),
                          Eigen::Vector3d::Ones(), {parameter(1.0)});
  const PosteriorMode mode = find_mode(model, std::vector<double>{0.0}, options);
  EXPECT_NEAR(mode.x[0], 1.0 / 3.0, 1e-5);
  EXPECT_NEAR(mode.row_weights[2] * mode.row_weights[2], 1.0 / (10.0 - mode.x[0]), 1e-12);
  // Without the outlier's row nothing pulls.
  const PosteriorMode without = find_mode(model, std::vector<double>{0.0}, options, {true, true, false});
  EXPECT_EQ(without.x[0], 0.0);
  EXPECT_EQ(without.white_jacobian(2, 0), 0.0);
}

TEST(FindMode, StopsAtABoundWithTheOthersAtTheirBest) {
  const Eigen::MatrixXd a{{1.0, 0.5}, {0.0, 1.0}, {1.0, 1.0}};
  const Eigen::Vector3d y(3.0, 1.0, 4.0);
  const LinearModel model(a, y, Eigen::Vector3d::Ones(), {parameter(1.0, 0.0, 0.4), parameter(1.0)});
  const PosteriorMode mode = find_mode(model, std::vector<double>{0.0, 0.0}, to_the_end());
  EXPECT_DOUBLE_EQ(mode.x[0], 0.4);
  const Eigen::VectorXd left = y - 0.4 * a.col(0);
  EXPECT_NEAR(mode.x[1], a.col(1).dot(left) / (1.0 + a.col(1).squaredNorm()), 1e-9);
  EXPECT_TRUE(mode.converged);
}

// Without an answer for its second and third observation; in the window of the third the rover stood too.
class Stuck : public LinearModel {
 public:
  using LinearModel::LinearModel;
  std::vector<double> predict(std::span<const double> x) const override {
    std::vector<double> f = LinearModel::predict(x);
    f[1] = f[2] = std::numeric_limits<double>::quiet_NaN();
    return f;
  }
  bool stood(Eigen::Index row) const override { return row == 2; }
};

TEST(FindMode, TakesAnObservationWithoutAnAnswerForOneThatIsFarOffUnlessTheRoverStoodToo) {
  FitOptions options;
  options.no_answer = 3.0;
  options.both_stuck = 1.0;
  const PosteriorMode mode = find_mode(Stuck(Eigen::MatrixXd::Zero(3, 1), Eigen::Vector3d(0.0, 7.0, 7.0),
                                             Eigen::Vector3d(1.0, 0.5, 0.25), {parameter(1.0)}),
                                       std::vector<double>{0.0}, options);
  EXPECT_DOUBLE_EQ(mode.residuals[1], 3.0 * 0.5);
  EXPECT_DOUBLE_EQ(mode.residuals[2], 1.0 * 0.25);
  EXPECT_DOUBLE_EQ(mode.log_evidence, -0.5 * (3.0 * 3.0 + 1.0));
}

// Beyond x = 0.5 the model says of its second observation that the rover would stand.
class Slope : public LinearModel {
 public:
  explicit Slope(double measured)
      : LinearModel(Eigen::Vector2d(1.0, 0.0), Eigen::Vector2d(measured, 0.0), Eigen::Vector2d(0.1, 1.0),
                    {parameter(1.0)}) {}
  std::vector<double> predict(std::span<const double> x) const override {
    std::vector<double> f = LinearModel::predict(x);
    if (x[0] > 0.5) f[1] = std::numeric_limits<double>::quiet_NaN();
    return f;
  }
};

TEST(FindMode, DoesNotStepWhereTheRoverWouldStandUnlessNothingElseIsBetter) {
  const PosteriorMode mode = find_mode(Slope(0.7), std::vector<double>{0.0}, {});
  EXPECT_EQ(mode.unanswered, 0) << "a step to 0.69 would lower the cost, and leave it above that at 0.5";
  EXPECT_NEAR(mode.x[0], 0.5, 0.05);
  const PosteriorMode over = find_mode(Slope(2.0), std::vector<double>{0.0}, {});
  EXPECT_EQ(over.unanswered, 1);
  EXPECT_NEAR(over.x[0], 2.0, 0.05);
}

// f = x^3, of which 0 is measured: a Gauss-Newton step takes a third of x away.
class Cube : public LinearModel {
 public:
  Cube()
      : LinearModel(Eigen::MatrixXd::Ones(1, 1), Eigen::VectorXd::Zero(1), Eigen::VectorXd::Ones(1),
                    {parameter(1e6)}) {}
  std::vector<double> predict(std::span<const double> x) const override { return {x[0] * x[0] * x[0]}; }
  Eigen::MatrixXd scaled_jacobian(std::span<const double> x, std::span<const double>) const override {
    return Eigen::MatrixXd::Constant(1, 1, 1e6 * 3.0 * x[0] * x[0]);
  }
};

TEST(FindMode, GivesUpWhatWouldNotReachTheEvidenceAskedForAtThePaceOfItsLastTwoSteps) {
  FitOptions options;
  options.huber = 1e9;
  options.max_iterations = 12;
  const std::vector<double> start{3.0};
  const auto found = [&](double must_reach) { return find_mode(Cube(), start, options, {}, must_reach); };
  const PosteriorMode to_its_end = found(kAnyEvidence);
  EXPECT_TRUE(to_its_end.converged);
  EXPECT_EQ(found(to_its_end.log_evidence - 1.0).x, to_its_end.x);
  // Newton's first step goes to 2, from where derivatives follow the steps: secants. The cost falls from
  // 3^6 / 2 by 332, 24 and 6, and there are twelve steps at most.
  const auto secant = [](double from, double to) {
    return to - std::pow(to, 3) * (from - to) / (std::pow(from, 3) - std::pow(to, 3));
  };
  const double third = secant(3.0, 2.0), fourth = secant(2.0, third);
  const PosteriorMode given_up = found(4000.0);
  EXPECT_FALSE(given_up.converged);
  EXPECT_NEAR(given_up.x[0], third, 1e-6);
  EXPECT_NEAR(found(3000.0).x[0], fourth, 1e-6) << "10 times 332 might have done";
  EXPECT_LT(given_up.log_evidence, to_its_end.log_evidence);
}

// Derivatives that are known where the search begins, or near it, lead to the same mode.
TEST(FindMode, BeginsFromKnownDerivatives) {
  FitOptions options;
  options.huber = 1e9;
  const std::vector<double> start{3.0}, near{2.5};
  const PosteriorMode anew = find_mode(Cube(), start, options);
  const Eigen::VectorXd residuals = Eigen::VectorXd::Constant(1, -std::pow(2.5, 3));
  const Eigen::MatrixXd jacobian = Eigen::MatrixXd::Constant(1, 1, 1e6 * 3.0 * 2.5 * 2.5);
  const PosteriorMode known = find_mode(Cube(), {start, near, residuals, jacobian}, options);
  EXPECT_TRUE(known.converged);
  EXPECT_NEAR(known.x[0], anew.x[0], 0.2) << "a flat minimum";
  EXPECT_NEAR(known.log_evidence, anew.log_evidence, 1.0);
  EXPECT_TRUE(find_mode(Cube(), ModeStart::at(anew), options).central);
}

// A prior of one side only holds its probability on half the room.
TEST(LaplaceEvidence, OfAOneSidedPriorIsTwiceAsDense) {
  const Eigen::MatrixXd covariance = Eigen::Matrix2d{{0.25, 0.0}, {0.0, 0.04}};
  const std::vector<Parameter> two_sided{parameter(1.0), parameter(1.0)};
  const std::vector<Parameter> one_sided{parameter(1.0), parameter(1.0, 0.0)};
  const double expected = -3.0 + std::log(0.5 * 0.2);
  EXPECT_NEAR(laplace_log_evidence(3.0, covariance, two_sided), expected, 1e-12);
  EXPECT_NEAR(laplace_log_evidence(3.0, covariance, one_sided), expected + std::log(2.0), 1e-12);
  std::vector<Parameter> nuisance = one_sided;
  nuisance[1].effect.clear();
  EXPECT_NEAR(laplace_log_evidence(3.0, covariance, nuisance), expected, 1e-12) << "in every explanation";
}

}  // namespace
}  // namespace slipway::gap
