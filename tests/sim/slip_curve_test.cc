// Ground that is known by the slip of rovers on slopes alone, at every level of fidelity.
#include "sim/soil/slip_curve.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/angle.h"
#include "sim/dynamic/dynamic_drive.h"
#include "sim/prediction/drive_prediction.h"
#include "sim/quasi_static/quasi_static.h"
#include "sim/quasi_static/slip_table.h"
#include "tests/sim/reference_models.h"

namespace slipway::sim {
namespace {

SlipCurve curve() {
  return {.slope_rad = {rad_from_deg(-20.0), 0.0, rad_from_deg(10.0), rad_from_deg(20.0)},
          .slip_ratio = {-0.1, 0.05, 0.2, 0.8},
          .cross_slope_rad = {0.0, rad_from_deg(20.0)},
          .side_slip_rad = {0.0, rad_from_deg(10.0)}};
}

SoilDistribution tabulated(double std_slip = 0.0) {
  SoilDistribution belief;
  belief.name = "tabulated";
  belief.mean.slip_curve = std::make_shared<const SlipCurve>(curve());
  belief.std.slip_ratio = std_slip;
  return belief;
}

StationState state_at(double pitch_deg, double roll_deg, double speed_m_s = 0.04,
                      const Soil& soil = tabulated().mean) {
  const RoverModel rover = six_wheeler();
  QuasiStaticSolver solver(rover, 3.71);
  const Attitude attitude{
      .roll_rad = rad_from_deg(roll_deg), .pitch_rad = rad_from_deg(pitch_deg), .yaw_rad = 0.0};
  return solver.solve(stance_on_plane(rover, attitude), soil, {.speed_m_s = speed_m_s});
}

TEST(SlipCurve, IsLinearBetweenTheSlopesAndSaysNothingBeyondThem) {
  EXPECT_DOUBLE_EQ(*curve().slip_at(rad_from_deg(10.0)), 0.2);
  EXPECT_NEAR(*curve().slip_at(rad_from_deg(15.0)), 0.5, 1e-12);
  EXPECT_DOUBLE_EQ(*curve().slip_at(rad_from_deg(20.0)), 0.8);
  EXPECT_FALSE(curve().slip_at(rad_from_deg(20.1)));
  EXPECT_FALSE(curve().slip_at(rad_from_deg(-21.0)));
  EXPECT_NEAR(*curve().side_slip_at(rad_from_deg(-10.0)), rad_from_deg(-5.0), 1e-12);
  EXPECT_TRUE(faults_of(curve()).empty());
}

TEST(SlipCurve, EveryFaultIsNamed) {
  SlipCurve bad = curve();
  bad.slope_rad = {0.3, 0.2};
  bad.cross_slope_rad.front() = 0.1;
  std::vector<std::string> pointers;
  for (const Fault& fault : faults_of(bad)) pointers.push_back(fault.pointer);
  EXPECT_EQ(pointers, (std::vector<std::string>{"/slip_curve/slip", "/slip_curve/slope_deg",
                                                "/slip_curve/slope_deg", "/slip_curve/cross_slope_deg"}));
}

TEST(SlipCurve, TheRoverSlipsAsTabulatedUphillDownhillAndBackwards) {
  const StationState up = state_at(-10.0, 0.0);  // nose up
  EXPECT_TRUE(up.moving() && up.by_slip_curve);
  EXPECT_NEAR(up.slip_ratio, 0.2, 1e-9);
  EXPECT_NEAR(up.along_m_s, 0.8 * 0.04, 1e-9);
  EXPECT_NEAR(state_at(10.0, 0.0).slip_ratio, -0.025, 1e-9);
  const StationState back = state_at(10.0, 0.0, -0.04);  // backwards up the slope
  EXPECT_NEAR(back.slip_ratio, 0.2, 1e-9);
  EXPECT_NEAR(back.along_m_s, -0.8 * 0.04, 1e-9);
}

TEST(SlipCurve, TheRoverSlidesDownhillAcrossASlopeWhicheverWayItDrives) {
  const StationState right = state_at(0.0, 10.0);  // left side up
  EXPECT_NEAR(right.side_slip_rad, rad_from_deg(-5.0), 1e-9);
  EXPECT_LT(right.leftward_m_s, 0.0);
  EXPECT_NEAR(state_at(0.0, -10.0).side_slip_rad, rad_from_deg(5.0), 1e-9);
  EXPECT_LT(state_at(0.0, 10.0, -0.04).leftward_m_s, 0.0);
}

TEST(SlipCurve, BeyondTheTabulatedSlopesNothingIsPredicted) {
  EXPECT_EQ(state_at(-21.0, 0.0).outcome, Outcome::kOutsideSlipCurve);
  EXPECT_EQ(state_at(0.0, 21.0).outcome, Outcome::kOutsideSlipCurve);
  EXPECT_EQ(describe(Outcome::kOutsideSlipCurve), "outside the slip curve");
}

TEST(SlipCurve, OnABorderTheSlowerMotionCounts) {
  const RoverModel rover = six_wheeler();
  QuasiStaticSolver solver(rover, 3.71);
  const Stance stance =
      stance_on_plane(rover, {.roll_rad = 0.0, .pitch_rad = rad_from_deg(-18.0), .yaw_rad = 0.0});
  PerWheel<Soil> soils(6, sandy_loam());
  const double on_loam = solver.solve(stance, soils, {}).slip_ratio;
  soils[0] = tabulated().mean;
  const StationState both = solver.solve(stance, soils, {});
  EXPECT_NEAR(both.slip_ratio, 0.68, 1e-9) << "the curve's, on loam it would be " << on_loam;
  EXPECT_TRUE(both.by_slip_curve);
  const Stance level = stance_on_plane(rover, {});
  Soil quick = tabulated().mean;
  auto none = std::make_shared<SlipCurve>(curve());
  none->slip_ratio = {0.0, 0.0, 0.0, 0.0};
  quick.slip_curve = none;
  soils[0] = quick;
  const StationState slower = solver.solve(level, soils, {});
  EXPECT_NEAR(slower.slip_ratio, solver.solve(level, sandy_loam(), {}).slip_ratio, 1e-6);
  EXPECT_TRUE(slower.by_slip_curve);
  EXPECT_EQ(slower.electric_power_w, 0.0);
}

TEST(SlipCurve, TheTableAgreesWithTheStations) {
  const SlipTable table(six_wheeler(), 3.71, tabulated().mean, rad_from_deg(25.0), rad_from_deg(2.5));
  for (const auto& [pitch, roll] : {std::pair{-10.0, 0.0}, {-12.5, 7.0}, {5.0, -3.0}}) {
    const StationState state = state_at(pitch, roll);
    const auto entry = table.at(rad_from_deg(pitch), rad_from_deg(roll));
    ASSERT_TRUE(entry);
    EXPECT_NEAR(entry->slip_ratio, state.slip_ratio, 1e-9);
    EXPECT_NEAR(entry->side_slip_rad, state.side_slip_rad, 1e-9);
    EXPECT_TRUE(entry->by_slip_curve && !entry->immobile);
  }
  EXPECT_TRUE(table.at(rad_from_deg(-21.0), 0.0)->immobile);
}

std::vector<PathStation> eastward(double length_m) {
  std::vector<PathStation> path;
  for (int k = 0; k <= static_cast<int>(4.0 * length_m); ++k)
    path.push_back({.pose = {0.25 * k, 0.0, 0.0}, .distance_m = 0.25 * k});
  return path;
}

TEST(SlipCurve, ADriveOnItHasSlipDurationAndRiskAndNoFiguresOfWheels) {
  const RoverModel rover = six_wheeler();
  const FunctionGround slope([](double x, double) { return std::tan(rad_from_deg(15.0)) * x; });
  NoProgress progress;
  const auto drive = predict_drive(rover, 3.71, slope, {{tabulated(0.1)}, tabulated(0.1)}, eastward(10.0), {},
                                   {.draws = 40}, 2, progress);
  ASSERT_TRUE(drive);
  EXPECT_NEAR(drive->mean_slip_ratio, 0.5, 1e-6);
  EXPECT_TRUE(drive->by_slip_curve);
  EXPECT_NEAR(drive->slip_curve_length_m, 10.0, 1e-9);
  EXPECT_EQ(drive->energy_j, 0.0);
  EXPECT_GT(drive->risk, 0.5) << "the slip limit of 0.4 is broken by the mean";
  EXPECT_GT(drive->stations[8].slip_ratio_p95, 0.55);
  EXPECT_LT(drive->stations[8].slip_ratio_p05, 0.45);
  const FunctionGround steep([](double x, double) { return std::tan(rad_from_deg(22.0)) * x; });
  const auto stopped = predict_drive(rover, 3.71, steep, {{tabulated()}, tabulated()}, eastward(10.0), {},
                                     {.draws = 0}, 1, progress);
  ASSERT_TRUE(stopped && stopped->immobilised);
  EXPECT_NE(stopped->immobilised->reason.find("outside the slip curve"), std::string::npos)
      << stopped->immobilised->reason;
}

TEST(SlipCurve, TheDynamicLevelRefusesItAndSaysWhy) {
  const RoverModel rover = six_wheeler();
  const FunctionGround level([](double, double) { return 0.0; });
  NoProgress progress;
  DriveLeg leg;
  leg.command.speed_m_s = 0.04;
  leg.length_m = 1.0;
  const auto drive = simulate_drive(
      rover, 3.71, level, {.known = {tabulated().mean}, .unknown = tabulated().mean}, {}, std::vector{leg},
      {}, [](const DriveSample&) {}, progress);
  ASSERT_FALSE(drive);
  EXPECT_EQ(drive.error().code, ErrorCode::kInvalidRequest);
  EXPECT_NE(drive.error().detail.find("slip curve"), std::string::npos) << drive.error().detail;
}

}  // namespace
}  // namespace slipway::sim
