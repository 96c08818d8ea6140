// Stops and embeddings of one drive, each branch by hand.
#include "sim/prediction/drive_outcome.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/angle.h"
#include "tests/sim/reference_models.h"

namespace slipway::sim {
namespace {

const RoverModel kRover = six_wheeler();  // a turn of its wheels rolls 0.785 m
constexpr DriveLimits kLimits;            // slip 0.4, tilt 25 deg, 10 A, 0.08 m

struct Piece {
  double length_m = 0.0;
  double slip_ratio = 0.0;
  double tilt_deg = 0.0;
  double current_a = 1.0;
  double sinkage_m = 0.02;
  bool moving = true;
};

DriveOutcome drive(const std::vector<Piece>& pieces, const SlipChecks& checks = {},
                   const DriveLimits& limits = kLimits) {
  OutcomeFollower follower(kRover, limits, checks);
  double distance = 0.0;
  std::size_t index = 0;
  for (const Piece& piece : pieces) {
    for (double left = piece.length_m; left > 1e-9; left -= 0.25) {
      const double step = std::min(0.25, left);
      PreparedStation station;
      station.drive_m = step;
      station.distance_m = distance += step;
      station.stance.attitude.roll_rad = rad_from_deg(piece.tilt_deg);
      station.stance.belly_clearance_m = 0.3;
      StationState state;
      state.attitude = station.stance.attitude;
      state.outcome = piece.moving ? Outcome::kMoving : Outcome::kNoTraction;
      state.slip_ratio = piece.slip_ratio;
      state.wheels = PerWheel<WheelState>(kRover.wheels.size());
      for (std::size_t k = 0; k < kRover.wheels.size(); ++k) {
        state.wheels[k].current_a = piece.current_a * (k == 2 ? 1.0 : 0.9);
        state.wheels[k].sinkage_m = piece.sinkage_m * (k == 4 ? 1.0 : 0.9);
      }
      if (!follower.add(station, index++, state)) return follower.finish();
    }
  }
  return follower.finish();
}

TEST(DriveOutcome, AFirmDriveNeitherStopsNorEmbeds) {
  const DriveOutcome firm = drive({{50.0, 0.1}});
  EXPECT_EQ(firm.stops, 0);
  EXPECT_FALSE(firm.embedded);
  EXPECT_NEAR(firm.of(Rule::kSlipCheck).value, 0.1, 1e-9);
  EXPECT_EQ(firm.of(Rule::kCurrent).wheel, 2);
  EXPECT_EQ(firm.of(Rule::kSinkage).wheel, 4);
  EXPECT_NEAR(firm.of(Rule::kClearance).value, 0.3, 1e-12);
}

TEST(DriveOutcome, TheCheckSeesTheMeanSlipOfItsInterval) {
  // 4 m without slip and 0.6 m at 0.4 roll 5 m: mean slip 0.08.
  EXPECT_EQ(drive({{4.0, 0.0}, {0.5, 0.5}, {20.0, 0.0}}).stops, 0);
  // Ten metres at 0.5 roll 20 m: a stop every 5 m.
  const DriveOutcome slippery = drive({{10.0, 0.5}});
  EXPECT_EQ(slippery.stops, 4);
  EXPECT_TRUE(slippery.of(Rule::kSlipCheck).tripped);
  EXPECT_NEAR(slippery.of(Rule::kSlipCheck).first_m, 2.5, 0.26);
  EXPECT_NEAR(slippery.of(Rule::kSlipCheck).last_m, 10.0, 0.26);
  EXPECT_EQ(drive({{10.0, 0.5}}, {}, {.max_slip_ratio = 0.6}).stops, 0);
}

TEST(DriveOutcome, CloserChecksStopSooner) {
  const DriveOutcome close = drive({{10.0, 0.0}, {1.0, 0.6}, {10.0, 0.0}}, {.slip_check_every_m = 1.0});
  EXPECT_GE(close.stops, 1);
  EXPECT_EQ(drive({{10.0, 0.0}, {1.0, 0.6}, {10.0, 0.0}}).stops, 0);
}

TEST(DriveOutcome, TiltAndCurrentHaltOnceForAStretch) {
  EXPECT_EQ(drive({{5.0, 0.0}, {3.0, 0.0, 26.0}, {5.0, 0.0}, {1.0, 0.0, 27.0}}).stops, 2);
  EXPECT_EQ(drive({{5.0, 0.0}, {3.0, 0.0, 0.0, 11.0}, {5.0, 0.0}}).stops, 1);
}

TEST(DriveOutcome, ASinkageOverTheLimitIsNoStopAndOneNearTheAxleEmbeds) {
  const DriveOutcome deep = drive({{5.0, 0.0}, {1.0, 0.0, 0.0, 1.0, 0.09}});
  EXPECT_TRUE(deep.of(Rule::kSinkage).tripped);
  EXPECT_EQ(deep.stops, 0);
  EXPECT_FALSE(deep.embedded);
  const DriveOutcome embedded = drive({{5.0, 0.0}, {1.0, 0.0, 0.0, 1.0, 0.1}});
  EXPECT_TRUE(embedded.embedded) << "0.1 m is over 0.75 of the radius of 0.125 m";
  ASSERT_EQ(embedded.events.size(), 1u);
  EXPECT_EQ(embedded.events.back().station, 20u);
}

constexpr Piece kStuck{0.25, 0.0, 0.0, 1.0, 0.02, false};
constexpr SlipChecks kATurnEmbeds{.embedding_turns = 1.0};

TEST(DriveOutcome, ARoverThatSpinsForTooManyTurnsBeforeTheNextCheckIsEmbedded) {
  EXPECT_TRUE(drive({{6.0, 0.0}, kStuck}, kATurnEmbeds).embedded);
  // With a check every half metre it halts first.
  const DriveOutcome checked =
      drive({{6.0, 0.0}, kStuck}, {.slip_check_every_m = 0.5, .embedding_turns = 1.0});
  EXPECT_FALSE(checked.embedded);
  EXPECT_EQ(checked.stops, 1);
  // Ten turns roll 7.9 m: checks every 5 m stop it, checks every 20 m come too late.
  EXPECT_FALSE(drive({{6.0, 0.0}, kStuck}).embedded);
  EXPECT_EQ(drive({{6.0, 0.0}, kStuck}).stops, 1);
  EXPECT_TRUE(drive({{6.0, 0.0}, kStuck}, {.slip_check_every_m = 20.0}).embedded);
}

TEST(DriveOutcome, LittleLeftBeforeACheckThatPassesIsSpunOutAfterIt) {
  // 4.75 m are rolled when it sticks: the check after 5 m sees 5 % of slip and lets it go on spinning.
  EXPECT_TRUE(drive({{4.75, 0.0}, kStuck}, kATurnEmbeds).embedded);
  const DriveOutcome stopped = drive({{4.75, 0.0}, kStuck});
  EXPECT_FALSE(stopped.embedded);
  EXPECT_EQ(stopped.stops, 1);
}

TEST(DriveOutcome, ASlipNearOneDigsAsASpinDoes) {
  // 0.05 m at 0.95 roll 1 m, more than a turn.
  EXPECT_TRUE(drive({{2.0, 0.0}, {0.05, 0.95}}, kATurnEmbeds).embedded);
  EXPECT_FALSE(drive({{2.0, 0.0}, {0.02, 0.95}, {3.0, 0.0}}, kATurnEmbeds).embedded);
  EXPECT_FALSE(drive({{2.0, 0.0}, {0.05, 0.85}, {3.0, 0.0}}, kATurnEmbeds).embedded);
}

TEST(DriveOutcome, WhatIsShorterByACentimetreIsCheckedToo) {
  EXPECT_EQ(drive({{2.5, 0.5}}).stops, 1);
  EXPECT_EQ(drive({{2.49, 0.5}}).stops, 1) << "the end of the drive is checked like the way";
}

}  // namespace
}  // namespace slipway::sim
