#include "research/benchmark/drive_acquisition.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>

#include "core/angle.h"
#include "gap/diagnosis/model/drive_resampling.h"
#include "research/benchmark/drive_kind.h"
#include "research/benchmark/drives_needed.h"
#include "tests/sim/reference_models.h"

namespace slipway::gap {
namespace {

using Steps = std::vector<AcquisitionStep>;

// A plane whose height rises by 0.2 m a metre towards north-west.
constexpr double kRise = 0.2;

std::shared_ptr<const sim::Ground> north_west_rise() {
  return std::make_shared<sim::FunctionGround>(
      [](double x, double y) { return kRise * std::sqrt(0.5) * (y - x); });
}

struct Asked {
  double yaw_deg = 0.0, speed_m_s = 0.04, curvature_1_m = 0.0, temp_c = 20.0;
  bool turn = false;
};

DriveCampaign campaign_of(std::initializer_list<Asked> drives) {
  DriveCampaign campaign;
  campaign.gravity_m_s2 = 3.71;
  auto rover = std::make_shared<sim::RoverModel>(sim::six_wheeler());
  rover->cruise_speed_m_s = 0.04;
  campaign.rover = rover;
  campaign.terrains.push_back({"plane", north_west_rise(), ""});
  for (const Asked& asked : drives) {
    MeasuredDriveSeries drive;
    drive.id = "D" + std::to_string(campaign.drives.size());
    drive.command.speed_m_s = asked.speed_m_s;
    drive.command.curvature_1_m = asked.curvature_1_m;
    drive.command.turn_in_place = asked.turn;
    for (int i = 0; i < 3; ++i) {
      DriveSample sample;
      sample.time_s = i;
      sample.p_MB = {0.1 * i, 0.0, 0.0};
      sample.attitude = {0.0, 0.0, rad_from_deg(asked.yaw_deg)};
      sample.wheels = sim::PerWheel<WheelReading>(6);
      for (WheelReading& wheel : sample.wheels) wheel.motor_temp_c = asked.temp_c;
      drive.samples.push_back(sample);
    }
    campaign.drives.push_back(std::move(drive));
  }
  return campaign;
}

NextDrive ask(double tilt_deg, double heading_deg, double speed_m_s, double temp_c = 20.0) {
  return {.tilt_deg = tilt_deg, .heading_deg = heading_deg, .speed_m_s = speed_m_s, .motor_temp_c = temp_c};
}

TEST(SubsetOf, RepeatsOfADriveThatIsLeftOutAreRepeatsOfTheFirstOfThem) {
  DriveCampaign campaign = campaign_of({{}, {}, {}, {}, {}});
  for (const std::size_t repeat : {1U, 2U, 4U}) campaign.drives[repeat].repeat_of = "D0";
  const std::vector<std::size_t> without{4, 3, 1}, with{2, 0};
  const DriveCampaign left = subset_of(campaign, without);
  ASSERT_EQ(left.drives.size(), 3U);
  EXPECT_EQ(left.drives[0].id, "D4");
  EXPECT_FALSE(left.drives[0].repeat_of);
  EXPECT_FALSE(left.drives[1].repeat_of);
  EXPECT_EQ(left.drives[2].repeat_of, "D4");
  EXPECT_EQ(repeat_groups(left), (std::vector<std::size_t>{0, 1, 0}));
  EXPECT_EQ(subset_of(campaign, with).drives[0].repeat_of, "D0");
  EXPECT_EQ(left.rover, campaign.rover);
  EXPECT_EQ(left.terrains.size(), 1U);
}

TEST(KindOf, HeadingIsThatOfTheNoseFromUphillToTheLeft) {
  const DriveCampaign campaign = campaign_of({{.yaw_deg = 135.0},
                                              {.yaw_deg = -45.0},
                                              {.yaw_deg = -135.0},
                                              {.yaw_deg = 45.0},
                                              {.yaw_deg = 135.0, .speed_m_s = -0.04, .temp_c = -40.0}});
  const std::array expected{0.0, 180.0, 90.0, -90.0, 0.0};
  for (std::size_t d = 0; d < expected.size(); ++d) {
    const DriveKind kind = kind_of(campaign, d);
    EXPECT_NEAR(kind.tilt_deg, deg_from_rad(std::atan(kRise)), 1e-3) << d;
    EXPECT_NEAR(std::abs(wrapped_rad(rad_from_deg(kind.heading_deg - expected[d]))), 0.0, 1e-4) << d;
  }
  EXPECT_EQ(kind_of(campaign, 4).speed_m_s, -0.04);
  EXPECT_NEAR(kind_of(campaign, 4).motor_temp_c.value(), -40.0, 1e-12);
}

TEST(NearestDrive, IsTheOneOfTheSameSlopeUnderTheWheelsAndTheSameSense) {
  const DriveCampaign campaign = campaign_of({{.yaw_deg = 135.0},   // up
                                              {.yaw_deg = -45.0},   // down
                                              {.yaw_deg = -135.0},  // across, right side up
                                              {.yaw_deg = 45.0},    // across, left side up
                                              {.yaw_deg = 135.0, .speed_m_s = -0.04},  // backing down
                                              {.yaw_deg = -45.0, .speed_m_s = -0.04},  // backing up
                                              {.yaw_deg = 135.0, .temp_c = -40.0},     // up in the cold
                                              {.yaw_deg = 135.0, .turn = true}});
  const auto nearest = [&](const NextDrive& asked) {
    const std::vector<NextDrive> proposed{asked};
    return designed_drives(campaign, {}, proposed, 1, {}).front();
  };
  EXPECT_EQ(nearest(ask(15.0, 0.0, 0.04)), 0U);
  EXPECT_EQ(nearest(ask(15.0, 180.0, 0.04)), 1U);
  EXPECT_EQ(nearest(ask(15.0, 90.0, 0.04)), 2U);
  EXPECT_EQ(nearest(ask(15.0, -90.0, 0.04)), 3U);
  EXPECT_EQ(nearest(ask(15.0, 0.0, -0.04)), 4U);
  EXPECT_EQ(nearest(ask(15.0, 180.0, -0.02)), 5U);
  EXPECT_EQ(nearest(ask(15.0, 0.0, 0.04, -30.0)), 6U);
}

TEST(DesignedDrives, ServeEachProposalInTurnAndNeverTakeADriveTwice) {
  const DriveCampaign campaign =
      campaign_of({{.yaw_deg = 135.0}, {.yaw_deg = 120.0}, {.yaw_deg = -45.0}, {.yaw_deg = 45.0}});
  const double tilt_deg = deg_from_rad(std::atan(kRise));
  const std::vector<NextDrive> proposed{ask(tilt_deg, 0.0, 0.04), ask(tilt_deg - 2.0, 180.0, 0.04)};
  EXPECT_EQ(designed_drives(campaign, {}, proposed, 3, {}), (std::vector<std::size_t>{0, 2, 1}));
  const std::vector<std::size_t> made{0, 2};
  EXPECT_EQ(designed_drives(campaign, made, proposed, 9, {}).size(), 2U);
  EXPECT_EQ(designed_drives(campaign, made, {}, 2, {}), random_drives(campaign, made, 2, {}))
      << "nothing proposed: any";
}

TEST(RandomDrives, AreOthersForOtherRepeatsAndTheSameForTheSame) {
  const DriveCampaign campaign = campaign_of({{}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}});
  AcquisitionOptions other;
  other.repeat = 1;
  EXPECT_EQ(random_drives(campaign, {}, 8, {}), random_drives(campaign, {}, 8, {}));
  EXPECT_NE(random_drives(campaign, {}, 8, {}), random_drives(campaign, {}, 8, other));
}

TEST(FirstDrives, AreLevelStraightAtCruiseSpeedAndWarm) {
  DriveCampaign campaign = campaign_of({{.speed_m_s = -0.04},
                                        {.temp_c = -40.0},
                                        {.curvature_1_m = 0.4},
                                        {.speed_m_s = 0.041},
                                        {.yaw_deg = 70.0},
                                        {.speed_m_s = 0.042}});
  campaign.terrains.push_back(
      {"level", std::make_shared<sim::FunctionGround>([](double, double) { return 0.0; }), ""});
  for (const std::size_t level : {0U, 1U, 2U, 3U, 4U}) campaign.drives[level].terrain = 1;
  EXPECT_EQ(first_drives(campaign, 2), (std::vector<std::size_t>{4, 3}));
}

TEST(AcquireDrives, EndsAfterTwoRightAnswersAndNeverTellsThePolicy) {
  const DriveCampaign campaign =
      campaign_of({{}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}});
  std::vector<std::size_t> seen;
  const DrivesDiagnosis diagnosis = [&](const DriveCampaign& some) {
    seen.push_back(some.drives.size());
    Diagnosis d;
    d.drives = some.drives.size();
    return d;
  };
  const auto right_from = [](std::size_t drives) {
    return [drives](const Diagnosis& d) { return d.drives >= drives; };
  };
  Diagnosis first;
  first.drives = 4;
  const auto steps =
      acquire_drives(campaign, first, AcquisitionPolicy::kRandom, {}, diagnosis, right_from(8));
  ASSERT_TRUE(steps);
  EXPECT_EQ(seen, (std::vector<std::size_t>{6, 8, 10}));
  EXPECT_EQ(drives_needed(*steps), 8U);
  const auto never =
      acquire_drives(campaign, first, AcquisitionPolicy::kDesigned, {}, diagnosis, right_from(99));
  EXPECT_EQ(never->back().drives, 16U);
  EXPECT_EQ(drives_needed(*never), std::nullopt);
}

TEST(AcquisitionSizes, EndAtThePoolOrTheMost) {
  EXPECT_EQ(acquisition_sizes({}, 44), (std::vector<std::size_t>{4, 6, 8, 10, 12, 16, 20, 24}));
  EXPECT_EQ(acquisition_sizes({}, 7), (std::vector<std::size_t>{4, 6, 7}));
}

TEST(DrivesNeeded, CountsFromTwoRightStepsInARowOrFromTheLast) {
  EXPECT_EQ(drives_needed(Steps{{4, false}, {6, true}, {8, false}, {10, true}, {12, true}}), 10U);
  EXPECT_EQ(drives_needed(Steps{{4, true}, {6, true}}), 4U);
  EXPECT_EQ(drives_needed(Steps{{20, false}, {24, true}}), 24U);
  EXPECT_EQ(drives_needed(Steps{{20, true}, {24, false}}), std::nullopt);
  EXPECT_EQ(drives_needed(Steps{}), std::nullopt);
}

DrivesNeededCase needed(std::optional<std::size_t> designed, std::vector<std::optional<std::size_t>> random) {
  DrivesNeededCase c;
  c.limit = 24;
  c.designed = designed;
  c.random = std::move(random);
  return c;
}

TEST(DrivesNeeded, WhatWasNotFoundCountsAsTheLimitInARatio) {
  EXPECT_NEAR(*needed(6, {8, 12, 20}).ratio(4), 0.5, 1e-12);
  EXPECT_NEAR(*needed(6, {{}, {}, 20}).ratio(4), 0.25, 1e-12);
  EXPECT_NEAR(*needed({}, {6, 12, {}}).ratio(4), 2.0, 1e-12);
  EXPECT_FALSE(needed({}, {6, {}, {}}).ratio(4)) << "neither found it";
  EXPECT_FALSE(needed(4, {4, 4, 6}).ratio(4)) << "the first drives were enough for both";
}

TEST(DrivesNeeded, TheMedianRatioHasAnIntervalByOrderStatistics) {
  std::vector<DrivesNeededCase> cases;
  for (const std::size_t designed : {6U, 8U, 10U, 12U, 16U, 20U})
    cases.push_back(needed(designed, {20, 20, 20}));
  cases.push_back(needed(4, {4, 4, 4}));
  cases.push_back(needed({}, {{}, {}, {}}));
  const DrivesNeededSummary s = summary_of(cases, 4);
  EXPECT_EQ(s.campaigns, 8U);
  EXPECT_EQ(s.compared, 6U);
  EXPECT_EQ(s.first_enough, 1U);
  EXPECT_EQ(s.designed_not_found, 1U);
  EXPECT_EQ(s.random_not_found, 3U);
  EXPECT_NEAR(*s.median_ratio, 0.55, 1e-12);
  // Of six coins all alike is less than 0.05 either way, one other is more.
  EXPECT_NEAR(*s.ratio_low, 0.3, 1e-12);
  EXPECT_NEAR(*s.ratio_high, 1.0, 1e-12);
}

}  // namespace
}  // namespace slipway::gap
