// Stops and embeddings of one drive, each branch by hand.
#include "sim/prediction/drive_outcome.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/angle.h"
#include "core/random.h"
#include "tests/sim/reference_models.h"

namespace slipway::sim {
namespace {

const RoverModel kRover = six_wheeler();  // a turn of its wheels rolls 0.785 m
constexpr DriveLimits kLimits;            // slip 0.4, tilt 25 deg, 10 A, 0.08 m
constexpr SlipChecks kChecks;             // every 5 m

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

TEST(DriveOutcome, ASinkageOverTheLimitHaltsAndOneNearTheAxleEmbeds) {
  const DriveOutcome deep = drive({{5.0, 0.0}, {1.0, 0.0, 0.0, 1.0, 0.09}});
  EXPECT_TRUE(deep.of(Rule::kSinkage).tripped);
  EXPECT_EQ(deep.stops, 1);
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

// A stretch between checks is 5 m of rolling. A drive that ends before is judged on the mean soils alone:
// whatever it does, a longer drive that begins so does no better.
TEST(DriveOutcome, ADriveThatRollsLessThanAStretchIsNotChecked) {
  EXPECT_EQ(drive({{2.51, 0.5}}).stops, 1);
  EXPECT_EQ(drive({{2.49, 0.5}}).stops, 0);
}

TEST(DriveOutcome, ASlipAtTheLimitHalts) {
  EXPECT_EQ(drive({{10.0, 0.4}}).stops, 3) << "16.7 m are rolled";
  EXPECT_EQ(drive({{10.0, 0.399}}).stops, 0);
  const DriveOutcome held = drive({{6.0, 0.0}, kStuck}, {}, {.max_slip_ratio = 1.0});
  EXPECT_EQ(held.stops, 1) << "a rover that does not move halts under any limit";
  EXPECT_TRUE(held.ending().immobilised);
}

TEST(DriveOutcome, ALoosePatchInFirmGroundHaltsWhereverTheChecksFall) {
  for (double before = 3.0; before < 9.0; before += 0.5) {
    const DriveOutcome patch = drive({{before, 0.02}, {1.5, 0.7}, {10.0, 0.02}});
    EXPECT_EQ(patch.stops, 1) << before;
  }
}

TEST(DriveOutcome, ItsEndingIsTheFirstHaltAndTheEmbeddingThatFollowsThere) {
  DriveOutcome outcome;
  EXPECT_TRUE(outcome.ending().completed());
  outcome.events = {{Rule::kTilt, 4}, {Rule::kImmobilised, 9}, {Rule::kEmbedding, 9}};
  EXPECT_EQ(outcome.ending().halt->rule, Rule::kTilt);
  EXPECT_FALSE(outcome.ending().immobilised || outcome.ending().embedded);
  EXPECT_TRUE(outcome.ending(1, 3).immobilised && outcome.ending(1, 3).embedded);
}

TEST(DriveOutcome, ManyTurnsInOnePlaceDigIn) {
  OutcomeFollower follower(kRover, kLimits, kChecks);
  PreparedStation station;
  station.command.turn_in_place = true;
  station.turn_rad = rad_from_deg(90.0);
  station.stance.belly_clearance_m = 0.3;
  StationState state;
  state.slip_ratio = 0.3;
  state.wheels = PerWheel<WheelState>(kRover.wheels.size());
  std::size_t turns = 0;
  while (turns < 500 && follower.add(station, turns, state)) ++turns;
  EXPECT_GT(turns, 4u) << "one turn of the rover embeds nothing";
  EXPECT_LT(turns, 120u);
}

TEST(DriveOutcome, TheWayAsideIsThatSinceTheLastStretch) {
  OutcomeFollower follower(kRover, kLimits, kChecks);
  PreparedStation station;
  station.drive_m = 0.5;
  station.stance.belly_clearance_m = 0.3;
  StationState state;
  state.side_slip_rad = rad_from_deg(8.0);
  state.wheels = PerWheel<WheelState>(kRover.wheels.size());
  for (std::size_t k = 0; k < 40; ++k) {
    station.distance_m += 0.5;
    ASSERT_TRUE(follower.add(station, k, state));
  }
  EXPECT_NEAR(follower.aside_m(), 5.0 * std::tan(rad_from_deg(8.0)), 1e-9);
  EXPECT_EQ(follower.stops(), 0);
}

// A drive in segments is a sol's drive each: its time and its energy are counted anew.
TEST(DriveOutcome, TimeAndEnergyAreThoseOfASegment) {
  PreparedStation station;
  station.drive_m = 0.5;
  station.stance.belly_clearance_m = 0.3;
  StationState state;
  state.along_m_s = 0.05;
  state.electric_power_w = 10.0;
  state.wheels = PerWheel<WheelState>(kRover.wheels.size());
  const auto halts = [&](const DriveLimits& limits, double segment_m) {
    OutcomeFollower follower(kRover, limits, kChecks, segment_m);
    for (std::size_t k = 0; k < 40; ++k) {
      station.distance_m = 0.5 * static_cast<double>(k + 1);
      EXPECT_TRUE(follower.add(station, k, state));
    }
    return follower.stops();
  };
  const Effort whole = effort_of(station, state);
  ASSERT_GT(whole.duration_s, 0.0);
  ASSERT_GT(whole.energy_j, 0.0);
  DriveLimits hours, energy;
  hours.max_drive_s = 25.0 * whole.duration_s;
  energy.max_energy_j = 25.0 * whole.energy_j;
  for (const DriveLimits& limits : {hours, energy}) {
    EXPECT_EQ(halts(limits, 0.0), 1) << "forty stations are more than twenty-five";
    EXPECT_EQ(halts(limits, 10.0), 0) << "of a segment's twenty they are not";
  }
}

TEST(RuleCatalogue, PeaksBeyondTheirLimitsAreBroken) {
  DriveExtremes extremes;
  extremes.max_slip_ratio = {0.4, 3.0};
  extremes.max_tilt_rad = {rad_from_deg(24.0), 4.0};
  extremes.max_sinkage_m = {0.09, 5.0};
  const std::vector<BrokenLimit> broken = broken_limits(extremes, kLimits);
  ASSERT_EQ(broken.size(), 2U);
  EXPECT_EQ(describe(broken[0]), "slip 0.4 at 3.0 m, limit 0.4") << "slip is over at its limit";
  EXPECT_EQ(describe(broken[1]), "sinkage 0.09 m at 5.0 m, limit 0.08 m");
}

TEST(RuleCatalogue, TheSuspensionIsItsLargestAngle) {
  DriveLimits limits;
  limits.max_suspension_rad = 0.2;
  const StationRules rules(kRover, limits);
  Stance stance;
  stance.belly_clearance_m = 1.0;
  StationState state;
  state.wheels = PerWheel<WheelState>(kRover.wheels.size());
  EXPECT_FALSE(rules.broken_by(stance, {}, state, false));
  stance.bogie_rad[1] = -0.3;
  EXPECT_TRUE(rules.broken_by(stance, {}, state, false));
  EXPECT_FALSE(rules.broken_by(stance, {}, state, true)) << "the ground's shape, whatever the soil";
}

// Wheels that skid as the rover turns on the spot have a slip of yaw, which is none on the way.
TEST(RuleCatalogue, ATurnInPlaceHasNoSlipOnTheWay) {
  const StationRules rules(kRover, kLimits);
  Stance stance;
  stance.belly_clearance_m = 1.0;
  StationState state;
  state.wheels = PerWheel<WheelState>(kRover.wheels.size());
  state.slip_ratio = 0.7;
  EXPECT_TRUE(rules.broken_by(stance, {}, state));
  EXPECT_FALSE(rules.broken_by(stance, {.turn_in_place = true}, state));
}

// What an operator may change never makes a drive worse by being stricter on the ground, or less strict on
// the rover; and no beginning of a drive is worse than the whole.
class DriveOutcomeProperties : public testing::TestWithParam<std::uint64_t> {
 protected:
  // Pieces of all kinds of ground, some of which hold the rover.
  std::vector<Piece> pieces() const {
    const std::uint64_t key = random_key(GetParam(), 7);
    std::vector<Piece> all;
    for (std::uint64_t k = 0; k < 12; ++k) {
      const auto draw = [&](std::uint64_t n) { return random_uniform(key, 8 * k + n); };
      const double slip = draw(0) < 0.6 ? 0.3 * draw(1) : 0.3 + 0.699 * draw(1);
      all.push_back({0.25 + 4.0 * draw(2), slip, 30.0 * draw(3) * draw(3), 12.0 * draw(4) * draw(4),
                     0.1 * draw(5) * draw(5), draw(6) > 0.04});
    }
    return all;
  }
  static std::vector<Piece> beginning(const std::vector<Piece>& whole, double length_m) {
    std::vector<Piece> part;
    for (Piece piece : whole) {
      piece.length_m = std::floor(std::min(piece.length_m, length_m) / 0.25) * 0.25;
      if (piece.length_m > 0.0) part.push_back(piece);
      length_m -= piece.length_m;
    }
    return part;
  }
};

TEST_P(DriveOutcomeProperties, ALooserLimitNeverHaltsADriveThatATighterOneLetsThrough) {
  const DriveLimits tight{.max_slip_ratio = 0.35,
                          .max_tilt_rad = rad_from_deg(15.0),
                          .max_current_a = 6.0,
                          .max_sinkage_m = 0.05};
  for (const DriveLimits& loose :
       {DriveLimits{.max_slip_ratio = 0.6,
       .max_tilt_rad = tight.max_tilt_rad,
       .max_current_a = 6.0,
       .max_sinkage_m = 0.05},
        DriveLimits{.max_slip_ratio = 0.35,
        .max_tilt_rad = rad_from_deg(28.0),
        .max_current_a = 6.0,
        .max_sinkage_m = 0.05},
        DriveLimits{.max_slip_ratio = 0.35,
        .max_tilt_rad = tight.max_tilt_rad,
        .max_current_a = 11.0,
        .max_sinkage_m = 0.09},
        DriveLimits{
            .max_slip_ratio = 1.0, .max_tilt_rad = 1.0, .max_current_a = 100.0, .max_sinkage_m = 1.0}}) {
    if (drive(pieces(), {}, tight).ending().completed()) {
      EXPECT_TRUE(drive(pieces(), {}, loose).ending().completed());
    }
  }
}

TEST_P(DriveOutcomeProperties, TighterSlipLimitsAndCloserChecksEmbedNoDriveMore) {
  for (const double every_m : {1.0, 3.0, 4.7, 5.0, 8.0, 20.0}) {
    for (const double limit : {0.2, 0.4, 0.7, 0.95, 1.0}) {
      const auto embeds = [&](double slip_limit, double spacing_m) {
        return drive(pieces(), {.slip_check_every_m = spacing_m, .embedding_turns = 5.0},
                     {.max_slip_ratio = slip_limit})
            .ending()
            .embedded;
      };
      if (embeds(limit, every_m)) continue;
      EXPECT_FALSE(embeds(0.8 * limit, every_m)) << limit << ' ' << every_m;
      EXPECT_FALSE(embeds(limit, 0.7 * every_m)) << limit << ' ' << every_m;
    }
  }
}

TEST_P(DriveOutcomeProperties, ABeginningIsNeverWorseThanTheWhole) {
  const std::vector<Piece> whole = beginning(pieces(), 1e3);
  const DriveEnding end = drive(whole).ending();
  for (const double length_m : {1.0, 2.5, 5.0, 9.75, 14.0, 20.0}) {
    const DriveEnding part = drive(beginning(whole, length_m)).ending();
    EXPECT_TRUE(part.completed() || !end.completed()) << length_m;
    EXPECT_LE(part.embedded, end.embedded) << length_m;
    EXPECT_LE(part.immobilised, end.immobilised) << length_m;
  }
}

INSTANTIATE_TEST_SUITE_P(RandomDrives, DriveOutcomeProperties, testing::Range<std::uint64_t>(0, 200));

}  // namespace
}  // namespace slipway::sim
