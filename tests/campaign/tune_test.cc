#include "campaign/tune.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "core/angle.h"
#include "core/random.h"
#include "tables.h"

namespace slipway::campaign {
namespace {

// Six drives of 2 m on two tilts: straight up, straight across, and an arc. One point under a wheel is enough
// on planes.
const std::string kSixDrives = R"({
  "format": "campaign-table/1", "name": "six", "summary": "six drives", "sources": [],
  "rover": "fido-class", "gravity_m_s2": 9.81, "seed": 7, "simulation": {"contact_points": 1},
  "terrains": [{"name": "gentle", "soil": "dry_sand", "tilt_deg": 4, "size_m": 12, "cell_m": 0.5},
               {"name": "steep", "soil": "dry_sand", "tilt_deg": 8, "size_m": 12, "cell_m": 0.5}],
  "drives": [{"id": "straight", "headings_deg": [0, 90], "legs": [{"length_m": 2.0}]},
             {"id": "arc", "legs": [{"length_m": 2.0, "curvature_1_m": 0.4}]}]})";

gap::TunedParameter parameter(std::string name, double lowest, double highest, int coarse = 3, int fine = 3) {
  return {{.name = std::move(name), .lowest = lowest, .highest = highest, .coarse = coarse, .fine = fine},
          {}};
}

// A simulator that costs nothing: the rover falls short by the slope over the friction.
Result<sim::DynamicDrive> toy(const sim::RoverModel&, double, const sim::Ground& ground,
                              const sim::DriveSoils& soils, const Pose2& start,
                              std::span<const sim::DriveLeg> legs, const sim::DynamicOptions&,
                              const sim::DriveSink&, Progress&) {
  const double slope = std::acos(ground.at(start.x_m, start.y_m)->normal.z());
  const double slip = std::tan(slope) / std::tan(soils.unknown.friction_angle_rad) + soils.unknown.n1;
  sim::DynamicDrive drive;
  drive.start = start;
  drive.final = sim::commanded_pose(legs[0], start, 1.0 - slip);
  return drive;
}

MeasuredFinals finals_of(const DriveTable& table, Simulator simulator, double noise_m) {
  MeasuredFinals finals;
  std::uint64_t counter = 0;
  for (const TableDrive& drive : expand(table)) {
    NoProgress progress;
    const MadeDrive made = make_drive(table, drive, simulator, progress);
    EXPECT_TRUE(made.drive) << made.drive.error().detail;
    Pose2 end = made.drive ? made.drive->final : Pose2{};
    end.x_m += noise_m * random_normal(5, counter++);
    end.y_m += noise_m * random_normal(5, counter++);
    end.yaw_rad += noise_m * random_normal(5, counter++);
    finals[drive.id] = end;
  }
  return finals;
}

TEST(Tune, NamesAreTheSweepsAndEveryEffectThatIsNotOfAPlace) {
  EXPECT_EQ(tuning_field("soil.friction_angle_deg")->unit, "deg");
  EXPECT_TRUE(tuning_field("soil.shear_modulus_m"));
  EXPECT_TRUE(tuning_field("effects.slip_sinkage.n1"));
  EXPECT_FALSE(tuning_field("effects.soft_patch.radius_m"));
  EXPECT_FALSE(tuning_field("load_n"));
  EXPECT_FALSE(tuning_field("effects.slip_sinkage"));
  for (const std::string& name : tuning_field_names()) EXPECT_TRUE(tuning_field(name)) << name;
}

TEST(Tune, EveryNameChangesTheTable) {
  const DriveTable table = *read_table(kSixDrives);
  for (const std::string& name : tuning_field_names()) {
    DriveTable changed = table;
    set_tuned(name, tuning_field(name)->highest, changed);
    if (name.starts_with("effects.")) {
      ASSERT_EQ(changed.effects.size(), 1U) << name;
      EXPECT_TRUE(changed.effects[0].on);
      EXPECT_EQ(changed.effects[0].parameters.begin()->second, tuning_field(name)->highest);
    } else {
      const sim::Soil &before = table.soils.begin()->second.mean, &after = changed.soils.begin()->second.mean;
      EXPECT_NE(std::memcmp(&before, &after, sizeof(sim::Soil)), 0) << name;
    }
  }
}

TEST(Tune, RepeatsAreOneDriveAndTheUnmeasuredAreLeftOut) {
  DriveTable table = *read_table(kSixDrives);
  table.entries[0].repeats = 3;
  const auto drives = expand(table);
  MeasuredFinals finals = finals_of(table, &toy, 0.001);
  finals.erase("arc-steep");
  NoProgress progress;
  TuneRequest request{.parameters = {parameter("soil.friction_angle_deg", 25.0, 45.0),
                                     parameter("effects.slip_sinkage.n1", 0.0, 0.2)},
                      .options = {},
                      .simulator = &toy};
  const auto result = tune(table, drives, finals, request, progress);
  ASSERT_TRUE(result) << result.error().detail;
  ASSERT_EQ(result->drives.size(), 5U);
  EXPECT_EQ(result->drives[0].finals.size(), 3U);
  EXPECT_EQ(result->drives[0].name, "straight-gentle-h000-r1");
  EXPECT_EQ(result->unmeasured, (std::vector<std::string>{"arc-steep"}));
  ASSERT_EQ(result->tuning.tilts.size(), 2U);
  EXPECT_NEAR(deg_from_rad(result->tuning.tilts[1].tilt_rad), 8.0, 0.01);
  EXPECT_EQ(result->tuning.tilts[0].drives.size(), 3U);
}

TEST(Tune, RefusesNamesRangesSoilsAndNothingMeasured) {
  DriveTable table = *read_table(kSixDrives);
  const auto drives = expand(table);
  const MeasuredFinals finals = finals_of(table, &toy, 0.0);
  NoProgress progress;
  TuneRequest request{.parameters = {parameter("soil.friction", 25.0, 45.0),
                                     parameter("soil.friction_angle_deg", 25.0, 95.0)},
                      .options = {},
                      .simulator = &toy};
  const auto names = tune(table, drives, finals, request, progress);
  ASSERT_FALSE(names);
  ASSERT_EQ(names.error().faults.size(), 2U);
  EXPECT_EQ(names.error().faults[0].pointer, "/parameters/0/name");
  EXPECT_EQ(names.error().faults[1].pointer, "/parameters/1/highest");
  request.parameters = {parameter("soil.friction_angle_deg", 25.0, 45.0)};
  const auto nothing = tune(table, drives, {{"no-such-drive", {}}}, request, progress);
  ASSERT_FALSE(nothing);
  EXPECT_EQ(nothing.error().code, ErrorCode::kNoData);
  table.soils["other"] = table.soils.begin()->second;
  table.terrains[1].soil = "other";
  const auto soils = tune(table, drives, finals, request, progress);
  ASSERT_FALSE(soils);
  EXPECT_NE(soils.error().detail.find("dry_sand, other"), std::string::npos);
}

TEST(Tune, FindsFrictionAngleAndShearModulusOfSixSimulatedDrives) {
  DriveTable table = *read_table(kSixDrives);
  table.draw_soils = false;
  sim::Soil& soil = table.soils.find("dry_sand")->second.mean;
  soil.pressure = {990.0, 1.528e6, 1.1};
  soil.cohesion_pa = 500.0;
  constexpr double kTruth[] = {36.0, 0.012};
  soil.friction_angle_rad = rad_from_deg(kTruth[0]);
  soil.shear_modulus_x_m = soil.shear_modulus_y_m = kTruth[1];
  const auto finals = finals_of(table, &sim::simulate_drive, 0.003);
  // What is believed before is 30 % off, and not much believed.
  soil.friction_angle_rad *= 1.3;
  soil.shear_modulus_x_m = soil.shear_modulus_y_m = 0.7 * kTruth[1];
  const double friction_deg = deg_from_rad(soil.friction_angle_rad), shear_m = soil.shear_modulus_x_m;
  TuneRequest request{
      .parameters = {parameter("soil.friction_angle_deg", 0.6 * friction_deg, 1.1 * friction_deg),
                     parameter("soil.shear_modulus_m", 0.5 * shear_m, 2.5 * shear_m)},
      .options = {},
      .simulator = &sim::simulate_drive};
  NoProgress progress;
  const auto result = tune(table, expand(table), finals, request, progress);
  ASSERT_TRUE(result) << result.error().detail;
  const gap::DriveTuning& tuning = result->tuning;
  const gap::SweepPoint& best = tuning.sweep.points[tuning.sweep.best];
  ASSERT_TRUE(tuning.fit);
  const gap::LeastSquaresFit& fit = tuning.fit->fit;
  EXPECT_LE(tuning.fit->score, *best.score);
  EXPECT_LT(tuning.fit->score, 0.1);  // a centimetre
  EXPECT_EQ(tuning.services[tuning.sweep.best].scores.size(), 2U);
  for (std::size_t k = 0; k < 2; ++k) {
    ASSERT_TRUE(fit.standard_error(k)) << k;
    const double std = *fit.standard_error(k);
    EXPECT_LT(std::abs(fit.estimate[k] - kTruth[k]), 2.5 * std) << k << ": " << fit.estimate[k];
    EXPECT_LT(std, 0.05 * kTruth[k]) << k;
    RecordProperty("estimate_" + std::to_string(k), std::to_string(fit.estimate[k]));
    RecordProperty("std_" + std::to_string(k), std::to_string(std));
    RecordProperty("sweep_" + std::to_string(k), std::to_string(best.x[k]));
  }
  RecordProperty("scores", std::to_string(tuning.fit->score) + " " + std::to_string(*best.score));
  EXPECT_GT(*fit.correlation(0, 1), 0.5);  // a weak soil and a stiff one slip alike
}

}  // namespace
}  // namespace slipway::campaign
