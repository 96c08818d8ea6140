#include <gtest/gtest.h>

#include <cmath>

#include "core/angle.h"
#include "tests/sim/dynamic_drives.h"

namespace slipway::sim {
namespace {

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

// The integrator's error control must not depend on the values of position and heading.
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

TEST(DynamicDrive, WithPoseFeedbackItEndsWhereItsLegEnds) {
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

// Down a cross slope the rover leaves each short leg further than the next one is long: a leg that begins
// behind its end must end there, and a small turn that is overshot must be taken back, not made a whole one.
TEST(DynamicDrive, WithPoseFeedbackAChainOfShortLegsIsNeverLeft) {
  DynamicOptions options;
  options.feedback = Feedback::kPose;
  std::vector<DriveLeg> legs{straight(1.0)};
  for (int k = 0; k < 12; ++k) {
    legs.push_back(turn(k % 2 == 0 ? 1.5 : 0.01, k % 4 < 2 ? 0.03 : -0.03));
    legs.push_back(straight(0.03));
  }
  for (const double slope_deg : {4.0, 14.0}) {
    const Driven driven =
        drive(six_wheeler(), plane(rad_from_deg(slope_deg)), sandy_loam(), rad_from_deg(90.0), legs, options);
    EXPECT_EQ(driven.drive.end, DriveEnd::kFinished) << driven.drive.reason;
    EXPECT_NEAR(driven.drive.progress_m, driven.drive.commanded_m, 1e-9);
    EXPECT_LT(std::hypot(driven.drive.final.x_m - driven.drive.commanded.x_m,
                         driven.drive.final.y_m - driven.drive.commanded.y_m),
              1.0)
        << slope_deg;
    EXPECT_LT(driven.drive.duration_s, 3000.0);
  }
}

TEST(DynamicDrive, WithPoseFeedbackALongCrossSlopeIsTrimmedAway) {
  DynamicOptions options;
  options.feedback = Feedback::kPose;
  const Driven driven = drive(six_wheeler(), plane(rad_from_deg(15.0)), sandy_loam(), rad_from_deg(90.0),
                              {straight(30.0)}, options);
  ASSERT_EQ(driven.drive.end, DriveEnd::kFinished) << driven.drive.reason;
  EXPECT_LT(std::abs(driven.drive.commanded.x_m - driven.drive.final.x_m), 0.1);
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

// For wheels in one line, the ruts follow the same rule as at the quasi-static level.
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

// Sliding down across a slope, wheels stand in tracks with a part of their width.
TEST(DynamicDrive, AcrossASlopeLaterWheelsMeetAsMuchOfTheTracksAsInTheBalance) {
  const RoverModel rover = six_wheeler();
  Soil soil = sandy_loam();
  soil.multipass_stiffening = 2.0;
  DynamicOptions options;
  options.contact_points = 1;
  const FunctionGround slope = plane(rad_from_deg(12.0));
  for (const double yaw_deg : {90.0, -90.0}) {
    const Driven driven = drive(rover, slope, soil, rad_from_deg(yaw_deg), {straight(2.5)}, options);
    const DriveSample& sample = driven.cruising();
    const auto stance = settle(rover, slope, {0.0, 0.0, sample.attitude.yaw_rad});
    ASSERT_TRUE(stance);
    const StationState balance = QuasiStaticSolver(rover, kMars).solve(*stance, soil, {});
    ASSERT_GT(std::abs(balance.side_slip_rad), rad_from_deg(5.0));
    for (std::size_t k = 0; k < 6; ++k) {
      EXPECT_NEAR(sample.wheels[k].sinkage_m, balance.wheels[k].sinkage_m, 2e-4) << k;
      EXPECT_NEAR(sample.wheels[k].current_a, balance.wheels[k].current_a, 5e-3) << k;
    }
    EXPECT_NEAR(sample.slip_ratio, balance.slip_ratio, 1e-3);
    EXPECT_NEAR(std::atan2(sample.velocity_B.y(), sample.velocity_B.x()), balance.side_slip_rad,
                rad_from_deg(0.1));
  }
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

TEST(DynamicDrive, ItsMaximaDoNotDependOnTheSampleInterval) {
  const FunctionGround hills([](double x, double y) { return 0.1 * std::sin(2.0 * x) * std::cos(3.0 * y); });
  DynamicOptions often, once;
  often.sample_interval_s = 0.01;
  once.sample_interval_s = 1000.0;
  const std::vector<DriveLeg> legs{arc(1.5, 0.2), turn(0.3)};
  const Driven fine = drive(six_wheeler(), hills, loose_sand(), 0.3, legs, often);
  const DynamicDrive coarse = drive(six_wheeler(), hills, loose_sand(), 0.3, legs, once).drive;
  EXPECT_EQ(coarse.max_current_a.value, fine.drive.max_current_a.value);
  EXPECT_EQ(coarse.max_sinkage_m.value, fine.drive.max_sinkage_m.value);
  EXPECT_EQ(coarse.max_slip_ratio.value, fine.drive.max_slip_ratio.value);
  EXPECT_EQ(coarse.max_tilt_rad.value, fine.drive.max_tilt_rad.value);
}

// The greatest figures are taken at the integrator's steps, and something may be greater between two of them.
// Sinkage and tilt follow the ground, so that is little: below 0.1 %. Interpolated currents are up to 1.5 %
// greater at the default tolerance, and 0.01 % at 1e-5.
//
// Slip is different. It is defined once the rates are above half of what is commanded, and there it is
// greatest, for the wheels turn up faster than the rover follows: in this turn 0.325 at that moment, at any
// tolerance, and 0.3045 only 50 ms later. The first step after that moment sees what is left by then, from
// 0.302 to 0.325 as tolerance and rounding place it. So the figure at the steps lies between the greatest
// slip ever and the greatest one later than the longest step there, which is below 0.1 s. Compiled with -O1
// and -O2, at six tolerances from 1e-3 to 1e-8, it does.
TEST(DynamicDrive, ItsGreatestFiguresAreThoseOfDenseSamples) {
  const FunctionGround hills([](double x, double y) { return 0.1 * std::sin(2.0 * x) * std::cos(3.0 * y); });
  DynamicOptions options;
  options.sample_interval_s = 0.01;
  const Driven driven = drive(six_wheeler(), hills, loose_sand(), 0.3, {arc(1.5, 0.2), turn(0.3)}, options);
  Peak current, sinkage, slip, later_slip, tilt;
  double set_off_s = 0.0;
  bool was_driving = false;
  for (const DriveSample& sample : driven.samples) {
    tilt.raise(sample.attitude.tilt_rad(), 0.0);
    if (sample.driving && !was_driving) set_off_s = sample.time_s;
    was_driving = sample.driving;
    if (sample.driving) {
      slip.raise(std::abs(sample.slip_ratio), 0.0);
      if (sample.time_s > set_off_s + 0.1) later_slip.raise(std::abs(sample.slip_ratio), 0.0);
    }
    for (const WheelState& wheel : sample.wheels) {
      current.raise(std::abs(wheel.current_a), 0.0);
      sinkage.raise(wheel.sinkage_m, 0.0);
    }
  }
  const DynamicDrive& greatest = driven.drive;
  EXPECT_NEAR(greatest.max_current_a.value / current.value, 1.0, 0.03);
  EXPECT_NEAR(greatest.max_sinkage_m.value / sinkage.value, 1.0, 0.003);
  EXPECT_NEAR(greatest.max_tilt_rad.value / tilt.value, 1.0, 0.003);
  EXPECT_LT(greatest.max_slip_ratio.value, 1.02 * slip.value);
  EXPECT_GT(greatest.max_slip_ratio.value, 0.99 * later_slip.value);
}

TEST(DynamicDrive, CountsEnergyAndEncodersFromTheStartOfTime) {
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
  // A rover that slides while it settles has used no energy.
  const Driven slid = drive(six_wheeler(), plane(rad_from_deg(50.0)), loose_sand(), 0.0, {straight(1.0)});
  ASSERT_EQ(slid.drive.end, DriveEnd::kSlid);
  EXPECT_EQ(slid.drive.energy_j, 0.0);
}

}  // namespace
}  // namespace slipway::sim
