#include "gap/diagnosis/model/drive_window.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/angle.h"
#include "gap/diagnosis/model/reading_plausibility.h"
#include "gap/diagnosis/model/window_readings.h"
#include "tests/sim/reference_models.h"

namespace slipway::gap {
namespace {

// A drive of constant speeds along the axes of a body that is tilted, seen in the map frame.
DriveCampaign constant_motion(double forward_m_s, double leftward_m_s, double yaw_rate, double roll,
                              double pitch, double speed_m_s, double curvature_1_m) {
  DriveCampaign campaign;
  campaign.gravity_m_s2 = 3.71;
  campaign.rover = std::make_shared<sim::RoverModel>(sim::six_wheeler());
  campaign.measurement_std = {0.003, 0.003, 0.02, 0.003, 0.001};
  MeasuredDriveSeries drive;
  drive.id = "D";
  drive.command.speed_m_s = speed_m_s;
  drive.command.curvature_1_m = curvature_1_m;
  constexpr double kStep_s = 0.01;
  double x = 2.0, y = -1.0, yaw = 3.0;  // passes pi
  for (int i = 0; i <= 3000; ++i) {
    if (i % 100 == 0) {
      DriveSample sample;
      sample.time_s = i * kStep_s;
      sample.p_MB = {x, y, 0.0};
      sample.attitude = {roll, pitch, wrapped_rad(yaw)};
      sample.wheels = sim::PerWheel<WheelReading>(6);
      for (WheelReading& wheel : sample.wheels) wheel.current_a = speed_m_s < 0.0 ? -0.2 : 0.2;
      drive.samples.push_back(sample);
    }
    const double middle = yaw + 0.5 * kStep_s * yaw_rate;
    const double level_x = forward_m_s * std::cos(pitch) + leftward_m_s * std::sin(pitch) * std::sin(roll);
    const double level_y = leftward_m_s * std::cos(roll);
    x += kStep_s * (std::cos(middle) * level_x - std::sin(middle) * level_y);
    y += kStep_s * (std::sin(middle) * level_x + std::cos(middle) * level_y);
    yaw += kStep_s * yaw_rate;
  }
  campaign.drives.push_back(drive);
  return campaign;
}

std::optional<double> value_of(const DriveWindow& window, Channel channel) {
  for (const Observation& o : window.observations)
    if (o.channel == channel) return o.value;
  return std::nullopt;
}

TEST(DriveWindow, SpeedsAlongTheBodysAxesAreFoundOnSlopesAndArcs) {
  const double roll = rad_from_deg(7.0), pitch = rad_from_deg(-15.0), yaw_rate = 0.02;
  const DriveCampaign campaign = constant_motion(0.04, 0.003, yaw_rate, roll, pitch, 0.05, 0.4);
  const std::vector<DriveWindow> windows = cut_windows(campaign);
  ASSERT_EQ(windows.size(), 1U);
  EXPECT_NEAR(*value_of(windows[0], Channel::kSlip), 0.2, 1e-4);
  EXPECT_NEAR(*value_of(windows[0], Channel::kSideSlip), 0.06, 1e-4);
  EXPECT_NEAR(*value_of(windows[0], Channel::kYawRate),
              yaw_rate * std::cos(pitch) / std::cos(roll) - 0.05 * 0.4, 1e-6);
  EXPECT_NEAR(*value_of(windows[0], Channel::kCurrent), 0.2, 1e-12);
}

TEST(DriveWindow, BackwardDrivesHaveThePositiveSlipOfForwardOnes) {
  const std::vector<DriveWindow> windows =
      cut_windows(constant_motion(-0.04, 0.0, 0.0, 0.0, 0.0, -0.05, 0.0));
  EXPECT_NEAR(*value_of(windows[0], Channel::kSlip), 0.2, 1e-4);
  EXPECT_NEAR(*value_of(windows[0], Channel::kCurrent), 0.2, 1e-12) << "in the sense of the rate";
}

TEST(DriveWindow, AnOutlierIsPassedOver) {
  DriveCampaign campaign = constant_motion(0.04, 0.0, 0.0, 0.0, 0.0, 0.05, 0.0);
  campaign.drives[0].samples[10].wheels[2].current_a = 40.0;
  const std::vector<DriveWindow> windows = cut_windows(campaign);
  for (const Observation& o : windows[0].observations)
    if (o.channel == Channel::kCurrent) {
      EXPECT_NEAR(o.value, 0.2, 1e-9) << o.wheel;
    }
}

// The current that is passed over does not widen what the others tell.
TEST(DriveWindow, AnOutlierLeavesTheScatterOfTheOthersAlone) {
  DriveCampaign campaign = constant_motion(0.04, 0.0, 0.0, 0.0, 0.0, 0.05, 0.0);
  campaign.measurement_std.current_relative = 0.02;
  for (DriveSample& sample : campaign.drives[0].samples) sample.wheels[0].current_a = 0.3;  // no total
  const auto std_of = [](const DriveCampaign& c) {
    for (const Observation& o : cut_windows(c)[0].observations)
      if (o.channel == Channel::kCurrent && o.wheel == 2) return o.sensor_std;
    return 0.0;
  };
  const double without = std_of(campaign);
  const double rows = static_cast<double>(campaign.drives[0].samples.size());
  campaign.drives[0].samples[10].wheels[2].current_a = 40.0;
  EXPECT_NEAR(std_of(campaign), without * std::sqrt(rows / (rows - 1.0)), 1e-12);
}

// The ends of a rover's turn were once passed over, other ones to the left than to the right.
TEST(Readings, AreKeptOnSteadyTurnsToEitherSide) {
  constexpr double kStd = 0.2, kTurn = 1.5;
  for (const double sense : {1.0, -1.0}) {
    Readings readings;
    for (int i = 0; i < 16; ++i) {
      readings.time_s.push_back(2.0 * i);
      readings.value.push_back(sense * kTurn * i);
    }
    EXPECT_EQ(readings.kept(kStd, {}).count(), 16U);
    readings.value[0] += sense * 2.0;
    readings.value[7] -= sense * 2.0;
    const Readings left = readings.kept(kStd, {});
    EXPECT_EQ(left.count(), 14U);
    EXPECT_EQ(left.time_s.front(), 2.0) << "an end can be an outlier as well";
  }
}

// Of a rover that was to turn in place and hardly did, a window says no more than that it is stuck, as of one
// that was to drive on.
TEST(DriveWindow, ATurnInPlaceThatIsStuckIsCensored) {
  DriveCampaign campaign = constant_motion(0.0, 0.0, 0.05 * 0.3, 0.0, 0.0, 0.0, 0.0);
  campaign.drives[0].command.turn_in_place = true;
  campaign.drives[0].command.turn_rate_rad_s = 0.3;
  const std::vector<DriveWindow> windows = cut_windows(campaign);
  ASSERT_FALSE(windows.empty());
  EXPECT_NEAR(*value_of(windows[0], Channel::kSlip), 0.95, 1e-6);
  EXPECT_TRUE(windows[0].censored);
  campaign.drives[0].command.turn_rate_rad_s = 0.016;
  EXPECT_FALSE(cut_windows(campaign)[0].censored);
}

TEST(DriveWindow, RowsBeforeTheRoverSetsOffAndAfterItHaltsAreLeftOut) {
  DriveCampaign campaign = constant_motion(0.04, 0.0, 0.0, 0.0, 0.0, 0.05, 0.0);
  MeasuredDriveSeries& drive = campaign.drives[0];
  const double commanded_rad_s = sim::wheel_commands(*campaign.rover, drive.command)[0].rate_rad_s;
  for (DriveSample& sample : drive.samples)
    for (WheelReading& wheel : sample.wheels) wheel.rate_rad_s = commanded_rad_s;
  const auto driving = cut_windows(campaign);
  // It stands for 4 s at either end.
  std::vector<DriveSample> samples;
  const auto stand = [&](const DriveSample& there, double from_s) {
    for (int i = 0; i < 4; ++i) {
      DriveSample& sample = samples.emplace_back(there);
      sample.time_s = from_s + i;
      for (WheelReading& wheel : sample.wheels) wheel.rate_rad_s = wheel.current_a = 0.0;
    }
  };
  stand(drive.samples.front(), 0.0);
  for (DriveSample sample : drive.samples) {
    sample.time_s += 4.0;
    samples.push_back(sample);
  }
  stand(drive.samples.back(), samples.back().time_s + 1.0);
  drive.samples = samples;
  const auto both = cut_windows(campaign);
  ASSERT_EQ(both.size(), driving.size());
  EXPECT_DOUBLE_EQ(both[0].start_s, 4.0);
  EXPECT_DOUBLE_EQ(both[0].end_s - both[0].start_s, driving[0].end_s - driving[0].start_s);
  EXPECT_NEAR(*value_of(both[0], Channel::kSlip), 0.2, 1e-4);
  EXPECT_NEAR(*value_of(both[0], Channel::kCurrent), 0.2, 1e-12);
  // Wheels that never turn are no reason to look at nothing.
  for (DriveSample& sample : drive.samples)
    for (WheelReading& wheel : sample.wheels) wheel.rate_rad_s = 0.0;
  EXPECT_DOUBLE_EQ(cut_windows(campaign)[0].start_s, 0.0);
}

TEST(DriveWindow, SurveysBeforeAndAfterSayPoseAlone) {
  DriveCampaign campaign = constant_motion(0.04, 0.0, 0.0, 0.0, 0.0, 0.05, 0.0);
  MeasuredDriveSeries& drive = campaign.drives[0];
  drive.samples = {drive.samples.front(), drive.samples.back()};
  drive.final_only = true;
  const std::vector<DriveWindow> windows = cut_windows(campaign);
  ASSERT_EQ(windows.size(), 1U);
  EXPECT_NEAR(*value_of(windows[0], Channel::kSlip), 0.2, 1e-4);
  EXPECT_FALSE(value_of(windows[0], Channel::kCurrent));
}

TEST(DriveWindow, OneCurrentForAllWheelsIsATotalAndComparedAsTheirMean) {
  DriveCampaign campaign = constant_motion(0.04, 0.0, 0.0, 0.0, 0.0, 0.05, 0.0);
  const auto currents = [&] {
    const std::vector<DriveWindow> windows = cut_windows(campaign);
    std::vector<int> wheels;
    for (const Observation& o : windows[0].observations)
      if (o.channel == Channel::kCurrent) wheels.push_back(o.wheel);
    return wheels;
  };
  EXPECT_EQ(currents(), std::vector<int>{-1});
  campaign.drives[0].samples[3].wheels[2].current_a += 0.01;
  EXPECT_EQ(currents(), (std::vector<int>{0, 1, 2, 3, 4, 5}));
}

TEST(DriveWindow, NoneReachesAcrossAPause) {
  DriveCampaign campaign = constant_motion(0.04, 0.0, 0.0, 0.0, 0.0, 0.05, 0.0);
  for (std::size_t i = 15; i < campaign.drives[0].samples.size(); ++i)
    campaign.drives[0].samples[i].time_s += 60.0;
  const std::vector<DriveWindow> windows = cut_windows(campaign);
  ASSERT_EQ(windows.size(), 2U);
  EXPECT_LE(windows[0].end_s, 14.0);
  EXPECT_GE(windows[1].start_s, 75.0);
  EXPECT_NEAR(*value_of(windows[1], Channel::kSlip), 0.2, 1e-4);
}

TEST(DriveWindow, OfRowsThatAreFarApartItHoldsThree) {
  DriveCampaign campaign = constant_motion(0.04, 0.0, 0.0, 0.0, 0.0, 0.05, 0.0);
  auto& samples = campaign.drives[0].samples;
  for (std::size_t i = 0; 15 * i < samples.size(); ++i) samples[i] = samples[15 * i];
  samples.resize(3);
  for (std::size_t i = 0; i < samples.size(); ++i) samples[i].attitude.yaw_rad = 3.0;
  WindowOptions options;
  options.length_m = 0.5;  // 10 s, where rows are 15 s apart
  const std::vector<DriveWindow> windows = cut_windows(campaign, options);
  ASSERT_EQ(windows.size(), 1U);
  EXPECT_NEAR(windows[0].end_s - windows[0].start_s, 30.0, 1e-9);
}

TEST(DriveCampaign, ARecordingUnderTwoNamesIsARepeat) {
  DriveCampaign campaign = constant_motion(0.04, 0.0, 0.0, 0.0, 0.0, 0.05, 0.0);
  take_same_rows_as_repeats(campaign);
  EXPECT_TRUE(campaign.notes.empty());
  for (const char* id : {"E", "F", "G", "H"}) {
    campaign.drives.push_back(campaign.drives[0]);
    campaign.drives.back().id = id;
  }
  campaign.drives[2].samples.back().p_MB.x() += 1e-6;
  campaign.drives[3].terrain = 1;
  take_same_rows_as_repeats(campaign);
  EXPECT_EQ(campaign.drives[0].repeat_of, std::nullopt);
  EXPECT_EQ(campaign.drives[1].repeat_of, "D");
  EXPECT_EQ(campaign.drives[2].repeat_of, std::nullopt) << "another recording";
  EXPECT_EQ(campaign.drives[3].repeat_of, std::nullopt) << "on another terrain";
  EXPECT_EQ(campaign.drives[4].repeat_of, "D");
  ASSERT_EQ(campaign.notes.size(), 1U);
  EXPECT_NE(campaign.notes[0].find("2 of 5 drives (E, H) have the very rows"), std::string::npos);
  take_same_rows_as_repeats(campaign);
  EXPECT_EQ(campaign.notes.size(), 1U) << "they are known";
}

TEST(DriveCampaign, WheelsThatTurnedAgainstTheCommandAreNoted) {
  DriveCampaign campaign = constant_motion(0.04, 0.0, 0.0, 0.0, 0.0, 0.05, 0.0);
  for (DriveSample& sample : campaign.drives[0].samples)
    for (WheelReading& wheel : sample.wheels) wheel.rate_rad_s = 0.4;
  note_turned_against_command(campaign);
  EXPECT_TRUE(campaign.notes.empty());
  campaign.drives[0].command.speed_m_s = -0.05;
  note_turned_against_command(campaign);
  ASSERT_EQ(campaign.notes.size(), 1U);
  EXPECT_EQ(campaign.notes[0], "1 of 1 drives (D): the wheels turned against the commanded direction");
}

// A campaign whose times were milliseconds taken for seconds came as "no effect is missing".
TEST(ReadingPlausibility, NotesReadingsThatNoSuchRoverHas) {
  const auto notes_of = [](const auto& change) {
    DriveCampaign campaign = constant_motion(0.04, 0.0, 0.0, 0.0, 0.0, 0.05, 0.0);
    for (DriveSample& sample : campaign.drives[0].samples) {
      for (WheelReading& wheel : sample.wheels) wheel.motor_temp_c = 20.0, wheel.sinkage_m = 0.01;
      change(sample);
    }
    return notes_of_implausible_readings(campaign);
  };
  EXPECT_TRUE(notes_of([](DriveSample&) {}).empty());
  const auto noted = [&](const auto& change, const std::string& words) {
    const std::vector<std::string> notes = notes_of(change);
    ASSERT_EQ(notes.size(), 1U) << words;
    EXPECT_NE(notes[0].find(words), std::string::npos) << notes[0];
    EXPECT_NE(notes[0].find("check units"), std::string::npos) << notes[0];
  };
  noted([](DriveSample& s) { s.time_s *= 1e3; }, "went less than 0.0008 of the commanded way");
  noted([](DriveSample& s) { s.p_MB *= 1e3; }, "went more than 800 of the commanded way");
  noted(
      [](DriveSample& s) {
        for (WheelReading& w : s.wheels) w.current_a = 200.0;
      },
      "half of the currents are beyond 200 A");
  noted(
      [](DriveSample& s) {
        for (WheelReading& w : s.wheels) w.motor_temp_c = 293.0;
      },
      "beyond 293 C");
  noted(
      [](DriveSample& s) {
        for (WheelReading& w : s.wheels) w.sinkage_m = 10.0;
      },
      "half of the sinkages are beyond 10 m");
}

}  // namespace
}  // namespace slipway::gap
