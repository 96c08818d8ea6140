#include "gap/diagnosis/follow/change_detector.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <numeric>

#include "core/random.h"
#include "tests/gap/linear_model.h"

namespace slipway::gap {
namespace {

using testing::random_matrix;

constexpr Eigen::Index kDriveRows = 6, kRetuned = 3;
const std::vector<ChangeKind> kMadeKinds{{0, 1, 0.5}, {1, 2, 0.5}};
constexpr Eigen::Index kChangeColumns = 3;

struct ChangedDrive {
  Eigen::VectorXd residuals;
  Eigen::MatrixXd known, changes;
};

// A drive whose residuals are what was re-tuned, noise, and from some drive on a change in the first column.
ChangedDrive changed_drive(std::uint64_t seed, int number, const Eigen::VectorXd& u, double change) {
  const std::uint64_t key = random_key(seed, static_cast<std::uint64_t>(number));
  ChangedDrive made{random_matrix(kDriveRows, 1, random_key(key, 1)),
                    random_matrix(kDriveRows, kRetuned, random_key(key, 2)),
                    random_matrix(kDriveRows, kChangeColumns, random_key(key, 3))};
  made.residuals += made.known * u + change * made.changes.col(0);
  return made;
}

// The first drive of an alarm, from 0; -1 without one.
int first_alarm(std::uint64_t seed, int drives, int changed_at, double change, const ChangeOptions& options) {
  ChangeDetector detector(options, kMadeKinds);
  const Eigen::VectorXd u = random_matrix(kRetuned, 1, random_key(seed, 999));
  for (int d = 0; d < drives; ++d) {
    const ChangedDrive made = changed_drive(seed, d, u, d >= changed_at ? change : 0.0);
    detector.add(made.residuals, made.known, made.changes);
    if (detector.alarmed()) return d;
  }
  return -1;
}

TEST(StartWeight, AddsUpToOneAtMost) {
  double sum = 0.0;
  for (std::size_t c = 1; c <= 100'000; ++c) sum += start_weight(c);
  EXPECT_GT(sum, 0.9);
  EXPECT_LT(sum, 1.0);
}

// An odd drive was confirmed by its own repeat.
TEST(ChangeDetector, IsNotConfirmedByARepeatOfTheSameDrive) {
  const Eigen::VectorXd u = Eigen::VectorXd::Zero(kRetuned);
  for (const bool repeats : {false, true}) {
    ChangeDetector detector({}, kMadeKinds);
    int alarm = -1;
    for (int d = 0; d < 6 && alarm < 0; ++d) {
      const ChangedDrive made = changed_drive(5, d, u, 20.0);
      detector.add(made.residuals, made.known, made.changes, repeats && d < 5 && d > 0);
      if (detector.alarmed()) alarm = d;
    }
    EXPECT_EQ(alarm, repeats ? 5 : 1);
  }
}

// Drives off the map had no column of any kind, and the watch died of it.
TEST(ChangeDetector, HasNoEvidenceWhereNothingCouldShow) {
  ChangeDetector detector({}, {});
  for (int d = 0; d < 3; ++d) {
    const ChangedDrive made = changed_drive(1, d, Eigen::VectorXd::Zero(kRetuned), 3.0);
    EXPECT_EQ(detector.add(made.residuals, made.known, Eigen::MatrixXd(kDriveRows, 0)), 0.0);
  }
  EXPECT_FALSE(detector.alarmed());
  EXPECT_TRUE(detector.kind_shares().empty());
  EXPECT_EQ(detector.start_shares(), std::vector<double>(3, 0.0));
}

// Against likelihoods with every covariance written out.
TEST(ChangeDetector, IsTheMixtureOfLikelihoodRatios) {
  const ChangeOptions options{.alpha = 0.01, .share = 1.0, .sizes = {0.5, 2.0}};
  ChangeDetector detector(options, kMadeKinds);
  const Eigen::VectorXd u = random_matrix(kRetuned, 1, 3);
  const int drives = 3;
  Eigen::VectorXd r(drives * kDriveRows);
  Eigen::MatrixXd x(r.size(), kRetuned), z(r.size(), kChangeColumns);
  for (int d = 0; d < drives; ++d) {
    const ChangedDrive made = changed_drive(5, d, u, d >= 1 ? 1.5 : 0.0);
    detector.add(made.residuals, made.known, made.changes);
    r.segment(d * kDriveRows, kDriveRows) = made.residuals;
    x.middleRows(d * kDriveRows, kDriveRows) = made.known;
    z.middleRows(d * kDriveRows, kDriveRows) = made.changes;
  }
  const auto log_density = [&](const Eigen::MatrixXd& covariance) {
    const Eigen::LLT<Eigen::MatrixXd> llt(covariance);
    return -0.5 * r.dot(llt.solve(r)) - llt.matrixLLT().diagonal().array().log().sum();
  };
  const Eigen::MatrixXd healthy = Eigen::MatrixXd::Identity(r.size(), r.size()) + x * x.transpose();
  double expected = 1.0;
  for (int c = 0; c < drives; ++c) {
    const double weight = start_weight(static_cast<std::size_t>(c) + 1);
    expected -= weight;
    for (const ChangeKind& kind : kMadeKinds)
      for (const double size : options.sizes) {
        Eigen::MatrixXd since = z.middleCols(kind.first, kind.count);
        since.topRows(c * kDriveRows).setZero();
        expected +=
            weight * kind.prior / 2.0 *
            std::exp(log_density(healthy + size * size * since * since.transpose()) - log_density(healthy));
      }
  }
  EXPECT_NEAR(detector.log_evidence(), std::log(expected), 1e-9);
}

// Ville: in 400 sequences of 60 drives in which nothing changes alarms are no more than alpha allows (20
// expected at most; 31 is the binomial's 99 % quantile).
TEST(ChangeDetector, RaisesNoMoreAlarmsThanItStates) {
  const ChangeOptions options{.confirmed_by = 1, .alpha = 0.05, .share = 1.0};
  int alarms = 0;
  for (std::uint64_t seed = 0; seed < 400; ++seed)
    alarms += first_alarm(1000 + seed, 60, 60, 0.0, options) >= 0 ? 1 : 0;
  EXPECT_LE(alarms, 31);
}

TEST(ChangeDetector, FindsAChangeSoonAndSaysSinceWhenAndWhich) {
  const ChangeOptions options{.alpha = 0.01, .share = 1.0};
  ChangeDetector detector(options, kMadeKinds);
  const Eigen::VectorXd u = random_matrix(kRetuned, 1, 4);
  int at = 0;
  while (at < 40 && !detector.alarmed()) {
    const ChangedDrive made = changed_drive(8, at, u, at >= 20 ? 2.0 : 0.0);
    detector.add(made.residuals, made.known, made.changes);
    ++at;
  }
  EXPECT_GE(at, 22);
  EXPECT_LE(at, 26);
  EXPECT_NEAR(static_cast<double>(detector.most_probable_start()), 20.0, 1.0);
  EXPECT_GT(detector.kind_shares()[0], 0.8);
  // Every drive's share, and the range of the onset around the true one.
  const std::vector<double>& shares = detector.start_shares();
  ASSERT_EQ(shares.size(), static_cast<std::size_t>(at));
  EXPECT_NEAR(std::accumulate(shares.begin(), shares.end(), 0.0), 1.0, 1e-9);
  const DriveRange onset = fewest_with(shares, 0.9);
  EXPECT_GE(onset.share, 0.9);
  EXPECT_LE(onset.first, 20U);
  EXPECT_GE(onset.last, 20U);
  EXPECT_LE(onset.last - onset.first, 4U);
}

// The onset is told as one drive only where one drive has the evidence.
TEST(FewestWith, IsTheShortestRangeThatHoldsThePartAndTheMostProbableDrive) {
  const auto expect = [](const std::vector<double>& shares, std::size_t first, std::size_t last) {
    const DriveRange range = fewest_with(shares, 0.9);
    EXPECT_EQ(range.first, first);
    EXPECT_EQ(range.last, last);
  };
  expect({0.0, 0.95, 0.05}, 1, 1);
  expect({0.04, 0.1, 0.52, 0.3, 0.04}, 1, 3);
  expect({0.3, 0.3, 0.4}, 0, 2);
  expect({0.05, 0.4, 0.0, 0.0, 0.55}, 1, 4);
  expect({0.04, 0.47, 0.44, 0.05}, 1, 2);
  EXPECT_EQ(fewest_with(std::vector<double>{}, 0.9).share, 0.0);
}

// One odd drive is no change: the alarm waits until the evidence stands at as many drives running as asked
// for.
TEST(ChangeDetector, WaitsUntilAChangeIsConfirmed) {
  const int first = first_alarm(8, 40, 12, 3.0, {.confirmed_by = 1, .alpha = 0.01, .share = 1.0});
  const int second = first_alarm(8, 40, 12, 3.0, {.confirmed_by = 2, .alpha = 0.01, .share = 1.0});
  EXPECT_GE(first, 12);
  EXPECT_EQ(second, first + 1);
}

}  // namespace
}  // namespace slipway::gap
