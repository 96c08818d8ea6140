// How far behind a rover is that is commanded by the way its wheels roll, by hand.
#include "sim/prediction/odometry_shortfall.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace slipway::sim {
namespace {

struct Piece {
  double way_m = 0.0, slip_ratio = 0.0;
};

std::vector<float> shortfall(const std::vector<double>& rolled_m, const std::vector<Piece>& pieces,
                             bool stuck = false) {
  ShortfallFollower follower(rolled_m);
  for (const Piece& piece : pieces)
    for (int k = 0; k < 100; ++k) follower.add(piece.way_m / 100.0, piece.slip_ratio);
  return follower.finish(stuck);
}

TEST(ShortfallFollower, ASteadySlipIsThatShareOfTheRolledWay) {
  const auto behind = shortfall({10.0, 20.0}, {{20.0, 0.25}});
  EXPECT_NEAR(behind[0], 2.5, 1e-5);
  EXPECT_NEAR(behind[1], 5.0, 1e-5);
}

TEST(ShortfallFollower, TheSlipIsThatOfThePlaceWhereTheRoverIsAndNotWhereItShouldBe) {
  // 5 m without slip, then half: of 10 m rolled the second 5 m bring it 2.5 m further.
  EXPECT_NEAR(shortfall({10.0}, {{5.0, 0.0}, {5.0, 0.5}})[0], 2.5, 1e-5);
  // 5 m at half slip take 10 m to roll: what lies behind them is never met.
  EXPECT_NEAR(shortfall({10.0}, {{5.0, 0.5}, {5.0, -1.0}})[0], 5.0, 1e-5);
}

TEST(ShortfallFollower, ARoverThatSkidsIsAheadAndGoesOnAtItsLastSlip) {
  // A skid of -0.25 is r w / v - 1: the wheels roll 7.5 m on the 10 m that the rover comes.
  EXPECT_NEAR(shortfall({7.5}, {{10.0, -0.25}})[0], -2.5, 1e-5);
  EXPECT_NEAR(shortfall({15.0}, {{10.0, -0.25}})[0], -5.0, 1e-5);
}

TEST(ShortfallFollower, AStuckRoverStaysWhereItIsWhileItsWheelsRollOn) {
  const auto behind = shortfall({5.0, 10.0, 20.0}, {{8.0, 0.2}}, true);
  EXPECT_NEAR(behind[0], 1.0, 1e-5);
  EXPECT_NEAR(behind[1], 2.0, 1e-5);
  EXPECT_NEAR(behind[2], 12.0, 1e-5);
}

TEST(ShortfallFollower, TurnsInPlaceBringNoWay) {
  const std::vector<double> rolled_m{4.0};
  ShortfallFollower follower(rolled_m);
  follower.add(0.0, 0.9);
  follower.add(4.0, 0.0);
  EXPECT_NEAR(follower.finish(false)[0], 0.0, 1e-6);
}

// A rover that turns by 80 deg beside its path comes no further aside than it drives, to either side.
TEST(DriftFollower, ComesNoFurtherAsideThanItDrives) {
  for (const double sign : {1.0, -1.0}) {
    const std::vector<double> come_m{100.0};
    DriftFollower follower(come_m);
    for (int k = 0; k < 100; ++k) follower.add(1.0, sign * 0.1, sign * 0.014);
    std::vector<float> drift_m, turned_rad;
    follower.finish(drift_m, turned_rad);
    EXPECT_GT(sign * drift_m[0], 50.0);
    EXPECT_LT(sign * drift_m[0], 100.0);
    EXPECT_NEAR(sign * turned_rad[0], 1.4, 1e-5);
  }
}

// Side slip is the angle to the way along: without a turn the way aside is its tangent.
TEST(DriftFollower, FollowsTheSideSlip) {
  const std::vector<double> come_m{10.0};
  DriftFollower follower(come_m);
  follower.add(10.0, 0.5, 0.0);
  std::vector<float> drift_m, turned_rad;
  follower.finish(drift_m, turned_rad);
  EXPECT_NEAR(drift_m[0], 10.0 * std::tan(0.5), 1e-5);
}

}  // namespace
}  // namespace slipway::sim
