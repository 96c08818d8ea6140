#include "sim/prediction/drive_prediction.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/angle.h"
#include "tests/sim/reference_models.h"

namespace slipway::sim {
namespace {

std::vector<PathStation> eastward(double length_m, double spacing_m = 0.25) {
  std::vector<PathStation> path;
  const int n = static_cast<int>(std::round(length_m / spacing_m));
  for (int k = 0; k <= n; ++k)
    path.push_back({.pose = {k * spacing_m, 0.0, 0.0}, .distance_m = k * spacing_m});
  return path;
}

class Cancelled final : public Progress {
 public:
  void report(std::string_view, double) override {}
  bool cancelled() const override { return true; }
};

const RoverModel kRover = six_wheeler();
const SoilBeliefs kLoam{{certain("loam", sandy_loam())}, spread("unknown_ground", loose_sand(), 0.5)};

Result<DrivePrediction> predict(const Ground& ground, const SoilBeliefs& beliefs,
                                const std::vector<PathStation>& path, const RiskOptions& risk = {},
                                const DriveLimits& limits = {}, std::size_t threads = 0) {
  NoProgress progress;
  return predict_drive(kRover, 3.71, ground, beliefs, path, limits, risk, threads, progress);
}

TEST(DrivePrediction, OnThePlaneTheTotalsFollowFromOneStation) {
  const FunctionGround plane([](double x, double) { return std::tan(0.15) * x; });
  const auto drive = predict(plane, kLoam, eastward(10.0));
  ASSERT_TRUE(drive);
  const StationState& state = drive->stations.front().state;
  EXPECT_NEAR(drive->length_m, 10.0, 1e-9);
  EXPECT_NEAR(drive->mean_slip_ratio, state.slip_ratio, 1e-6);
  EXPECT_NEAR(drive->duration_s, 10.0 / std::cos(0.15) / state.forward_m_s, 1e-3);
  EXPECT_NEAR(drive->energy_j, drive->duration_s * state.electric_power_w, 1e-2);
  EXPECT_GT(drive->energy_j, 174.0 * 3.71 * 10.0 * std::tan(0.15)) << "more than lifting the rover takes";
  EXPECT_FALSE(drive->immobilised);
}

// Up the same slope the rover gets or does not, as c1 and c2 are.
TEST(DrivePrediction, SaysWhereC1AndC2DecideWhetherItsLimitsAreKept) {
  SoilDistribution loam = certain("loam", sandy_loam());
  loam.std.c1 = 0.25;
  loam.std.c2 = 0.1;
  const auto on = [&](double slope_deg, const SoilDistribution& soil) {
    const FunctionGround plane([&](double x, double) { return std::tan(rad_from_deg(slope_deg)) * x; });
    return *predict(plane, {{soil}, soil}, eastward(4.0), {.draws = 2});
  };
  // Where a file gives them no spread, it is that between soils.
  const auto between = on(5.0, certain("loam", sandy_loam())).closures;
  ASSERT_TRUE(between);
  EXPECT_GT(between->greatest.c1 - between->least.c1, 0.2);
  EXPECT_FALSE(
      predict(FunctionGround([](double, double) { return 0.0; }), {{loam}, loam}, eastward(4.0), {.draws = 0})
          ->closures);
  int decided = 0;
  for (double slope_deg = 0.0; slope_deg <= 24.0; slope_deg += 2.0) {
    const auto closures = on(slope_deg, loam).closures;
    ASSERT_TRUE(closures);
    EXPECT_LT(closures->least.c1 + 0.5 * closures->least.c2, loam.mean.c1 + 0.5 * loam.mean.c2);
    EXPECT_GT(closures->greatest.c1 + 0.5 * closures->greatest.c2, loam.mean.c1 + 0.5 * loam.mean.c2);
    decided += closures->decides() ? 1 : 0;
    if (slope_deg == 0.0) {
      EXPECT_FALSE(closures->decides());
    }
  }
  EXPECT_GE(decided, 1);
  EXPECT_LE(decided, 8);
}

TEST(DrivePrediction, NamesItsWheelsAndGivesEachStationAsMany) {
  const RoverModel rover = four_wheeler(SuspensionType::kRigid);
  const FunctionGround level([](double, double) { return 0.0; });
  NoProgress progress;
  const auto drive = predict_drive(rover, 3.71, level, kLoam, eastward(2.0), {}, {.draws = 2}, 1, progress);
  ASSERT_TRUE(drive);
  EXPECT_EQ(drive->wheel_names, (std::vector<std::string>{"lf", "lr", "rf", "rr"}));
  for (const StationPrediction& station : drive->stations) EXPECT_EQ(station.state.wheels.size(), 4u);
  EXPECT_EQ(drive->draws, 2);
}

TEST(DrivePrediction, AStationInCrabMotionIsDrivenAlongItsDirection) {
  std::vector<PathStation> path = eastward(3.0);
  for (PathStation& station : path) {
    station.crab_rad = rad_from_deg(25.0);
    station.pose.yaw_rad = -station.crab_rad;  // the body points away from where it goes
  }
  const FunctionGround level([](double, double) { return 0.0; });
  const auto crab = predict(level, kLoam, path, {.draws = 0});
  const auto straight = predict(level, kLoam, eastward(3.0), {.draws = 0});
  ASSERT_TRUE(crab && straight);
  const StationState& state = crab->stations.back().state;
  EXPECT_NEAR(std::atan2(state.leftward_m_s, state.forward_m_s), rad_from_deg(25.0) + state.side_slip_rad,
              1e-9);
  EXPECT_GT(crab->duration_s, straight->duration_s) << "the middle wheels are not steered: they are dragged";
}

TEST(DrivePrediction, ColdMotorsCostEnergyAndNoSlip) {
  RoverModel rover = six_wheeler();
  rover.drive.friction_per_k = 0.01;
  const FunctionGround level([](double, double) { return 0.0; });
  const auto energy_at = [&](double motor_temp_c) {
    NoProgress progress;
    const auto drive = predict_drive(rover, 3.71, level, kLoam, eastward(2.0), {}, {.draws = 0}, 1, progress,
                                     {.motor_temp_c = motor_temp_c});
    return std::pair(drive->energy_j, drive->mean_slip_ratio);
  };
  EXPECT_GT(energy_at(-60.0).first, energy_at(20.0).first);
  EXPECT_EQ(energy_at(-60.0).second, energy_at(20.0).second);
}

TEST(DrivePrediction, ASteepeningSlopeImmobilisesWithThePlaceAndTheReason) {
  const FunctionGround bowl([](double x, double) { return 0.025 * x * x; });  // slope 0.05 x
  const auto drive = predict(bowl, kLoam, eastward(16.0));
  ASSERT_TRUE(drive);
  ASSERT_TRUE(drive->immobilised);
  EXPECT_GT(drive->immobilised->distance_m, 6.0);
  EXPECT_LT(drive->immobilised->distance_m, 12.0);
  EXPECT_NE(drive->immobilised->reason.find("no traction"), std::string::npos) << drive->immobilised->reason;
  EXPECT_EQ(drive->stations.back().station.distance_m, drive->immobilised->distance_m)
      << "the stations end there";
  EXPECT_EQ(drive->risk, 1.0);
}

TEST(DrivePrediction, APathThatLeavesTheGroundIsRefusedWithTheStations) {
  const FunctionGround small([](double, double) { return 0.0; }, 5.0);
  const auto drive = predict(small, kLoam, eastward(6.0));
  ASSERT_FALSE(drive);
  EXPECT_EQ(drive.error().code, ErrorCode::kNoData);
  EXPECT_EQ(drive.error().faults.front().pointer, "/stations/18")
      << "the front wheels reach 5 m at station 18, 4.5 m";
}

TEST(DrivePrediction, TheSameSeedGivesTheSameBytesOnAnyNumberOfThreads) {
  const FunctionGround hills([](double x, double y) { return 0.2 * std::sin(0.7 * x) * std::cos(0.5 * y); });
  const SoilBeliefs beliefs{{spread("loam", sandy_loam(), 0.4)}, spread("unknown_ground", loose_sand(), 0.5)};
  const auto one = predict(hills, beliefs, eastward(12.0), {}, {}, 1);
  const auto four = predict(hills, beliefs, eastward(12.0), {}, {}, 4);
  ASSERT_TRUE(one && four);
  EXPECT_EQ(one->duration_s_p95, four->duration_s_p95);
  for (std::size_t k = 0; k < one->stations.size(); ++k) {
    EXPECT_EQ(one->stations[k].slip_ratio_p95, four->stations[k].slip_ratio_p95);
    EXPECT_EQ(one->stations[k].state.slip_ratio, four->stations[k].state.slip_ratio);
  }
}

TEST(DrivePrediction, CertainSoilHasNoSpreadAndUncertainSoilHas) {
  const FunctionGround plane([](double x, double) { return 0.2 * x; });
  const auto sure = predict(plane, kLoam, eastward(5.0));
  EXPECT_NEAR(sure->stations[9].slip_ratio_p95, sure->stations[9].slip_ratio_p05, 1e-6);
  const auto unsure = predict(plane, {{spread("loam", sandy_loam(), 0.4)}, kLoam.unknown}, eastward(5.0));
  EXPECT_GT(unsure->stations[9].slip_ratio_p95, unsure->stations[9].slip_ratio_p05 + 0.02);
  EXPECT_LE(unsure->risk_low, unsure->risk);
  EXPECT_GE(unsure->risk_high, unsure->risk);
}

TEST(DrivePrediction, UnknownGroundIsCountedAndDrivenUnderTheWidestBelief) {
  const FunctionGround::SoilIndex known_until_5 = [](double x, double) {
    return x < 5.0 ? std::optional<std::size_t>(0) : std::nullopt;
  };
  const FunctionGround plane([](double x, double) { return 0.15 * x; }, 1e6, known_until_5);
  const auto drive = predict(plane, kLoam, eastward(10.0));
  ASSERT_TRUE(drive);
  EXPECT_NEAR(drive->unknown_length_m, 5.7, 0.3) << "from where the front wheels enter it";
  EXPECT_FALSE(drive->stations.back().soil);
  EXPECT_GT(drive->stations.back().slip_ratio_p95 - drive->stations.back().slip_ratio_p05, 0.01);
  EXPECT_NEAR(drive->stations[4].slip_ratio_p95, drive->stations[4].slip_ratio_p05, 1e-6);
}

TEST(DrivePrediction, EveryBrokenLimitIsNamedWithItsPlace) {
  const FunctionGround plane([](double x, double) { return 0.3 * x; });
  DriveLimits tight;
  tight.max_slip_ratio = 0.1;
  tight.max_tilt_rad = rad_from_deg(10.0);
  tight.max_current_a = 0.1;
  tight.max_sinkage_m = 0.005;
  tight.min_clearance_m = 0.9;
  const auto drive = predict(plane, kLoam, eastward(4.0), {}, tight);
  ASSERT_TRUE(drive);
  ASSERT_EQ(drive->broken_limits.size(), 5u);
  const std::string tilt = describe(drive->broken_limits[1]);
  EXPECT_TRUE(tilt.starts_with("tilt 16.8 deg at ")) << tilt;  // 16.7 and the lean
  EXPECT_TRUE(tilt.ends_with(", limit 10 deg")) << tilt;
  EXPECT_EQ(drive->risk, 1.0);
}

// A tilt that only 20 cm of the way have: whatever the length of the path, it is found.
TEST(DrivePrediction, NoPathPassesAPeakByItsSampling) {
  const FunctionGround ridge(
      [](double x, double) { return 0.12 * std::exp(-std::pow((x - 7.3) / 0.35, 2)); });
  double least = 1.0, most = 0.0;
  for (double length = 12.0; length < 12.6; length += 0.07) {
    const auto drive = predict(ridge, kLoam, eastward(length), {}, {.max_tilt_rad = rad_from_deg(4.5)});
    ASSERT_TRUE(drive);
    least = std::min(least, drive->max_tilt_rad.value);
    most = std::max(most, drive->max_tilt_rad.value);
  }
  EXPECT_LT(most - least, rad_from_deg(0.15));
}

TEST(DrivePrediction, EnergyAndTimeHaveBudgets) {
  const FunctionGround plane([](double x, double) { return 0.1 * x; });
  const auto whole = predict(plane, kLoam, eastward(20.0));
  ASSERT_TRUE(whole);
  EXPECT_TRUE(whole->broken_limits.empty());
  const auto late = predict(plane, kLoam, eastward(20.0), {}, {.max_drive_s = 0.5 * whole->duration_s});
  ASSERT_EQ(late->broken_limits.size(), 1u);
  EXPECT_EQ(late->broken_limits[0].rule, Rule::kDriveTime);
  EXPECT_NEAR(late->broken_limits[0].value, whole->duration_s, 0.51 * whole->duration_s);
  const auto empty = predict(plane, kLoam, eastward(20.0), {}, {.max_energy_j = 0.5 * whole->energy_j});
  ASSERT_EQ(empty->broken_limits.size(), 1u);
  EXPECT_EQ(empty->broken_limits[0].rule, Rule::kEnergy);
}

TEST(DrivePrediction, ATurnInPlaceTakesTimeAndNoDistance) {
  const FunctionGround plane([](double, double) { return 0.0; });
  std::vector<PathStation> path = eastward(1.0);
  for (int k = 1; k <= 6; ++k)
    path.push_back({.pose = {1.0, 0.0, k * rad_from_deg(15.0)},
                    .distance_m = 1.0,
                    .turned_rad = rad_from_deg(15.0),
                    .turning_in_place = true});
  const auto drive = predict(plane, kLoam, path);
  ASSERT_TRUE(drive);
  EXPECT_NEAR(drive->length_m, 1.0, 1e-12);
  EXPECT_NEAR(drive->turned_rad, rad_from_deg(90.0), 1e-12);
  EXPECT_GT(drive->duration_s, 1.0 / 0.04 + rad_from_deg(90.0) / 0.03);
}

TEST(DrivePrediction, CancelledWorkEndsWithThatError) {
  const FunctionGround plane([](double, double) { return 0.0; });
  Cancelled progress;
  const auto drive = predict_drive(kRover, 3.71, plane, kLoam, eastward(5.0), {}, {}, 0, progress);
  ASSERT_FALSE(drive);
  EXPECT_EQ(drive.error().code, ErrorCode::kCancelled);
}

}  // namespace
}  // namespace slipway::sim
