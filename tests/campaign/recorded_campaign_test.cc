// What `slipway campaign` writes is read as the drives it made.

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "api/files/campaign/drive_campaign_source.h"
#include "api/files/drive_table/campaign_folder.h"
#include "campaign/run_campaign.h"
#include "tables.h"

namespace slipway::campaign {
namespace {

// As printed: six places.
void expect_cell(double read, bool was_read, double made) {
  if (was_read)
    EXPECT_NEAR(read, made, 1e-6);
  else
    EXPECT_TRUE(std::isnan(read));
}

void expect_series(const gap::MeasuredDriveSeries& read, std::span<const sim::SensorReading> made) {
  ASSERT_EQ(read.samples.size(), made.size()) << read.id;
  for (std::size_t i = 0; i < made.size(); ++i) {
    const gap::DriveSample& sample = read.samples[i];
    EXPECT_NEAR(sample.time_s, made[i].sample.time_s, 1e-6);
    for (int axis = 0; axis < 3; ++axis)
      expect_cell(sample.p_MB[axis], made[i].has_position, made[i].sample.p_MB[axis]);
    expect_cell(sample.attitude.yaw_rad, made[i].has_attitude, made[i].sample.attitude.yaw_rad);
    for (std::size_t k = 0; k < sample.wheels.size(); ++k)
      expect_cell(sample.wheels[k].current_a, made[i].has_current, made[i].sample.wheels[k].current_a);
  }
}

TEST(RecordedCampaign, OurOwnDrivesAreReadAsTheyWereMade) {
  const DriveTable table = *read_table(kSmallTable);
  const std::filesystem::path path = empty_folder("recorded");
  auto folder = api::CampaignFolder::open(path, "a digest", false);
  std::map<std::string, std::vector<sim::SensorReading>> made;
  const std::vector<TableDrive> drives = expand(table);
  NoProgress progress;
  const auto run = run_campaign(
      table, drives, {.threads = 1},
      [&](const TableDrive& drive, const MadeDrive& result) {
        made[drive.id] = result.readings;
        return folder->write_drive(table, drive, result);
      },
      progress);
  ASSERT_TRUE(run) << run.error().detail;
  ASSERT_TRUE(folder->conclude(table, drives));

  const auto campaign = api::load_drive_campaign(path, api::Catalogue{});
  ASSERT_TRUE(campaign) << campaign.error().detail;
  EXPECT_EQ(campaign->gravity_m_s2, table.gravity_m_s2);
  EXPECT_EQ(campaign->rover->mass_kg, table.rover->mass_kg);
  EXPECT_EQ(campaign->terrains.size(), 2U);
  EXPECT_EQ(campaign->drives.size(), 11U);  // one of two legs
  std::size_t whole = 0;
  for (const gap::MeasuredDriveSeries& drive : campaign->drives) {
    EXPECT_TRUE(drive.command.turn_in_place ? drive.command.turn_rate_rad_s != 0.0
                                            : drive.command.speed_m_s != 0.0);
    const auto of = made.find(drive.id);
    if (of == made.end() || drive.final_only) continue;
    ++whole;
    expect_series(drive, of->second);
  }
  EXPECT_EQ(whole, 8U);
  EXPECT_EQ(campaign->notes.size(), 1U);  // columns that are beside the format
}

}  // namespace
}  // namespace slipway::campaign
