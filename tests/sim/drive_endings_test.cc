#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/angle.h"
#include "sim/dynamic/cvode_integrator.h"
#include "sim/dynamic/rover_dynamics.h"
#include "sim/quasi_static/quasi_static.h"
#include "sim/rover/stance.h"
#include "tests/sim/dynamic_drives.h"

namespace slipway::sim {
namespace {

TEST(DriveEndings, AWeakMotorStallsAndTheReasonNamesIt) {
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
  ASSERT_EQ(driven.drive.end, DriveEnd::kImmobilised);
  EXPECT_NE(driven.drive.reason.find("stalls at its current limit of 0.12 A"), std::string::npos)
      << driven.drive.reason;
}

TEST(DriveEndings, AStallForWantOfVoltageIsCalledSo) {
  RoverModel rover = six_wheeler();
  rover.drive.resistance_ohm = 400.0;
  const Driven driven = drive(rover, plane(rad_from_deg(14.0)), sandy_loam(), 0.0, {straight(1.0)});
  ASSERT_EQ(driven.drive.end, DriveEnd::kImmobilised);
  EXPECT_NE(driven.drive.reason.find("stalls at the bus voltage of 28.0 V"), std::string::npos)
      << driven.drive.reason;
}

// A motor whose resistance is not given has no limit of its torque at any level of fidelity.
TEST(DriveEndings, AStandInForTheResistanceStopsNoDrive) {
  RoverModel rover = six_wheeler();
  rover.drive.gear_ratio = 20.0;
  QuasiStaticSolver solver(rover, kMars);
  const StationState balance = solver.solve(stance_on_plane(rover, {.pitch_rad = -rad_from_deg(14.0)}),
                                            sandy_loam(), {.speed_m_s = 0.04});
  ASSERT_TRUE(balance.moving());
  EXPECT_GT(balance.wheels[2].current_a, 10.0);  // more than the stand-in lets through
  const Driven driven = drive(rover, plane(rad_from_deg(14.0)), sandy_loam(), 0.0, {straight(1.0)});
  ASSERT_EQ(driven.drive.end, DriveEnd::kFinished) << driven.drive.reason;
  EXPECT_NEAR(driven.cruising().slip_ratio, balance.slip_ratio, 0.01);
}

// Rovers at rest are held by brakes: without friction in its motors a rover stands as still as with it, its
// motors take no current, and it starts from where it stood.
TEST(DriveEndings, BrakesHoldARoverAtRest) {
  RoverModel rover = six_wheeler();
  rover.drive.no_load_current_a = 0.0;
  rover.drive.gear_efficiency = 1.0;
  rover.drive.gear_ratio = 80.0;
  DynamicOptions options{.relative_tolerance = 1e-6, .feedback = Feedback::kNone, .sample_interval_s = 0.1};
  const Driven driven = drive(rover, plane(rad_from_deg(15.0)), sandy_loam(), 0.0, {straight(0.5)}, options);
  ASSERT_EQ(driven.drive.end, DriveEnd::kFinished) << driven.drive.reason;
  EXPECT_NEAR(driven.drive.start.x_m, 0.0, 0.01);  // the soil's own elastic shear
  for (const WheelState& wheel : driven.samples.front().wheels) {
    EXPECT_EQ(wheel.current_a, 0.0);
    EXPECT_NEAR(wheel.rate_rad_s, 0.0, 2e-4);
  }
  double least_m = 0.0;
  for (const DriveSample& sample : driven.samples) least_m = std::min(least_m, sample.progress_m);
  EXPECT_GT(least_m, -0.005);
}

// Half a metre of progress before the wheels dig themselves in does not make the whole leg driven.
TEST(DriveEndings, ARoverThatDugItselfInOnTheWayHasNotArrived) {
  const FunctionGround ramp(
      [](double x, double) { return x < 1.4 ? 0.0 : std::tan(rad_from_deg(24.0)) * (x - 1.4); });
  const Driven driven = drive(six_wheeler(), ramp, loose_sand(), 0.0, {straight(8.0)}, {.give_up_s = 600.0});
  EXPECT_GT(driven.drive.progress_m, 0.4);
  ASSERT_EQ(driven.drive.end, DriveEnd::kImmobilised);
  EXPECT_TRUE(driven.drive.reason.starts_with("no progress on the second half of leg 1 of 1 after "))
      << driven.drive.reason;
}

TEST(DriveEndings, GivesUpWhereItMakesNoProgress) {
  DynamicOptions options;
  options.give_up_s = 30.0;
  options.feedback = Feedback::kPose;
  const Driven driven =
      drive(six_wheeler(), plane(rad_from_deg(24.0)), loose_sand(), 0.0, {straight(3.0)}, options);
  EXPECT_EQ(driven.drive.end, DriveEnd::kImmobilised);
  EXPECT_NE(driven.drive.reason.find("no progress for 3"), std::string::npos) << driven.drive.reason;
  EXPECT_LT(driven.drive.duration_s, 200.0);
}

// A leg may end before give_up_s is over.
TEST(DriveEndings, IsNotFinishedWhereALegMadeNoProgress) {
  const std::vector<DriveLeg> legs{straight(1.0), straight(1.0, -0.04)};
  const Driven stuck = drive(six_wheeler(), plane(rad_from_deg(27.0)), loose_sand(), 0.0, legs);
  EXPECT_LT(stuck.drive.duration_s, 60.0);
  EXPECT_LT(stuck.drive.progress_m, 0.0);
  EXPECT_EQ(stuck.drive.end, DriveEnd::kImmobilised);
  EXPECT_TRUE(stuck.drive.reason.starts_with("no progress on leg 1 of 2 after ")) << stuck.drive.reason;
  EXPECT_GE(stuck.drive.max_current_a.distance_m, 0.0);
  // A rover whose command is smaller than the soil's elastic displacement has not failed.
  const Driven short_one =
      drive(six_wheeler(), plane(rad_from_deg(20.0)), loose_sand(), 0.0, {straight(0.01)});
  EXPECT_LT(short_one.drive.progress_m, 0.0);
  EXPECT_EQ(short_one.drive.end, DriveEnd::kFinished);
}

TEST(DriveEndings, DoesNotGiveUpOnASlowDrive) {
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

TEST(DriveEndings, RefusesAStartThatIsImpossible) {
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

TEST(DriveEndings, ReportsARoverThatDoesNotComeToRest) {
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

// A rover that only rocks on its wheels does not slide, and steeper ground does not stop a sliding one.
TEST(DriveEndings, ARoverThatSlidesAlsoSlidesOnSteeperGround) {
  for (const double yaw_deg : {0.0, 180.0}) {
    bool slid = false;
    for (double tilt_deg = 31.0; tilt_deg <= 61.0; tilt_deg += 3.0) {
      const Driven driven = drive(heavy_wheeler(), plane(rad_from_deg(tilt_deg)), sandy_loam(),
                                  rad_from_deg(yaw_deg), {straight(0.02)});
      const bool slides = driven.drive.end == DriveEnd::kSlid || driven.drive.end == DriveEnd::kTipped;
      EXPECT_TRUE(slides || !slid) << yaw_deg << " " << tilt_deg;
      slid = slides;
    }
    EXPECT_TRUE(slid) << yaw_deg;
  }
}

Soil dry_sand() {
  return make_soil({990.0, 1.528e6, 1.1}, 1040.0, 28.0, 0.0152, 0.18, 0.32);
}

// How far a braked rover goes from 20 s after it was put down to 80 s.
double crept_m(double tilt_deg, double yaw_deg) {
  const RoverModel rover = six_wheeler();
  const FunctionGround ground = plane(rad_from_deg(tilt_deg));
  const DriveSoils soils{{dry_sand()}, dry_sand()};
  const DynamicOptions options;
  RoverDynamics dynamics(rover, kMars, ground, soils, options);
  CvodeIntegrator integrator(
      {.size = dynamics.size(),
       .absolute_only = dynamics.pose_size(),
       .derivative = [&](double t, const double* y, double* rate) { return dynamics.derivative(t, y, rate); },
       .event_count = 0,
       .events = {}},
      options.relative_tolerance, dynamics.tolerances(options.relative_tolerance, false), 1.0);
  const std::vector<double> put_down =
      dynamics.at_rest(*settle(rover, ground, {0.0, 0.0, rad_from_deg(yaw_deg)}));
  dynamics.halt(PerWheel<double>(rover.wheels.size()));
  dynamics.after_step(0.0, put_down.data());
  integrator.start(0.0, put_down);
  Pose2 from;
  for (const double until_s : {20.0, 80.0})
    for (double t = 0.0; t < until_s; dynamics.after_step(t, integrator.state().data())) {
      if (until_s > 20.0 && t == 0.0) from = dynamics.pose(integrator.state().data());
      const auto step = integrator.step(until_s);
      if (!step) return std::numeric_limits<double>::infinity();
      t = step->t;
    }
  const Pose2 at = dynamics.pose(integrator.state().data());
  return std::hypot(at.x_m - from.x_m, at.y_m - from.y_m);
}

// Its brakes gave way to and fro, and with each swing the soil's resistance turned round and fed the next: it
// crept by half a millimetre a second on slopes that it can hold, and slid on 26 deg where it held on 28.
TEST(DriveEndings, ABrakedRoverStandsOnWhatItCanHoldAndSlidesOnWhatIsSteeper) {
  for (const double yaw_deg : {0.0, 180.0})
    for (const double tilt_deg : {22.0, 26.0, 30.0, 34.0})
      EXPECT_LT(crept_m(tilt_deg, yaw_deg), 5e-5) << yaw_deg << " " << tilt_deg;
  for (const double yaw_deg : {0.0, 45.0, 90.0, 180.0}) {
    bool slid = false;
    for (double tilt_deg = 10.0; tilt_deg <= 60.0; tilt_deg += 4.0) {
      const Driven driven = drive(six_wheeler(), plane(rad_from_deg(tilt_deg)), dry_sand(),
                                  rad_from_deg(yaw_deg), {straight(0.02)});
      const bool slides = driven.drive.end == DriveEnd::kSlid || driven.drive.end == DriveEnd::kTipped;
      EXPECT_TRUE(slides || !slid) << yaw_deg << " " << tilt_deg;
      slid = slides;
    }
    EXPECT_TRUE(slid) << yaw_deg;
  }
}

// The figures are those of the cruise: after the halt no wheel slips and no motor takes a current.
TEST(DriveEndings, AnImmobilisedRoverReportsItsSlipAndCurrentsBeforeTheHalt) {
  const Soil soft = make_soil({5471.0, 234221.0, 0.91}, 383.0, 19.1, 0.0133, 0.285, 0.32);
  const Driven driven = drive(six_wheeler(), plane(rad_from_deg(16.0)), soft, 0.0, {straight(0.8)});
  ASSERT_EQ(driven.drive.end, DriveEnd::kImmobilised);
  ASSERT_LT(driven.drive.duration_s, DynamicOptions{}.give_up_s);
  const std::string& reason = driven.drive.reason;
  EXPECT_NE(reason.find(fmt::format("slip {:.2f}, deepest", driven.cruising().slip_ratio)), std::string::npos)
      << reason;
  EXPECT_EQ(reason.find(" 0.00 A"), std::string::npos) << reason;
}

TEST(DriveEndings, EndsWithItsBellyOnARidge) {
  // The ridge is between the wheels, which roll past it, or lies across the way, so that they roll over it.
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
  // A rover that is set down on a ridge is immobilised at once.
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

TEST(DriveEndings, CanBeCancelled) {
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
