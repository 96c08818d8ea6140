#include "sim/quasi_static/rover_balance.h"

#include <gtest/gtest.h>

#include "core/angle.h"
#include "sim/rover/suspension.h"
#include "tests/sim/reference_models.h"

namespace slipway::sim {
namespace {

constexpr double kMars = 3.71;

Soil with_memory() {
  Soil soil = sandy_loam();
  soil.multipass_stiffening = 1.5;
  soil.multipass_strengthening = 0.2;
  soil.bulldozing = 1.0;
  soil.track_bulldozing = 0.2;
  return soil;
}

// Near the balance of a rover that slides aside as it climbs across a slope, where every share in a track
// changes with the motion.
RoverBalance::Vector sliding(const RoverBalance& balance) {
  RoverBalance::Vector x = RoverBalance::Vector::Constant(3 + balance.wheel_count(), 0.45);
  x.head<3>() << 0.9, 0.08, 0.015;
  return x;
}

// On a rocker-bogie, whose loads are determined, and on four rigid wheels, whose depths must fit each other.
class TracksInTheBalance : public ::testing::TestWithParam<bool> {
 protected:
  TracksInTheBalance()
      : rover_(GetParam() ? four_wheeler(SuspensionType::kRigid) : six_wheeler()),
        stance_(stance_on_plane(rover_, {.roll_rad = rad_from_deg(8.0), .pitch_rad = rad_from_deg(-6.0)})),
        balance_(rover_, kMars, stance_, PerWheel<Soil>(rover_.wheels.size(), with_memory()),
                 {.speed_m_s = 0.04}) {}

  // Largest difference between the Jacobian and central differences of the residual, of the columns of the
  // motion.
  double worst_slope(const RoverBalance::Vector& x) {
    constexpr double kStep = 1e-5;
    balance_.residual(x);
    const RoverBalance::Matrix jacobian = balance_.jacobian(x);
    double worst = 0.0;
    for (Eigen::Index motion = 0; motion < RoverBalance::kMotions; ++motion) {
      RoverBalance::Vector ahead = x, behind = x;
      ahead[motion] += kStep;
      behind[motion] -= kStep;
      const RoverBalance::Vector there = balance_.residual(ahead);
      const RoverBalance::Vector slope = (there - balance_.residual(behind)) / (2.0 * kStep);
      worst = std::max(worst, (jacobian.col(motion) - slope).cwiseAbs().maxCoeff());
    }
    return worst;
  }

  RoverModel rover_;
  Stance stance_;
  RoverBalance balance_;
};

TEST_P(TracksInTheBalance, TheJacobianHasWhatTheMotionChangesOfTheShares) {
  const RoverBalance::Vector x = sliding(balance_);
  EXPECT_LT(worst_slope(x), 2e-3);
  balance_.residual(x);
  const RoverBalance::Matrix following = balance_.jacobian(x);
  balance_.hold_tracks(x, 1.0);
  balance_.residual(x);
  EXPECT_GT((following - balance_.jacobian(x)).leftCols<RoverBalance::kMotions>().cwiseAbs().maxCoeff(), 0.05)
      << "which is much";
}

TEST_P(TracksInTheBalance, HeldSharesDoNotFollowTheMotionUntilTheyAreReleased) {
  const RoverBalance::Vector x = sliding(balance_);
  RoverBalance::Vector straight = x;
  straight[1] = straight[2] = 0.0;
  const RoverBalance::Vector following = balance_.residual(x);
  balance_.hold_tracks(straight, 0.5);
  const RoverBalance::Vector held = balance_.residual(x);
  EXPECT_GT((held - following).cwiseAbs().maxCoeff(), 1e-3) << "its wheels stand in each other's tracks";
  EXPECT_LT(worst_slope(x), 2e-3) << "nor does the Jacobian have what does not change";
  // Half of the way from the straight motion's shares to this one's, and half of the rest.
  balance_.hold_tracks(x, 0.5);
  const double half = (balance_.residual(x) - following).cwiseAbs().maxCoeff();
  balance_.hold_tracks(x, 0.5);
  const double quarter = (balance_.residual(x) - following).cwiseAbs().maxCoeff();
  EXPECT_LT(half, (held - following).cwiseAbs().maxCoeff());
  EXPECT_LT(quarter, 0.7 * half);
  balance_.release_tracks();
  EXPECT_EQ(balance_.residual(x), following);
}

INSTANTIATE_TEST_SUITE_P(SixOfABogieAndFourRigid, TracksInTheBalance, ::testing::Bool());

}  // namespace
}  // namespace slipway::sim
