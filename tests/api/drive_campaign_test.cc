// Reading a "drive-campaign/1" from its folder: the practice campaigns, which another simulator made, and
// small ones with one thing wrong.

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "api/files/campaign/drive_campaign_source.h"
#include "core/angle.h"
#include "sim/rover/drive_command.h"

namespace slipway::api {
namespace {

namespace fs = std::filesystem;

const fs::path kPractice = fs::path(SLIPWAY_DATA_FOLDER) / "gap-practice";

std::string first_fault(const Result<gap::DriveCampaign>& campaign) {
  return campaign ? "none" : campaign.error().detail;
}

// The practice campaigns' wheels turn faster on the outside of arcs than the rover's file allows.
TEST(DriveCampaign, PracticeCampaignsLoadWithoutANoteButOnTheirRates) {
  for (const char* name : {"p01", "p03", "p05", "p08"}) {
    const auto campaign = load_drive_campaign(kPractice / name, Catalogue{});
    ASSERT_TRUE(campaign) << name << ": " << first_fault(campaign);
    EXPECT_EQ(campaign->name, name);
    EXPECT_EQ(campaign->drives.size(), 44U);
    EXPECT_EQ(campaign->terrains.size(), 5U);
    EXPECT_EQ(campaign->soils.size(), 1U);
    for (const std::string& note : campaign->notes)
      EXPECT_NE(note.find("above the rover's greatest rate"), std::string::npos) << note;
    EXPECT_EQ(campaign->fingerprint.size(), 16U);
    for (const gap::MeasuredDriveSeries& drive : campaign->drives) {
      EXPECT_EQ(drive.samples.size(), drive.command.turn_in_place ? 21U : 31U) << drive.id;
      ASSERT_LT(drive.terrain, 5U);
      for (const gap::DriveSample& sample : drive.samples) {
        EXPECT_TRUE(campaign->terrains[drive.terrain].ground->at(sample.p_MB.x(), sample.p_MB.y()));
        EXPECT_EQ(campaign->terrains[drive.terrain].ground->soil_at(sample.p_MB.x(), sample.p_MB.y()), 0U);
      }
    }
  }
}

TEST(DriveCampaign, CellsAreWhereTheFileHasThem) {
  const auto campaign = load_drive_campaign(kPractice / "p01", Catalogue{});
  ASSERT_TRUE(campaign) << first_fault(campaign);
  EXPECT_EQ(campaign->gravity_m_s2, 3.71);
  EXPECT_EQ(campaign->rover->mass_kg, 174.0);
  EXPECT_EQ(campaign->soils[0].name, "nominal");
  EXPECT_EQ(campaign->soils[0].soil.shear_modulus_y_m, 0.01);
  EXPECT_EQ(campaign->soils[0].soil.c1, 0.18);
  EXPECT_EQ(campaign->soils[0].soil.gravity_m_s2, 3.71);
  EXPECT_EQ(campaign->measurement_std.attitude_rad, rad_from_deg(0.2));
  const gap::MeasuredDriveSeries& drive = campaign->drives[0];
  EXPECT_EQ(drive.id, "D001");
  EXPECT_EQ(drive.command.speed_m_s, 0.05);
  EXPECT_EQ(drive.duration_s, 60.0);
  const gap::DriveSample& first = drive.samples[0];
  EXPECT_EQ(first.p_MB, Eigen::Vector3d(0.001697751, -0.003052217, 0.002441881));
  EXPECT_EQ(first.attitude.pitch_rad, rad_from_deg(-0.2609308));
  EXPECT_EQ(first.wheels[3].current_a, 0.178056);
  EXPECT_EQ(first.wheels[5].sinkage_m, 0.01135769);
  EXPECT_EQ(first.wheels[0].motor_temp_c, -20.0);
  EXPECT_EQ(first.bus_voltage_v, 28.0);
  EXPECT_EQ(drive.samples[1].time_s, 2.0);
  EXPECT_TRUE(std::isnan(drive.samples[1].wheels[0].sinkage_m));
}

// What says how turning in place and curvature are meant: the rates and angles that the wheels were
// commanded. That simulator drove some arcs faster than the rover's greatest wheel rate, which it did not
// know.
TEST(DriveCampaign, CommandsAreThoseThatTheWheelsWereGiven) {
  for (const char* name : {"p01", "p03", "p05", "p08"}) {
    const auto campaign = load_drive_campaign(kPractice / name, Catalogue{});
    ASSERT_TRUE(campaign) << first_fault(campaign);
    for (const gap::MeasuredDriveSeries& drive : campaign->drives) {
      sim::RoverModel rover = *campaign->rover;
      rover.drive.max_wheel_rate_rad_s *= 2.0;
      const auto told = sim::wheel_commands(rover, drive.command);
      for (std::size_t k = 0; k < told.size(); ++k) {
        const double measured_rate = drive.samples[0].wheels[k].rate_rad_s;
        EXPECT_NEAR(measured_rate, told[k].rate_rad_s, 0.01 * std::abs(told[k].rate_rad_s))
            << name << " " << drive.id << " wheel " << k;
        EXPECT_NEAR(drive.samples[0].wheels[k].steer_rad, told[k].steer_rad, rad_from_deg(0.1))
            << name << " " << drive.id << " wheel " << k;
      }
    }
  }
}

}  // namespace
}  // namespace slipway::api
