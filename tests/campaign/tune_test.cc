#include "campaign/tune.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <iostream>

#include "core/angle.h"
#include "core/random.h"
#include "tables.h"

namespace slipway::campaign {
namespace {

// Six drives of 2 m on two tilts: straight up or along, across, and an arc.
const std::string kSixDrives = R"({
  "format": "campaign-table/1", "name": "six", "summary": "six drives", "sources": [],
  "rover": "fido-class", "gravity_m_s2": 9.81, "seed": 7,
  "terrains": [{"name": "gentle", "soil": "dry_sand", "tilt_deg": 6, "size_m": 8},
               {"name": "steep", "soil": "dry_sand", "tilt_deg": 14, "size_m": 8}],
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

MeasuredFinals finals_of(const CampaignTable& table, Simulator simulator, double noise_m) {
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
  const CampaignTable table = *read_table(kSixDrives);
  for (const std::string& name : tuning_field_names()) {
    CampaignTable changed = table;
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
  CampaignTable table = *read_table(kSixDrives);
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
  EXPECT_NEAR(deg_from_rad(result->tuning.tilts[1].tilt_rad), 14.0, 0.01);
  EXPECT_EQ(result->tuning.tilts[0].drives.size(), 3U);
}

TEST(Tune, RefusesNamesRangesSoilsAndNothingMeasured) {
  CampaignTable table = *read_table(kSixDrives);
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
  CampaignTable table = *read_table(kSixDrives);
  table.draw_soils = false;
  sim::Soil& soil = table.soils.begin()->second.mean;
  const double friction_deg = deg_from_rad(soil.friction_angle_rad);
  const double shear_m = soil.shear_modulus_x_m = soil.shear_modulus_y_m = 0.012;
  const auto finals = finals_of(table, &sim::simulate_drive, 0.002);
  // What is believed before is 30 % off.
  soil.friction_angle_rad *= 0.7;
  soil.shear_modulus_x_m = soil.shear_modulus_y_m = 1.3 * shear_m;
  TuneRequest request{.parameters = {parameter("soil.friction_angle_deg", 0.65 * friction_deg,
                                               std::min(1.25 * friction_deg, 60.0), 4, 3),
                                     parameter("soil.shear_modulus_m", 0.006, 0.03, 4, 3)},
                      .options = {},
                      .simulator = &sim::simulate_drive};
  NoProgress progress;
  const auto result = tune(table, expand(table), finals, request, progress);
  ASSERT_TRUE(result) << result.error().detail;
  const gap::DriveTuning& tuning = result->tuning;
  ASSERT_TRUE(tuning.fit);
  const gap::LeastSquaresFit& fit = tuning.fit->fit;
  EXPECT_LE(tuning.fit->score, *tuning.sweep.points[tuning.sweep.best].score);
  const double truth[] = {friction_deg, shear_m};
  for (std::size_t k = 0; k < 2; ++k) {
    ASSERT_TRUE(fit.standard_error(k)) << k;
    const double std = *fit.standard_error(k);
    std::cout << fit.estimate[k] << " +- " << std << ", truth " << truth[k] << ", sweep "
              << tuning.sweep.points[tuning.sweep.best].x[k] << "\n";
    EXPECT_LT(std::abs(fit.estimate[k] - truth[k]), 2.5 * std) << k;
    EXPECT_LT(std, 0.1 * truth[k]) << k;
  }
  std::cout << "fit score " << tuning.fit->score << " sweep " << *tuning.sweep.points[tuning.sweep.best].score
            << " corr " << fit.covariance(0, 1) / std::sqrt(fit.covariance(0, 0) * fit.covariance(1, 1))
            << " " << fit.message << "\n";
}

}  // namespace
}  // namespace slipway::campaign
