#include "campaign/drive_csv.h"

#include <gtest/gtest.h>

#include <sstream>

#include "core/angle.h"
#include "tables.h"

namespace slipway::campaign {
namespace {

const sim::RoverModel& rover() {
  return *shipped_catalogue().rovers.at("fido-class");
}

sim::SensorReading reading_at(double time_s) {
  sim::SensorReading reading;
  sim::DriveSample& sample = reading.sample;
  const std::size_t wheels = rover().wheels.size();
  sample.time_s = time_s;
  sample.p_MB = {1.5, -2.25, 0.125};
  sample.attitude = {.roll_rad = 0.0, .pitch_rad = rad_from_deg(-5.0), .yaw_rad = rad_from_deg(200.0)};
  sample.wheels = sim::PerWheel<sim::WheelState>(wheels);
  sample.steer_rad = sim::PerWheel<double>(wheels, rad_from_deg(12.0));
  sample.commanded_rate_rad_s = sample.turned_rad = sample.voltage_v = sim::PerWheel<double>(wheels, 0.0);
  for (sim::WheelState& wheel : sample.wheels) {
    wheel.rate_rad_s = rad_from_deg(28.0);
    wheel.sinkage_m = 0.011;
  }
  return reading;
}

std::vector<std::vector<std::string>> cells_of(const std::string& csv) {
  std::vector<std::vector<std::string>> rows;
  std::istringstream lines(csv);
  for (std::string line; std::getline(lines, line);) {
    rows.emplace_back();
    std::istringstream row(line + ",");
    for (std::string cell; std::getline(row, cell, ',');) rows.back().push_back(cell);
  }
  return rows;
}

TEST(DriveCsv, BeginsWithTheFormatsColumnsInTheirOrder) {
  const auto rows = cells_of(drive_csv(rover(), {}, {}));
  ASSERT_EQ(rows.size(), 1U);
  std::vector<std::string> wanted{"t_s", "x_m", "y_m", "z_m", "roll_deg", "pitch_deg", "yaw_deg"};
  for (const char* wheel : {"lf", "lm", "lr", "rf", "rm", "rr"})
    for (const char* column : {"_rate_deg_s", "_steer_deg", "_current_a", "_sinkage_m", "_motor_temp_c"})
      wanted.push_back(std::string(wheel) + column);
  wanted.emplace_back("bus_voltage_v");
  ASSERT_GT(rows[0].size(), wanted.size());
  EXPECT_EQ(std::vector<std::string>(rows[0].begin(), rows[0].begin() + static_cast<long>(wanted.size())),
            wanted);
}

TEST(DriveCsv, HoldsDegreesAndEmptyCellsWhereNothingWasRead) {
  std::vector<sim::SensorReading> readings{reading_at(0.0), reading_at(1.0)};
  readings[1].has_sinkage = readings[1].has_position = readings[1].has_attitude = false;
  const auto rows = cells_of(drive_csv(rover(), readings, {.bus_voltage_v = 24.0, .motor_temp_c = -20.0}));
  ASSERT_EQ(rows.size(), 3U);
  for (const auto& row : rows) EXPECT_EQ(row.size(), rows[0].size());
  const std::vector<std::string> first(rows[1].begin(), rows[1].begin() + 12);
  EXPECT_EQ(first, (std::vector<std::string>{"0", "1.5", "-2.25", "0.125", "0", "-5", "200", "28", "12", "0",
                                             "0.011", "-20"}));
  EXPECT_EQ(rows[1][37], "24");
  const std::vector<std::string> second(rows[2].begin(), rows[2].begin() + 12);
  EXPECT_EQ(second, (std::vector<std::string>{"1", "", "", "", "", "", "", "28", "12", "0", "", "-20"}));
}

TEST(DriveCsv, TimeIncreasesAndTheLaterOfTwoReadingsOfAnInstantStands) {
  std::vector<sim::SensorReading> readings{reading_at(0.0), reading_at(1.0), reading_at(1.0 + 1e-9),
                                           reading_at(2.0)};
  readings[2].sample.p_MB.x() = 7.0;
  const auto rows = cells_of(drive_csv(rover(), readings, {}));
  ASSERT_EQ(rows.size(), 4U);
  EXPECT_EQ(rows[2][0], "1");
  EXPECT_EQ(rows[2][1], "7");
  EXPECT_EQ(rows[3][0], "2");
}

TEST(DriveCsv, ASurveyHasTheFirstAndTheLastRow) {
  const std::vector<sim::SensorReading> readings{reading_at(0.0), reading_at(1.0), reading_at(2.0)};
  const auto rows = cells_of(drive_csv(rover(), readings, {.final_only = true}));
  ASSERT_EQ(rows.size(), 3U);
  EXPECT_EQ(rows[1][0], "0");
  EXPECT_EQ(rows[2][0], "2");
}

TEST(DriveCsv, LegsHaveTheirOwnTime) {
  std::vector<sim::SensorReading> readings{reading_at(0.0), reading_at(1.0), reading_at(2.0),
                                           reading_at(3.0)};
  readings[2].sample.leg = readings[3].sample.leg = 1;
  const auto second = readings_of_leg(readings, 1);
  ASSERT_EQ(second.size(), 2U);
  EXPECT_DOUBLE_EQ(second[0].sample.time_s, 0.0);
  EXPECT_DOUBLE_EQ(second[1].sample.time_s, 1.0);
  EXPECT_TRUE(readings_of_leg(readings, 2).empty());
}

}  // namespace
}  // namespace slipway::campaign
