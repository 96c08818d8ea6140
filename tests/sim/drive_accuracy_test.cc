// What the default tolerance costs and how near it ends to the exact drive.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "tests/sim/dynamic_drives.h"

namespace slipway::sim {
namespace {

// Bumps of this height (rms), some half a metre wide, on cells of 5 cm that are joined bilinearly, with
// normals that are continuous, as those of an elevation raster: its kinks are what the integrator has to
// follow.
class Bumps final : public Ground {
 public:
  explicit Bumps(double rms_m) : amplitude_m_(rms_m / std::sqrt(1.5)) {}
  std::optional<GroundPoint> at(double x, double y) const override {
    constexpr double kCell_m = 0.05;
    const double column = std::floor(x / kCell_m), row = std::floor(y / kCell_m);
    const double right = x / kCell_m - column, up = y / kCell_m - row;
    const auto corner = [&](int c, int r) { return wave((column + c) * kCell_m, (row + r) * kCell_m); };
    const double height = (1.0 - up) * ((1.0 - right) * corner(0, 0) + right * corner(1, 0)) +
                          up * ((1.0 - right) * corner(0, 1) + right * corner(1, 1));
    constexpr double h = 1e-5;
    const double east = (wave(x + h, y) - wave(x - h, y)) / (2.0 * h);
    const double north = (wave(x, y + h) - wave(x, y - h)) / (2.0 * h);
    return GroundPoint{height, Eigen::Vector3d(-east, -north, 1.0).normalized()};
  }
  std::optional<std::size_t> soil_at(double, double) const override { return 0; }

 private:
  double wave(double x, double y) const {
    return amplitude_m_ * (std::sin(6.1 * x + 2.3 * y) + std::sin(-4.7 * x + 5.9 * y + 1.0) +
                           std::sin(8.3 * x - 5.1 * y + 2.0));
  }
  double amplitude_m_;
};

DynamicDrive drive_with(const Ground& ground, double relative_tolerance, Feedback feedback) {
  DynamicOptions options{.relative_tolerance = relative_tolerance, .feedback = feedback};
  options.sample_interval_s = 10.0;
  return drive(six_wheeler(), ground, sandy_loam(), 0.1, {straight(4.0)}, options).drive;
}

TEST(DriveAccuracy, TheDefaultToleranceEndsWithinAMillimetreOfTheExactDrive) {
  for (const double rms_mm : {0.0, 5.0, 20.0}) {
    for (const Feedback feedback : {Feedback::kNone, Feedback::kPose}) {
      const Bumps ground(1e-3 * rms_mm);
      const DynamicDrive quick = drive_with(ground, DynamicOptions{}.relative_tolerance, feedback);
      const DynamicDrive exact = drive_with(ground, 1e-6, feedback);
      EXPECT_LT(std::hypot(quick.final.x_m - exact.final.x_m, quick.final.y_m - exact.final.y_m), 1e-3)
          << rms_mm << " mm, " << (feedback == Feedback::kPose ? "pose" : "no") << " feedback";
      EXPECT_NEAR(quick.energy_j / exact.energy_j, 1.0, 2e-3) << rms_mm;
    }
  }
}

// Speeds settle on the soil within a contact length: following each of their transients behind a kink of the
// ground took two to three times the steps and gained no place.
TEST(DriveAccuracy, StepsOverTheKinksOfARaster) {
  const DynamicDrive quick = drive_with(Bumps(0.02), DynamicOptions{}.relative_tolerance, Feedback::kPose);
  EXPECT_LT(static_cast<double>(quick.work.steps), 250.0 * 4.0);
}

// What was left over of each step's equations held itself at the tolerance: of these drives some took fifty
// times as many steps at one tolerance as at the next.
TEST(DriveAccuracy, NoToleranceTakesMoreThanFiveTimesTheStepsOfTheBest) {
  struct Case {
    double tilt_deg, yaw_deg;
    DriveLeg leg;
  };
  DriveLeg back = arc(2.0, 0.3);
  back.command.speed_m_s = -0.04;
  for (const Soil& soil : {sandy_loam(), loose_sand()})
    for (const Case& it :
         {Case{0.0, 180.0, back}, Case{8.0, 0.0, back}, Case{8.0, 0.0, arc(2.0, 0.5)},
          Case{0.0, 180.0, arc(2.0, -0.66)}, Case{14.0, 60.0, turn(1.0)}, Case{8.0, 180.0, arc(2.0, 0.5)}}) {
      long least = std::numeric_limits<long>::max(), most = 0;
      for (const double tolerance : {1e-2, 1e-3, 1e-4, 1e-5}) {
        const Driven driven = drive(six_wheeler(), plane(rad_from_deg(it.tilt_deg)), soil,
                                    rad_from_deg(it.yaw_deg), {it.leg}, {.relative_tolerance = tolerance});
        least = std::min(least, driven.drive.work.steps);
        most = std::max(most, driven.drive.work.steps);
      }
      EXPECT_LE(most, 5 * least) << it.tilt_deg << " " << it.yaw_deg << " " << it.leg.turn_rad;
    }
}

}  // namespace
}  // namespace slipway::sim
