#include "steps/slip_steps_csv.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>

#include "core/angle.h"

namespace slipway::steps {
namespace {

const std::string kSmall = "sol,odometry_m,slip,path_pitch_deg\n45,0.99,0.03,-2.2\n";

// "PLACE: MESSAGE" of every fault, a line each.
std::string faults_of(const std::string& text) {
  const auto read = read_slip_steps(text, "steps.csv");
  if (read) return "it was read";
  EXPECT_EQ(read.error().code, ErrorCode::kUnreadableData);
  std::string all;
  for (const Fault& fault : read.error().faults) all += fault.pointer + ": " + fault.message + "\n";
  return all;
}

void expect_fault(const std::string& text, const std::string& part) {
  EXPECT_NE(faults_of(text).find(part), std::string::npos) << part << "\n" << faults_of(text);
}

TEST(SlipStepsCsv, FewColumnsAreEnough) {
  for (const std::string& head :
       {std::string(), std::string("# slip-steps/1\n"), std::string("\xEF\xBB\xBF")}) {
    const auto read = read_slip_steps(head + kSmall, "steps.csv");
    ASSERT_TRUE(read) << faults_of(head + kSmall);
    ASSERT_EQ(read->size(), 1U);
    const SlipStep& step = read->front();
    EXPECT_EQ(step.sol, 45);
    EXPECT_EQ(step.et_s, 0.0);
    EXPECT_EQ(step.odometry_m, 0.99);
    EXPECT_EQ(step.slip, 0.03);
    EXPECT_DOUBLE_EQ(step.climb_rad().value(), rad_from_deg(-2.2));
    EXPECT_EQ(step.roll_rad(), 0.0);
    EXPECT_FALSE(step.site || step.x_eqc_m || step.backward || step.heading_rad);
    EXPECT_FALSE(step.pitch_is_of_sol);
  }
}

TEST(SlipStepsCsv, RowsOfCuriosity) {
  const auto read = read_slip_steps(
      "sol,et_s,site,site_north_m,site_east_m,site_down_m,x_eqc_m,y_eqc_m,odometry_m,slip,side_m,"
      "climb_pitch_start_deg,climb_pitch_end_deg,roll_start_deg,roll_end_deg,heading_deg,backward,drive_s,"
      "path_pitch_deg,course_deg,attitude,dem_climb_deg,terrain_unit\r\n"
      "45,401489729.2,4,-20.897,151.282,4.244,8147029.32,-272099.07,0.9992,0.0313,0.0134,-1.08,-2.37,3.54,3."
      "60,"
      "19.76,1,45.1,-2.24,19.36,ck,,SM\r\n"
      "960,482723360.8,46,-60.669,-135.314,3.533,8142752.64,-276596.94,0.9997,0.0173,0.0394,,,,,,,36.0,,249."
      "01,"
      "none,1.76,\r\n",
      "steps.csv");
  ASSERT_TRUE(read);
  const SlipStep& first = read->front();
  EXPECT_EQ(first.et_s, 401489729.2);
  EXPECT_EQ(first.site, 4);
  EXPECT_EQ(first.y_eqc_m, -272099.07);
  EXPECT_EQ(first.backward, true);
  EXPECT_DOUBLE_EQ(first.roll_rad(), rad_from_deg(3.57));
  EXPECT_EQ(first.attitude, StepAttitude::kCk);
  EXPECT_EQ(first.terrain_unit, "SM");
  EXPECT_DOUBLE_EQ((*read)[1].climb_rad().value(), rad_from_deg(1.76));
  EXPECT_FALSE((*read)[1].backward);
}

TEST(SlipStepsCsv, RowsOfPerseverance) {
  const auto read = read_slip_steps(
      "sol,sclk_s,east_m,north_m,step_m,dt_s,course_deg,nominal_m,slip_if_nominal,sol_mean_climb_deg,sol_leg_"
      "m\n"
      "15,668275301,3.432,-4.965,0.966,39,356.3,1.0,0.034,-0.13,35.4\n"
      "16,668275329,3.370,-4.001,0.966,28,356.3,0.5,-0.034,,35.4\n",
      "steps.csv");
  ASSERT_TRUE(read);
  EXPECT_EQ(read->front().odometry_m, 1.0);
  EXPECT_EQ(read->front().slip, 0.034);
  EXPECT_EQ(read->front().site_east_m, 3.432);
  EXPECT_EQ(read->front().drive_s, 39.0);
  EXPECT_TRUE(read->front().pitch_is_of_sol);
  EXPECT_FALSE((*read)[1].climb_rad());
}

TEST(SlipStepsCsv, WhatIsWrittenIsReadAgain) {
  const auto read = read_slip_steps(
      "sol,odometry_m,slip,climb_pitch_end_deg,roll_end_deg,backward,sol_mean_climb_deg,terrain_unit,"
      "attitude\n"
      "1,1.25,0.5,3.25,-1.5,0,,a b,ck\n2,0.5,-0.25,,,1,2.5,,none\n",
      "steps.csv");
  ASSERT_TRUE(read);
  const std::string text = write_slip_steps(*read);
  EXPECT_TRUE(text.starts_with("# slip-steps/1\nsol,et_s,site,"));
  const auto again = read_slip_steps(text, "again.csv");
  ASSERT_TRUE(again) << faults_of(text);
  EXPECT_EQ(*again, *read);
  EXPECT_EQ(write_slip_steps(*again), text);
}

TEST(SlipStepsCsv, EveryFaultOfTheHeader) {
  expect_fault("", "there must be a header and a row or more");
  expect_fault("sol,odometry_m,slip,path_pitch_deg\n", "there must be a header and a row or more");
  expect_fault("# slip-steps/2\n" + kSmall, "steps.csv, line 1: \"# slip-steps/2\"");
  expect_fault("sol,odometry_m,slp,path_pitch_deg\n1,1,0,0\n",
               "column 3: unknown column \"slp\"; did you mean \"slip\"");
  expect_fault("sol,odometry_m,slip,path_pitch_deg,sol\n1,1,0,0,1\n", "column 5: column sol is there twice");
  expect_fault("odometry_m,slip,path_pitch_deg\n1,0,0\n", "there is no column sol");
  expect_fault("sol,slip,path_pitch_deg\n1,0,0\n", "there is no column odometry_m and no column nominal_m");
  expect_fault("sol,odometry_m,path_pitch_deg\n1,1,0\n",
               "there is no column slip and no column slip_if_nominal");
  expect_fault("sol,odometry_m,slip\n1,1,0\n", "there is no column of a slope");
  expect_fault("sol,odometry_m,nominal_m,slip,path_pitch_deg\n1,1,1,0,0\n",
               "columns odometry_m and nominal_m exclude each other");
  expect_fault("sol;odometry_m;slip;path_pitch_deg\n1;1;0;0\n", "must be separated by \",\"");
}

TEST(SlipStepsCsv, EveryFaultOfARow) {
  const auto row = [](const std::string& cells) {
    return "sol,odometry_m,slip,path_pitch_deg,site,attitude,terrain_unit,backward\n" + cells + "\n";
  };
  expect_fault(row("1,1,0,0,,,"), "line 2: 7 cells, must be 8 as in the header");
  expect_fault(row("1,1,0,0,,,,,"), "line 2: 9 cells, must be 8 as in the header");
  expect_fault(row("1,1,x,0,,,,"), "line 2, column 3 (slip): \"x\" is no number");
  expect_fault(row("1,nan,0,0,,,,"), "column 2 (odometry_m): \"nan\" is no number");
  expect_fault(row("1,inf,0,0,,,,"), "column 2 (odometry_m): \"inf\" is no number");
  expect_fault(row("1,1,0,1e999,,,,"), "column 4 (path_pitch_deg): \"1e999\" is no number");
  expect_fault(row("1,1,1.6,0,,,,"), "slip = 1.6, must be in [-1, 1.5]");
  expect_fault(row("1,0,0,0,,,,"), "odometry_m = 0, must be above 0");
  expect_fault(row("1,,0,0,,,,"), "odometry_m is missing");
  expect_fault(row("1,1,,0,,,,"), "slip is missing");
  expect_fault(row(",1,0,0,,,,"), "sol is missing");
  expect_fault(row("1.5,1,0,0,,,,"), "sol = 1.5, must be whole");
  expect_fault(row("1,1,0,91,,,,"), "path_pitch_deg = 91, must be in [-90, 90]");
  expect_fault(row("1,1,0,,,,,"), "line 2: no slope");
  expect_fault(row("1,1,0,0,,imu,,"), "column 6 (attitude): \"imu\", must be ck or none");
  expect_fault(row("1,1,0,0,,,caf\xC3\xA9,"),
               "column 7 (terrain_unit): must be 64 printable ASCII characters");
  expect_fault(row("1,1,0,0,,,,0.5"), "backward = 0.5, must be whole");
  expect_fault(row("2,1,0,0,,,,\n1,1,0,0,,,,"),
               "line 3, column 1 (sol): sol 1 after sol 2: sols never decrease");
  expect_fault(row("1,1,0,0,,,\"a\","), "line 2, byte 81: a quote");
  expect_fault(row(std::string("1,1,0,0,,,a\0b,", 14)), "a NUL byte");
}

TEST(SlipStepsCsv, FaultsAreToldTogetherAndTwentyOfThem) {
  std::string text = "sol,odometry_m,slip,path_pitch_deg\n";
  for (int k = 0; k < 15; ++k) text += "1,x,2,0\n";
  const auto read = read_slip_steps(text, "steps.csv");
  ASSERT_FALSE(read);
  ASSERT_EQ(read.error().faults.size(), 21U);
  EXPECT_EQ(read.error().faults[1].pointer, "steps.csv, line 2, column 3 (slip)");
  EXPECT_EQ(read.error().faults[20].message, "10 faults more like these");
}

TEST(SlipStepsCsv, MoreThanAMillionRowsAreRefused) {
  std::string text = "sol,odometry_m,slip,path_pitch_deg\n";
  for (std::size_t k = 0; k < kMaxSteps + 1; ++k) text += "1,1,0,0\n";
  expect_fault(text, "1000001 rows, must be 1000000 at most");
  text.resize(text.size() - 8);
  EXPECT_TRUE(read_slip_steps(text, "steps.csv"));
}

}  // namespace
}  // namespace slipway::steps
