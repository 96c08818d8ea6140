#include "gap/diagnosis/search/reference_learning.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>
#include <utility>
#include <vector>

#include "tests/gap/linear_model.h"

namespace slipway::gap {
namespace {

using testing::LinearModel;
using testing::parameter;
using testing::random_matrix;
using testing::to_the_end;

// A model whose parameters were told before.
class ToldModel : public LinearModel {
 public:
  ToldModel(LinearModel model, Eigen::MatrixXd precision)
      : LinearModel(std::move(model)), precision_(std::move(precision)) {}
  Eigen::MatrixXd prior_precision() const override { return precision_; }

 private:
  Eigen::MatrixXd precision_;
};

// What a first half of the drives has told is all that they say: with it as the prior, the second half alone
// gives the posterior of both.
TEST(PriorPrecision, CarriesWhatAFirstHalfToldToTheSecond) {
  const Eigen::MatrixXd a = random_matrix(12, 3, 21);
  const Eigen::VectorXd y = random_matrix(12, 1, 31);
  const Eigen::VectorXd deviation = Eigen::VectorXd::Constant(6, 0.7);
  const std::vector<Parameter> unit(3, parameter(1.0));
  const PosteriorMode both = find_mode(LinearModel(a, y, Eigen::VectorXd::Constant(12, 0.7), unit),
                                       std::vector{0.0, 0.0, 0.0}, to_the_end());
  const PosteriorMode first = find_mode(LinearModel(a.topRows(6), y.head(6), deviation, unit),
                                        std::vector{0.0, 0.0, 0.0}, to_the_end());
  // Parameters are told around where the first half left them.
  std::vector<Parameter> told = unit;
  Eigen::VectorXd offset = Eigen::VectorXd::Zero(3);
  for (std::size_t p = 0; p < told.size(); ++p) {
    told[p].neutral = first.x[p];
    told[p].name = told[p].effect = "";
    offset[static_cast<Eigen::Index>(p)] = first.x[p];
  }
  const ToldModel second(LinearModel(a.bottomRows(6), y.tail(6), deviation, told),
                         first.covariance.inverse());
  const PosteriorMode after = find_mode(second, first.x, to_the_end());
  for (std::size_t p = 0; p < told.size(); ++p) EXPECT_NEAR(after.x[p], both.x[p], 1e-9);
  EXPECT_LT((after.covariance - both.covariance).norm(), 1e-9);
  // Its columns are of deviation 1: their marginal is that of the drives under the told prior.
  const Eigen::VectorXd r = (y.tail(6) - a.bottomRows(6) * offset) / 0.7;
  const Eigen::MatrixXd w = a.bottomRows(6) / 0.7;
  const Eigen::MatrixXd v = Eigen::MatrixXd::Identity(6, 6) + w * first.covariance * w.transpose();
  const Eigen::LLT<Eigen::MatrixXd> llt(v);
  const double expected = -0.5 * r.dot(llt.solve(r)) - llt.matrixLLT().diagonal().array().log().sum();
  EXPECT_NEAR(log_marginal(after.white_linear, after.white_jacobian), expected, 1e-9);
  EXPECT_NEAR(after.log_evidence, expected, 1e-9);
}

// Slip is left over by three units of its columns, the currents by none.
TEST(BelievedSizes, GiveADifferenceWhereThereIsOne) {
  const Eigen::MatrixXd columns = random_matrix(200, 12, 41);
  std::vector<std::size_t> groups(6, 0);
  groups.insert(groups.end(), 6, 1);
  const Eigen::MatrixXd known = random_matrix(200, 2, 51);
  Eigen::VectorXd coefficients = Eigen::VectorXd::Zero(12);
  coefficients.head(6) = 3.0 * random_matrix(6, 1, 61);
  const Eigen::VectorXd residuals = random_matrix(200, 1, 71) + columns * coefficients;
  const std::vector<double> sizes =
      believed_sizes(residuals, known, columns, groups, std::vector{0.03, 0.1, 0.3, 1.0, 3.0});
  EXPECT_GE(sizes[0], 1.0);
  EXPECT_LE(sizes[1], 0.15);
}

// Rows in which the columns are next to nothing say nothing of their size: the difference stays open there.
TEST(BelievedSizes, StayOpenWhereTheDrivesCouldNotHaveShownADifference) {
  const std::vector<double> sizes{0.03, 0.1, 0.3, 1.0, 3.0};
  const std::vector<std::size_t> groups(4, 0);
  const Eigen::MatrixXd known = random_matrix(200, 2, 52), columns = random_matrix(200, 4, 42);
  const Eigen::VectorXd residuals = random_matrix(200, 1, 72);
  const double shown = believed_sizes(residuals, known, columns, groups, sizes)[0];
  const double hidden = believed_sizes(residuals, known, 1e-4 * columns, groups, sizes)[0];
  EXPECT_LT(shown, 0.15);
  EXPECT_NEAR(hidden, std::sqrt((0.0009 + 0.01 + 0.09 + 1.0 + 9.0) / 6.0), 0.01) << "all alike";
}

}  // namespace
}  // namespace slipway::gap
