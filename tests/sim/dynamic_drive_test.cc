#include "sim/dynamic_drive.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/angle.h"
#include "sim/quasi_static.h"
#include "sim/stance.h"
#include "tests/sim/reference_models.h"

namespace slipway::sim {
namespace {

constexpr double kMars = 3.71;

struct Driven {
  DynamicDrive drive;
  std::vector<DriveSample> samples;

  // The last sample at full rates.
  const DriveSample& cruising() const {
    const auto told = [](const DriveSample& sample) {
      double fastest = 0.0;
      for (const double rate : sample.told_rate_rad_s) fastest = std::max(fastest, std::abs(rate));
      return fastest;
    };
    const DriveSample* best = &samples.front();
    for (const DriveSample& sample : samples)
      if (sample.driving && told(sample) >= told(*best) * (1.0 - 1e-9)) best = &sample;
    return *best;
  }
};

DriveLeg straight(double length_m, double speed_m_s = 0.04) {
  DriveLeg leg;
  leg.command.speed_m_s = speed_m_s;
  leg.length_m = length_m;
  return leg;
}

DriveLeg arc(double length_m, double curvature_1_m) {
  DriveLeg leg = straight(length_m);
  leg.command.curvature_1_m = curvature_1_m;
  return leg;
}

DriveLeg turn(double turn_rad, double rate_rad_s = 0.03) {
  DriveLeg leg;
  leg.command.turn_in_place = true;
  leg.command.turn_rate_rad_s = rate_rad_s;
  leg.turn_rad = turn_rad;
  return leg;
}

FunctionGround plane(double tilt_rad) {
  return FunctionGround([slope = std::tan(tilt_rad)](double x, double) { return slope * x; });
}

Result<Driven> try_drive(const RoverModel& rover, const Ground& ground, const Soil& soil, double yaw_rad,
                         const std::vector<DriveLeg>& legs, const DynamicOptions& options = {}) {
  Driven out;
  NoProgress progress;
  DriveSoils soils{{soil}, soil};
  auto drive = simulate_drive(
      rover, kMars, ground, soils, {0.0, 0.0, yaw_rad}, legs, options,
      [&](const DriveSample& sample) { out.samples.push_back(sample); }, progress);
  if (!drive) return fail(drive.error());
  out.drive = std::move(*drive);
  return out;
}

Driven drive(const RoverModel& rover, const Ground& ground, const Soil& soil, double yaw_rad,
             const std::vector<DriveLeg>& legs, const DynamicOptions& options = {}) {
  auto driven = try_drive(rover, ground, soil, yaw_rad, legs, options);
  EXPECT_TRUE(driven) << driven.error().detail;
  return driven ? std::move(*driven) : Driven{};
}

// All mass in the body and no compliance, as the quasi-static rung has it.
RoverModel light_suspension(RoverModel rover) {
  rover.masses = {.wheel_kg = 1e-3, .rocker_kg = 1e-3, .bogie_kg = 1e-3, .body_inertia_kg_m2 = std::nullopt};
  rover.suspension.differential_stiffness_nm_rad = 1e8;
  return rover;
}

struct Motion {
  const char* name;
  double tilt_deg, yaw_deg;
  DriveLeg leg;
};

class SlowLimit : public testing::TestWithParam<Motion> {};

// In steady motion the dynamic rung is the quasi-static one, at any speed. What is left is that wheels which
// sink unequally turn the suspension a little (a third of a degree up 15 deg), which shifts their loads by up
// to 1 %.
TEST_P(SlowLimit, IsTheQuasiStaticRung) {
  const Motion& motion = GetParam();
  const RoverModel rover = light_suspension(six_wheeler());
  DynamicOptions options{.relative_tolerance = 1e-8, .feedback = Feedback::kNone, .sample_interval_s = 0.5};
  options.contact_points = 1;
  const Soil soil = sandy_loam();
  const Driven driven = drive(rover, plane(rad_from_deg(motion.tilt_deg)), soil, rad_from_deg(motion.yaw_deg),
                              {motion.leg}, options);
  const DriveSample& sample = driven.cruising();
  const FunctionGround ground = plane(rad_from_deg(motion.tilt_deg));
  const auto stance = settle(rover, ground, {sample.p_MB.x(), sample.p_MB.y(), sample.attitude.yaw_rad});
  ASSERT_TRUE(stance);
  QuasiStaticSolver solver(rover, kMars);
  const StationState balance = solver.solve(*stance, soil, motion.leg.command);
  ASSERT_TRUE(balance.moving());
  EXPECT_NEAR(sample.slip_ratio, balance.slip_ratio, 2e-4);
  for (std::size_t k = 0; k < 6; ++k) {
    EXPECT_NEAR(sample.wheels[k].load_n, balance.wheels[k].load_n, 1.2) << k;
    EXPECT_NEAR(sample.wheels[k].sinkage_m, balance.wheels[k].sinkage_m, 8e-5) << k;
    EXPECT_NEAR(sample.wheels[k].current_a, balance.wheels[k].current_a, 4e-3) << k;
    EXPECT_NEAR(sample.wheels[k].slip_ratio, balance.wheels[k].slip_ratio, 3e-4) << k;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Motions, SlowLimit,
    testing::Values(Motion{"level", 0.0, 0.0, straight(1.0)}, Motion{"up", 15.0, 0.0, straight(1.0)},
                    Motion{"up_fast", 15.0, 0.0, straight(1.0, 0.05)},
                    Motion{"up_slow", 15.0, 0.0, straight(0.7, 0.01)},
                    Motion{"down", 15.0, 180.0, straight(1.0)},
                    Motion{"backwards_up", 15.0, 180.0, straight(1.0, -0.04)},
                    Motion{"across", 10.0, 90.0, straight(1.0)}, Motion{"askew", 10.0, 40.0, straight(1.0)},
                    Motion{"arc", 0.0, 0.0, arc(2.0, 0.4)}, Motion{"turn", 0.0, 0.0, turn(2.0)}),
    [](const auto& named) { return std::string(named.param.name); });

// Wheels of 3 % of the rover's mass each: up a slope they turn the bogies, which the balance tells where it
// is told that they weigh at their own places.
TEST(SlowLimitOfHeavyWheels, IsTheQuasiStaticRungWithTheWheelsOwnWeight) {
  RoverModel rover = light_suspension(six_wheeler());
  rover.masses.wheel_kg.reset();
  DynamicOptions options{.relative_tolerance = 1e-8, .feedback = Feedback::kNone, .sample_interval_s = 0.5};
  options.contact_points = 1;
  const FunctionGround ground = plane(rad_from_deg(15.0));
  const Driven driven = drive(rover, plane(rad_from_deg(15.0)), sandy_loam(), 0.0, {straight(1.0)}, options);
  const DriveSample& sample = driven.cruising();
  double farthest_without = 0.0;
  for (const double wheel_weight : {0.0, 1.0}) {
    rover.wheel_weight = wheel_weight;
    const auto stance = settle(rover, ground, {sample.p_MB.x(), sample.p_MB.y(), sample.attitude.yaw_rad});
    ASSERT_TRUE(stance);
    QuasiStaticSolver solver(rover, kMars);
    const StationState balance = solver.solve(*stance, sandy_loam(), straight(1.0).command);
    ASSERT_TRUE(balance.moving());
    for (std::size_t k = 0; k < 6; ++k) {
      const double off = std::abs(sample.wheels[k].load_n - balance.wheels[k].load_n);
      if (wheel_weight == 0.0) farthest_without = std::max(farthest_without, off);
      if (wheel_weight == 1.0) {
        EXPECT_LT(off, 1.2) << k;
      }
    }
  }
  EXPECT_GT(farthest_without, 2.5);
}

TEST(DynamicDrive, RepeatsToTheBit) {
  const FunctionGround hills([](double x, double y) { return 0.1 * std::sin(2.0 * x) * std::cos(3.0 * y); });
  std::vector<DynamicDrive> drives;
  for (int run = 0; run < 2; ++run)
    drives.push_back(drive(six_wheeler(), hills, sandy_loam(), 0.3, {arc(2.0, 0.3)}).drive);
  EXPECT_EQ(drives[0].final, drives[1].final);
  EXPECT_EQ(drives[0].energy_j, drives[1].energy_j);
  EXPECT_EQ(drives[0].work.evaluations, drives[1].work.evaluations);
}

TEST(DynamicDrive, ConvergesWithTheTolerance) {
  const FunctionGround hills([](double x, double y) { return 0.08 * std::sin(2.0 * x) * std::cos(3.0 * y); });
  const auto end = [&](double tolerance) {
    DynamicOptions options;
    options.relative_tolerance = tolerance;
    return drive(six_wheeler(), hills, sandy_loam(), 0.3, {straight(3.0)}, options).drive.final;
  };
  const Pose2 exact = end(1e-8), usual = end(1e-4);
  EXPECT_NEAR(usual.x_m, exact.x_m, 2e-4);
  EXPECT_NEAR(usual.y_m, exact.y_m, 2e-4);
  EXPECT_NEAR(usual.yaw_rad, exact.yaw_rad, 2e-4);
}

// A place and a heading have no size that an error could be measured by.
TEST(DynamicDrive, TurnsAlikeBothWaysAndFromAnyHeading) {
  const auto turned = [](double yaw_rad, double rate_rad_s) {
    const Driven driven = drive(six_wheeler(), plane(0.0), sandy_loam(), yaw_rad, {turn(6.0, rate_rad_s)});
    return std::abs(driven.drive.final.yaw_rad - driven.drive.start.yaw_rad);
  };
  const double left = turned(0.0, 0.03);
  for (const double yaw_rad : {0.0, 1.0, 3.0}) {
    EXPECT_NEAR(turned(yaw_rad, 0.03), left, 0.003) << yaw_rad;
    EXPECT_NEAR(turned(yaw_rad, -0.03), left, 0.003) << yaw_rad;
  }
}

TEST(DynamicDrive, IsTheSameFarFromTheMapsOrigin) {
  const auto end = [](double east, double north) {
    const FunctionGround bumps(
        [=](double x, double y) {
          return -4500.0 + 0.04 * std::sin(4.0 * (x - east)) * std::cos(3.0 * (y - north));
        },
        1e8);
    NoProgress progress;
    DynamicOptions options;
    options.relative_tolerance = 1e-4;
    options.feedback = Feedback::kPose;
    const DriveSoils soils{{sandy_loam()}, sandy_loam()};
    const auto driven = simulate_drive(six_wheeler(), kMars, bumps, soils, {east, north, 0.5},
                                       std::vector<DriveLeg>{arc(6.0, 0.2)}, options, nullptr, progress);
    EXPECT_TRUE(driven);
    return Eigen::Vector3d(driven->final.x_m - east, driven->final.y_m - north, driven->energy_j);
  };
  const Eigen::Vector3d near = end(0.0, 0.0), far = end(8142640.0, -276640.0);
  EXPECT_NEAR((far - near).head<2>().norm(), 0.0, 1e-3);
  EXPECT_NEAR(far.z() / near.z(), 1.0, 1e-3);
}

TEST(DynamicDrive, StandsBrakedOnASlope) {
  const Driven driven = drive(six_wheeler(), plane(rad_from_deg(15.0)), sandy_loam(), 0.0, {straight(0.1)});
  const DriveSample& first = driven.samples.front();
  EXPECT_LT(first.velocity_B.norm(), 1e-4);
  EXPECT_LT(driven.drive.start.x_m, 0.0);
  EXPECT_GT(driven.drive.start.x_m, -0.03);
}

TEST(DynamicDrive, StartsAndStopsWithoutAJolt) {
  DynamicOptions options;
  options.sample_interval_s = 0.05;
  const Driven driven =
      drive(six_wheeler(), plane(0.0), sandy_loam(), 0.0, {straight(0.4), straight(0.4, -0.04)}, options);
  for (const DriveSample& sample : driven.samples)
    EXPECT_NEAR((sample.specific_force_B - Eigen::Vector3d(0.0, 0.0, kMars)).norm(), 0.0, 0.1)
        << sample.time_s;
}

TEST(DynamicDrive, EndsWhereItsLegEndsWhenItSeesItsPose) {
  DynamicOptions options;
  options.feedback = Feedback::kPose;
  const std::vector<DriveLeg> legs{arc(2.0, 0.4), turn(1.2), straight(1.5), turn(2.0, -0.03),
                                   straight(0.5, -0.04)};
  const Driven driven = drive(six_wheeler(), plane(rad_from_deg(5.0)), sandy_loam(), 0.0, legs, options);
  EXPECT_EQ(driven.drive.end, DriveEnd::kFinished);
  EXPECT_NEAR(std::hypot(driven.drive.final.x_m - driven.drive.commanded.x_m,
                         driven.drive.final.y_m - driven.drive.commanded.y_m),
              0.0, 0.15);
  EXPECT_NEAR(driven.drive.final.yaw_rad, driven.drive.commanded.yaw_rad, rad_from_deg(6.0));
}

TEST(DynamicDrive, WithoutFeedbackSlidesDownACrossSlopeAndWithItHoldsItsLine) {
  DynamicOptions pose;
  pose.feedback = Feedback::kPose;
  const auto slid = [&](const DynamicOptions& options) {
    const Driven driven = drive(six_wheeler(), plane(rad_from_deg(15.0)), sandy_loam(), rad_from_deg(90.0),
                                {straight(6.0)}, options);
    return driven.drive.commanded.x_m - driven.drive.final.x_m;
  };
  const double open = slid({}), closed = slid(pose);
  EXPECT_GT(open, 0.5);
  EXPECT_LT(closed, 0.65 * open);
}

TEST(DynamicDrive, YawsTowardsADeadWheel) {
  for (const int dead : {0, 3}) {
    RoverModel rover = six_wheeler();
    rover.wheels[dead].drive = WheelDrive::kLocked;
    const Driven driven = drive(rover, plane(0.0), loose_sand(), 0.0, {straight(2.0)});
    EXPECT_GT((dead == 0 ? 1.0 : -1.0) * driven.drive.final.yaw_rad, rad_from_deg(3.0));
    EXPECT_NEAR(driven.samples.back().wheels[dead].rate_rad_s, 0.0, 1e-15);
    EXPECT_EQ(driven.samples.back().wheels[dead].current_a, 0.0);
  }
}

TEST(DynamicDrive, AFreeWheelRollsAtTheGroundsSpeed) {
  RoverModel rover = six_wheeler();
  rover.wheels[1].drive = WheelDrive::kFree;
  const DriveSample sample = drive(rover, plane(0.0), sandy_loam(), 0.0, {straight(1.5)}).cruising();
  EXPECT_NEAR(sample.wheels[1].torque_nm, 0.0, 0.05);
  EXPECT_LT(sample.wheels[1].slip_ratio, 0.0);
  EXPECT_GT(sample.wheels[1].slip_ratio, -0.4);
}

TEST(DynamicDrive, AWeakMotorStallsAndTheRoverSaysSo) {
  RoverModel rover = six_wheeler();
  rover.drive.max_current_a = 0.12;
  DynamicOptions options;
  options.give_up_s = 20.0;
  const Driven driven = drive(rover, plane(rad_from_deg(14.0)), sandy_loam(), 0.0, {straight(1.0)}, options);
  bool stalls = false;
  for (const DriveEvent& event : driven.drive.events) stalls |= event.kind == DriveEventKind::kStall;
  EXPECT_TRUE(stalls || driven.drive.end == DriveEnd::kImmobilised || driven.drive.end == DriveEnd::kSlid);
  for (const DriveSample& sample : driven.samples)
    for (const WheelState& wheel : sample.wheels) EXPECT_LE(std::abs(wheel.current_a), 0.12 + 1e-6);
}

TEST(DynamicDrive, GivesUpWhereItMakesNoProgress) {
  DynamicOptions options;
  options.give_up_s = 30.0;
  options.feedback = Feedback::kPose;
  const Driven driven =
      drive(six_wheeler(), plane(rad_from_deg(24.0)), loose_sand(), 0.0, {straight(3.0)}, options);
  EXPECT_EQ(driven.drive.end, DriveEnd::kImmobilised);
  EXPECT_NE(driven.drive.reason.find("no progress for 3"), std::string::npos) << driven.drive.reason;
  EXPECT_LT(driven.drive.duration_s, 200.0);
}

// A leg may be over before it is time to give up.
TEST(DynamicDrive, IsNotFinishedWhereALegMadeNoWay) {
  const std::vector<DriveLeg> legs{straight(1.0), straight(1.0, -0.04)};
  const Driven stuck = drive(six_wheeler(), plane(rad_from_deg(28.0)), loose_sand(), 0.0, legs);
  EXPECT_LT(stuck.drive.duration_s, 60.0);
  EXPECT_LT(stuck.drive.progress_m, 0.0);
  EXPECT_EQ(stuck.drive.end, DriveEnd::kImmobilised);
  EXPECT_TRUE(stuck.drive.reason.starts_with("no progress on leg 1 of 2 after ")) << stuck.drive.reason;
  EXPECT_GE(stuck.drive.max_current_a.distance_m, 0.0);
  // Whoever is told less than the soil gives has not failed.
  const Driven short_one =
      drive(six_wheeler(), plane(rad_from_deg(20.0)), loose_sand(), 0.0, {straight(0.01)});
  EXPECT_LT(short_one.drive.progress_m, 0.0);
  EXPECT_EQ(short_one.drive.end, DriveEnd::kFinished);
}

TEST(DynamicDrive, DoesNotGiveUpOnWhatIsSlow) {
  DynamicOptions options;
  options.give_up_s = 2.0;
  const Driven slow =
      drive(six_wheeler(), plane(rad_from_deg(20.0)), sandy_loam(), 0.0, {straight(0.1, 1e-4)}, options);
  EXPECT_EQ(slow.drive.end, DriveEnd::kFinished) << slow.drive.reason;
  EXPECT_GT(slow.drive.progress_m, 0.01);
  options.feedback = Feedback::kPose;
  const Driven stuck =
      drive(six_wheeler(), plane(rad_from_deg(24.0)), loose_sand(), 0.0, {straight(1.0, 5e-4)}, options);
  EXPECT_EQ(stuck.drive.end, DriveEnd::kImmobilised);
  EXPECT_GT(stuck.drive.duration_s, 120.0);
  EXPECT_LT(stuck.drive.duration_s, 400.0);
}

TEST(DynamicDrive, AStiffRoverLiftsAWheelOverAHollow) {
  const FunctionGround hollow([](double x, double y) {
    return -0.12 * std::exp(-(std::pow((x - 1.2) / 0.2, 2) + std::pow((y - 0.5) / 0.3, 2)));
  });
  const Driven driven =
      drive(four_wheeler(SuspensionType::kRigid), hollow, sandy_loam(), 0.0, {straight(1.6)});
  bool lifted = false, down = false;
  for (const DriveEvent& event : driven.drive.events) {
    lifted |= event.kind == DriveEventKind::kLiftOff;
    down |= lifted && event.kind == DriveEventKind::kTouchDown;
  }
  EXPECT_TRUE(lifted);
  EXPECT_TRUE(down);
}

TEST(DynamicDrive, MeetsTheStopsOfItsJoints) {
  RoverModel rover = six_wheeler();
  rover.suspension.bogie_stop_rad = rad_from_deg(4.0);
  const FunctionGround bump([](double x, double) { return 0.15 * std::exp(-std::pow((x - 1.0) / 0.25, 2)); });
  const Driven driven = drive(rover, bump, sandy_loam(), 0.0, {straight(2.0)});
  bool stopped = false;
  for (const DriveEvent& event : driven.drive.events) stopped |= event.kind == DriveEventKind::kJointStop;
  EXPECT_TRUE(stopped);
  for (const DriveSample& sample : driven.samples)
    for (const double angle : sample.bogie_rad) EXPECT_LT(std::abs(angle), rad_from_deg(6.0));
}

// The differential's compliance leaves the rockers' angles opposite to a hundredth of a degree.
TEST(DynamicDrive, TheDifferentialKeepsTheRockersOpposite) {
  const FunctionGround hills(
      [](double x, double y) { return 0.1 * std::sin(2.0 * x) * std::cos(3.0 * y + 1.0); });
  const Driven driven = drive(six_wheeler(), hills, sandy_loam(), 0.0, {straight(3.0)});
  double largest = 0.0;
  for (const DriveSample& sample : driven.samples) {
    EXPECT_NEAR(sample.rocker_rad[0] + sample.rocker_rad[1], 0.0, rad_from_deg(0.02));
    largest = std::max(largest, std::abs(sample.rocker_rad[0]));
  }
  EXPECT_GT(largest, rad_from_deg(1.0));
}

// Ruts: the same rule as the quasi-static rung's for wheels in one line.
TEST(DynamicDrive, LaterWheelsMeetTheTracksOfEarlierOnes) {
  RoverModel rover = light_suspension(even_wheeler(SuspensionType::kAveraging, 2));
  Soil soil = sandy_loam();
  soil.multipass_stiffening = 0.9;
  DynamicOptions options;
  options.contact_points = 1;
  const Driven driven = drive(rover, plane(0.0), soil, 0.0, {straight(3.0)}, options);
  const DriveSample& sample = driven.cruising();
  QuasiStaticSolver solver(rover, kMars);
  const StationState balance = solver.solve(stance_on_plane(rover, {}), soil, {});
  for (std::size_t k = 0; k < 4; ++k)
    EXPECT_NEAR(sample.wheels[k].sinkage_m, balance.wheels[k].sinkage_m, 4e-4) << k;
  EXPECT_NEAR(sample.slip_ratio, balance.slip_ratio, 0.004);
}

TEST(DynamicDrive, LeavesRutsAsDeepAsItsWheelsSank) {
  DynamicOptions options;
  options.keep_ruts = true;
  const Driven driven = drive(six_wheeler(), plane(0.0), sandy_loam(), 0.0, {straight(2.0)}, options);
  const RutMap::Rut rut = driven.drive.ruts.at(0.9, 0.53);
  EXPECT_NEAR(rut.depth_m, driven.cruising().wheels[2].sinkage_m, 1e-3);
  EXPECT_EQ(rut.share, 1.0);
  EXPECT_EQ(driven.drive.ruts.at(0.9, 0.0).share, 0.0);
}

TEST(DynamicDrive, ARockIsMetBeforeTheAxleIsAboveIt) {
  const FunctionGround rock(
      [](double x, double) { return 0.06 * 0.5 * (1.0 + std::tanh((x - 1.1) / 0.02)); });
  const auto first_contact = [&](int points) {
    DynamicOptions options;
    options.contact_points = points;
    options.sample_interval_s = 0.2;
    const Driven driven = drive(six_wheeler(), rock, sandy_loam(), 0.0, {straight(0.6)}, options);
    for (const DriveSample& sample : driven.samples)
      if (sample.p_MB.z() > driven.samples.front().p_MB.z() + 0.002) return sample.p_MB.x();
    return 1.0;
  };
  EXPECT_LT(first_contact(5), first_contact(1) - 0.02);
}

TEST(DynamicDrive, RefusesWhatItCannotStartFrom) {
  const FunctionGround small([](double, double) { return 0.0; }, 2.0);
  const RoverModel rover = six_wheeler();
  const DriveSoils soils{{sandy_loam()}, sandy_loam()};
  NoProgress progress;
  const std::vector<DriveLeg> legs{straight(1.0)};
  const auto off = simulate_drive(rover, kMars, small, soils, {1.8, 0.0, 0.0}, legs, {}, nullptr, progress);
  ASSERT_FALSE(off);
  EXPECT_EQ(off.error().code, ErrorCode::kNoData);
  EXPECT_NE(off.error().detail.find("wheel lf"), std::string::npos);

  const auto leaves = simulate_drive(rover, kMars, small, soils, {0.0, 0.0, 0.0}, std::vector{straight(5.0)},
                                     {}, nullptr, progress);
  ASSERT_FALSE(leaves);
  EXPECT_EQ(leaves.error().code, ErrorCode::kNoData);
  EXPECT_NE(leaves.error().detail.find("leaves the known ground"), std::string::npos)
      << leaves.error().detail;

  DynamicOptions wrong;
  wrong.relative_tolerance = 1.0;
  wrong.contact_points = 0;
  const auto faulty =
      simulate_drive(rover, kMars, small, soils, {}, std::vector{straight(0.0)}, wrong, nullptr, progress);
  ASSERT_FALSE(faulty);
  EXPECT_EQ(faulty.error().faults.size(), 3U);

  const FunctionGround cliff([](double x, double) { return x > 0.3 ? 2.0 : 0.0; });
  const auto uneven = simulate_drive(rover, kMars, cliff, soils, {}, legs, {}, nullptr, progress);
  ASSERT_FALSE(uneven);
  EXPECT_EQ(uneven.error().code, ErrorCode::kInvalidRequest);
}

TEST(DynamicDrive, SaysWhereARoverDoesNotRest) {
  const Driven driven = drive(six_wheeler(), plane(rad_from_deg(50.0)), loose_sand(), 0.0, {straight(1.0)});
  EXPECT_EQ(driven.drive.end, DriveEnd::kSlid);
  EXPECT_NE(driven.drive.reason.find("does not come to rest"), std::string::npos);
}

// A rover of 900 kg on wheels of 0.25 m.
RoverModel heavy_wheeler() {
  RoverModel rover = six_wheeler();
  rover.mass_kg = 900.0;
  rover.com_m = {0.0, 0.0, 0.6};
  rover.body_length_m = 2.2;
  for (WheelModel& wheel : rover.wheels) {
    wheel.radius_m = 0.25;
    wheel.width_m = 0.4;
    wheel.position_m = {1.5 * wheel.position_m.x(), 2.0 * wheel.position_m.y(), 0.25};
  }
  rover.suspension.rocker_pivot_m = {0.2, 0.8, 0.7};
  rover.suspension.bogie_pivot_m = {-0.5, 1.0, 0.5};
  return rover;
}

// What rocks on its wheels does not slide: steeper ground never helps.
TEST(DynamicDrive, SlidesWhereItIsSteeperIfAtAll) {
  for (const double yaw_deg : {0.0, 180.0}) {
    bool slid = false;
    for (double tilt_deg = 31.0; tilt_deg <= 38.0; tilt_deg += 1.0) {
      const Driven driven = drive(heavy_wheeler(), plane(rad_from_deg(tilt_deg)), sandy_loam(),
                                  rad_from_deg(yaw_deg), {straight(0.02)});
      const bool slides = driven.drive.end == DriveEnd::kSlid || driven.drive.end == DriveEnd::kTipped;
      EXPECT_TRUE(slides || !slid) << yaw_deg << " " << tilt_deg;
      slid = slides;
    }
    EXPECT_TRUE(slid) << yaw_deg;
  }
}

TEST(DynamicDrive, ItsGreatestFiguresDoNotDependOnTheSamples) {
  const FunctionGround hills([](double x, double y) { return 0.1 * std::sin(2.0 * x) * std::cos(3.0 * y); });
  DynamicOptions often, once;
  often.sample_interval_s = 0.01;
  once.sample_interval_s = 1000.0;
  const std::vector<DriveLeg> legs{arc(1.5, 0.2), turn(0.3)};
  const Driven fine = drive(six_wheeler(), hills, loose_sand(), 0.3, legs, often);
  const DynamicDrive coarse = drive(six_wheeler(), hills, loose_sand(), 0.3, legs, once).drive;
  const auto expect_alike = [](const Peak& a, const Peak& b, double share = 0.01) {
    EXPECT_NEAR(a.value / b.value, 1.0, share);
  };
  expect_alike(coarse.max_current_a, fine.drive.max_current_a);
  expect_alike(coarse.max_sinkage_m, fine.drive.max_sinkage_m);
  expect_alike(coarse.max_slip_ratio, fine.drive.max_slip_ratio);
  expect_alike(coarse.max_tilt_rad, fine.drive.max_tilt_rad);
  // They are those of dense samples, but for what is greatest within a step.
  Peak current, sinkage, slip, tilt;
  for (const DriveSample& sample : fine.samples) {
    tilt.raise(sample.attitude.tilt_rad(), 0.0);
    if (sample.driving) slip.raise(std::abs(sample.slip_ratio), 0.0);
    for (const WheelState& wheel : sample.wheels) {
      current.raise(std::abs(wheel.current_a), 0.0);
      sinkage.raise(wheel.sinkage_m, 0.0);
    }
  }
  expect_alike(coarse.max_current_a, current, 0.03);
  expect_alike(coarse.max_sinkage_m, sinkage, 0.03);
  expect_alike(coarse.max_slip_ratio, slip, 0.03);
  expect_alike(coarse.max_tilt_rad, tilt, 0.03);
}

TEST(DynamicDrive, CountsFromWhenTimeStarts) {
  const Driven driven = drive(six_wheeler(), plane(rad_from_deg(20.0)), sandy_loam(), 0.0, {straight(0.2)});
  for (const double turned : driven.samples.front().turned_rad) EXPECT_EQ(turned, 0.0);
  double greatest_w = 0.0;
  for (const DriveSample& sample : driven.samples) {
    double power_w = 0.0;
    for (std::size_t k = 0; k < sample.wheels.size(); ++k)
      power_w += std::abs(sample.voltage_v[k] * sample.wheels[k].current_a);
    greatest_w = std::max(greatest_w, power_w);
  }
  EXPECT_LE(driven.drive.energy_j, 1.5 * greatest_w * driven.drive.duration_s);
  // Nothing is used by what slides while it is set down.
  const Driven slid = drive(six_wheeler(), plane(rad_from_deg(50.0)), loose_sand(), 0.0, {straight(1.0)});
  ASSERT_EQ(slid.drive.end, DriveEnd::kSlid);
  EXPECT_EQ(slid.drive.energy_j, 0.0);
}

TEST(DynamicDrive, EndsWithItsBellyOnARidge) {
  // Between the wheels, along and across the way: these roll past it, or over it.
  const FunctionGround between([](double x, double y) {
    return 0.35 * std::exp(-std::pow(y / 0.15, 2)) * 0.5 * (1.0 + std::tanh((x - 1.6) / 0.05));
  });
  const Driven stuck = drive(six_wheeler(), between, sandy_loam(), 0.0, {straight(2.0)});
  EXPECT_EQ(stuck.drive.end, DriveEnd::kImmobilised);
  EXPECT_TRUE(stuck.drive.reason.starts_with("belly on the ground at (1.")) << stuck.drive.reason;
  EXPECT_LT(stuck.drive.progress_m, 1.2);
  RoverModel high = six_wheeler();
  high.belly_clearance_m = 0.4;
  EXPECT_EQ(drive(high, between, sandy_loam(), 0.0, {straight(2.0)}).drive.end, DriveEnd::kFinished);
  // Where it is set down on one, it says so at once.
  const FunctionGround along([](double, double y) { return 0.35 * std::exp(-std::pow(y / 0.15, 2)); });
  const Driven set_down = drive(six_wheeler(), along, sandy_loam(), 0.0, {straight(2.0)});
  EXPECT_EQ(set_down.drive.end, DriveEnd::kImmobilised);
  EXPECT_EQ(set_down.drive.duration_s, 0.0);
  EXPECT_NE(set_down.drive.reason.find(" after 0.00 m"), std::string::npos) << set_down.drive.reason;
}

class Dismissed final : public Progress {
 public:
  void report(std::string_view, double) override {}
  bool cancelled() const override { return true; }
};

TEST(DynamicDrive, CanBeCancelled) {
  Dismissed progress;
  const DriveSoils soils{{sandy_loam()}, sandy_loam()};
  const FunctionGround level = plane(0.0);
  const auto drive = simulate_drive(six_wheeler(), kMars, level, soils, {}, std::vector{straight(1.0)}, {},
                                    nullptr, progress);
  ASSERT_FALSE(drive);
  EXPECT_EQ(drive.error().code, ErrorCode::kCancelled);
}

}  // namespace
}  // namespace slipway::sim
