// A small campaign of two drives with one thing wrong at a time: what is said, and where. And with anything
// wrong: it loads or tells faults, whatever the bytes.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>

#include "api/files/campaign/drive_campaign_source.h"
#include "core/angle.h"
#include "core/random.h"
#include "dem/geotiff.h"
#include "drive_campaign_folder.h"

namespace slipway::api {
namespace {

namespace fs = std::filesystem;
using testing::DriveCampaignFolder;
using testing::file_bytes;
using testing::kDocument;
using testing::kHeader;
using testing::kRows;
using testing::write_file;

TEST_F(DriveCampaignFolder, AsItIsItLoadsAndSaysWhatWasPassedOver) {
  const auto campaign = load();
  ASSERT_TRUE(campaign) << campaign.error().detail;
  ASSERT_EQ(campaign->drives.size(), 2U);
  EXPECT_EQ(campaign->rover->wheels.size(), 4U);
  EXPECT_EQ(campaign->rover->name, "Four Wheels");
  EXPECT_EQ(campaign->drives[0].command.speed_m_s, -0.05);
  EXPECT_EQ(campaign->drives[0].command.curvature_1_m, 0.2);
  EXPECT_EQ(campaign->drives[0].samples[0].wheels[0].current_a, 0.25);
  EXPECT_TRUE(std::isnan(campaign->drives[0].samples[1].wheels[0].current_a));
  EXPECT_TRUE(std::isnan(campaign->drives[0].samples[0].attitude.yaw_rad));
  EXPECT_EQ(campaign->drives[1].repeat_of, "a");
  EXPECT_NEAR(campaign->drives[1].command.turn_rate_rad_s, -0.05 / 0.5, 1e-12);
  EXPECT_TRUE(campaign->drives[1].samples[0].p_MB.hasNaN());
  ASSERT_EQ(campaign->notes.size(), 2U);
  EXPECT_NE(campaign->notes[0].find("density_kg_m3 = 1500, c1 = 0.4, c2 = 0.2"), std::string::npos);
  EXPECT_NE(campaign->notes[1].find("passed over: sky"), std::string::npos);
}

TEST_F(DriveCampaignFolder, NoiseIsAskedForOfWhatWasMeasuredAlone) {
  edit(R"("current_a": 0.01,
                     "sinkage_m": 0.002})",
       R"("current_a": 0.01})");
  ASSERT_TRUE(load()) << "no drive has sinkages";
  write("a.csv", "t_s,x_m,y_m,z_m,lf_sinkage_m\n0,1,2,0.5,0.01\n2,1.1,2,0.5,\n");
  expect_fault("campaign.json#/measurement_std",
               "sinkage_m must be given and not 0: drive \"a\" has sinkages");
  edit(R"("current_rel": 0.02, "current_a": 0.01,)", "");
  ASSERT_TRUE(load()) << "no drive has currents";
  write("a.csv", kHeader + kRows);
  expect_fault("campaign.json#/measurement_std", "current_rel or current_a must be given");
}

TEST_F(DriveCampaignFolder, ATurnRateThatIsGivenCountsAndIsOurOwnKey) {
  edit("\"turn_in_place\": true,", "\"turn_in_place\": true, \"turn_rate_deg_s\": 3, \"crab_deg\": 10,");
  const auto campaign = load();
  ASSERT_TRUE(campaign) << campaign.error().detail;
  EXPECT_EQ(campaign->drives[1].command.turn_rate_rad_s, rad_from_deg(3.0));
}

TEST_F(DriveCampaignFolder, WhatWasMeasuredOfParametersIsReadByItsNamesAlone) {
  edit("\"drives\": [\n", "\"parameter_std\": {\"n\": 0.01, \"torque_constant\": 0.002}, \"drives\": [\n");
  const auto campaign = load();
  ASSERT_TRUE(campaign) << campaign.error().detail;
  EXPECT_EQ(campaign->parameter_std,
            (std::map<std::string, double, std::less<>>{{"n", 0.01}, {"torque_constant", 0.002}}));
  edit("\"drives\": [\n", "\"parameter_std\": {\"stifness\": 0.01, \"n\": 0}, \"drives\": [\n");
  expect_fault("campaign.json#/parameter_std/stifness", "did you mean \"stiffness\"");
  expect_fault("campaign.json#/parameter_std/n", "n = 0");
}

TEST_F(DriveCampaignFolder, UnknownKeysAreNotedOnceAndSlipsOfRequiredOnesRefused) {
  edit("\"drives\": [\n  {", "\"weather\": 1, \"drives\": [\n  {\"driver\": \"me\", ");
  const auto campaign = load();
  ASSERT_TRUE(campaign) << campaign.error().detail;
  EXPECT_NE(campaign->notes[1].find("/drives/*/driver, /weather"), std::string::npos) << campaign->notes[1];
  edit("\"mass_kg\"", "\"mas_kg\"");
  expect_fault("campaign.json#/rover/mas_kg", "did you mean \"mass_kg\"");
  expect_fault("campaign.json#/rover/mass_kg", "mass_kg is missing");
}

TEST_F(DriveCampaignFolder, EveryFaultOfEveryFileIsToldAtOnce) {
  edit("\"gravity_m_s2\": 3.71", "\"gravity_m_s2\": -1");
  write("a.csv", kHeader + "0,1,2,x,0,0\n0,1,2,0,0,0\n");
  write("b.csv", "t_s\n0\n");
  const auto campaign = load();
  ASSERT_FALSE(campaign);
  EXPECT_EQ(campaign.error().code, ErrorCode::kUnreadableData);
  EXPECT_EQ(campaign.error().faults.size(), 4U);
  expect_fault("campaign.json#/gravity_m_s2", "gravity_m_s2 = -1 m/s^2");
  expect_fault("a.csv#/2/z_m", "a.csv, line 2, column 4 (z_m): \"x\" is no finite number");
  expect_fault("a.csv#/3/t_s", "a.csv, line 3, column 1 (t_s): t_s = 0 s after 0 s");
  expect_fault("b.csv#/2/t_s", "b.csv, line 2, column 1 (t_s): the file ends after 1 rows");
}

TEST_F(DriveCampaignFolder, FaultsOfADrivesFileHaveLineAndColumn) {
  expect_csv_fault("", "/1", "a.csv, line 1, column 1: the file is empty");
  expect_csv_fault("time\n0\n1\n", "/1/time", "a.csv, line 1, column 1 (time): there is no column t_s");
  expect_csv_fault("t_s,x_m,y_m,z_m,t_s\n0,0,0,0,0\n1,0,0,0,0\n", "/1/t_s",
                   "column 5 (t_s): \"t_s\" is column 1 as well");
  expect_csv_fault("t_s,,x\n0,0,0\n1,0,0\n", "/1", "line 1, column 2: the column has no name");
  expect_csv_fault(kHeader + kRows + "3,1\n", "/4/y_m",
                   "line 4, column 3 (y_m): the row has 2 cells, must have 6");
  expect_csv_fault(kHeader + kRows + "3,1,1,1,1,1,1\n", "/4", "line 4, column 7: the row has 7 cells");
  expect_csv_fault(kHeader + kRows + "3,nan,0,0,,\n", "/4/x_m",
                   "line 4, column 2 (x_m): \"nan\" is no finite number");
  expect_csv_fault(kHeader + kRows + "3,0,-inf,0,,\n", "/4/y_m", "line 4, column 3 (y_m): \"-inf\"");
  expect_csv_fault(kHeader + kRows + "3,0,0,1e400,,\n", "/4/z_m", "is no finite number");
  expect_csv_fault(kHeader + kRows + ",0,0,0,,\n", "/4/t_s", "column 1 (t_s): the cell is empty");
  expect_csv_fault(kHeader + kRows + "1.5,0,0,0,,\n", "/4/t_s", "t_s = 1.5 s after 2 s");
  expect_csv_fault(kHeader + kRows + "3,0,,0,,\n", "/4/y_m", "a position is measured as a whole");
  expect_csv_fault(kHeader + kRows + "3,0,0,0,1e6,\n", "/4/lf_current_a",
                   "column 5 (lf_current_a): 1000000, must be in");
  expect_csv_fault("t_s,roll_deg,yaw_deg\n0,0,0\n1,0,0\n", "/1/roll_deg", "but no column pitch_deg");
  expect_csv_fault("t_s,x_m,y_m\n0,0,0\n1,0,0\n", "/1/x_m", "there is x_m, y_m, but no column z_m");
  expect_csv_fault("t_s\n0\n\xFF\xFE\n", "/3/t_s", "\"??\" is no finite number");
}

// One fault says which separator was found and which is expected, however many rows and columns there are.
TEST_F(DriveCampaignFolder, AnotherSeparatorIsOneFaultOfTheFile) {
  for (const auto& [separator, words] :
       {std::pair<char, std::string>{';', "\";\""}, {'\t', "tabs"}, {' ', "\" \""}}) {
    std::string bytes = kHeader + kRows;
    std::replace(bytes.begin(), bytes.end(), ',', separator);
    expect_csv_fault(
        bytes, "/1",
        "a.csv, line 1, column 1: the columns are separated by " + words + ", must be separated by \",\"");
    const auto campaign = load();
    ASSERT_FALSE(campaign);
    EXPECT_EQ(campaign.error().faults.size(), 1U) << words;
  }
}

TEST_F(DriveCampaignFolder, WhatOthersWriteIsRead) {
  // A byte order mark, Windows lines, spaces, signs, blank lines, and columns of no wheel.
  write("a.csv",
        "\xEF\xBB\xBFt_s, x_m, y_m, z_m, yaw_rate_deg_s\r\n0, +1, 2, 0, x\r\n\r\n1, 1, 2, 0,\r\n\r\n");
  const auto campaign = load();
  ASSERT_TRUE(campaign) << campaign.error().detail;
  EXPECT_EQ(campaign->drives[0].samples.size(), 2U);
  EXPECT_EQ(campaign->drives[0].samples[0].p_MB.x(), 1.0);
}

TEST_F(DriveCampaignFolder, FaultsOfTheDocumentHaveTheirPointer) {
  write("campaign.json", "{\n \"format\": }");
  expect_fault("campaign.json#", "campaign.json, line 2, column 12: ");
  edit("\"gravity_m_s2\": 3.71,", "\"gravity_m_s2\": 3.71, \"name\": \"again\",");
  expect_fault("campaign.json#/name",
               "campaign.json, line 2, column 40 (/name): key \"name\" is given twice");
  write("campaign.json", "[1,\n  " + std::string(80, '[') + std::string(80, ']') + "]");
  std::string deep = "/1";
  for (int level = 0; level < 62; ++level) deep += "/0";
  expect_fault("campaign.json#" + deep, "campaign.json, line 2, column 65 (" + deep + "): nested deeper");
  edit("\"terrain\": \"level\", \"repeat_of\"", "\"terrain\": \"hill\", \"repeat_of\"");
  expect_fault("campaign.json#/drives/1/terrain", "unknown terrain \"hill\"");
  edit("\"id\": \"b\"", "\"id\": \"a\"");
  expect_fault("campaign.json#/drives/1/id", "id = \"a\" is that of /drives/0 as well");
  edit("\"repeat_of\": \"a\"", "\"repeat_of\": \"c\"");
  expect_fault("campaign.json#/drives/1/repeat_of", "there is no drive of this id");
  edit("\"repeat_of\": \"a\"", "\"repeat_of\": \"b\"");
  expect_fault("campaign.json#/drives/1/repeat_of", "is the drive itself");
  edit("\"b.csv\"", "\"c.csv\"");
  expect_fault("campaign.json#/drives/1/file", "\"c.csv\" does not exist");
  edit("\"soil\": \"sand\"", "\"soil\": \"snad\"");
  expect_fault("campaign.json#/terrains/level/soil", "did you mean \"sand\"");
  edit("\"level.tif\"", "\"a.csv\"");
  expect_fault("campaign.json#/terrains/level/dem", "a.csv is not a readable raster");
  edit("\"speed_m_s\": -0.05, \"curvature_1_m\": 0.2", "\"speed_m_s\": 0, \"curvature_1_m\": 0.2");
  expect_fault("campaign.json#/drives/0/commanded/speed_m_s", "speed_m_s = 0 m/s");
  edit("\"speed_m_s\": -0.05, \"curvature_1_m\": 0,", "\"speed_m_s\": 0, \"curvature_1_m\": 0,");
  expect_fault("campaign.json#/drives/1/commanded/speed_m_s", "turns in place at no rate");
  edit("\"k_c\": 1000", "\"k_c\": -100000");
  expect_fault("campaign.json#/soils/sand/k_phi", "k_c / b + k_phi");
  edit("\"com_m\": [0, 0, 0.3]", "\"com_m\": [2, 0, 0.3]");
  expect_fault("campaign.json#/rover/com_m", "com_m lies outside the wheels");
}

TEST_F(DriveCampaignFolder, AFolderThatIsNoneIsNamedAsItWasGiven) {
  const auto detail_of = [](const fs::path& folder) {
    return load_drive_campaign(folder, Catalogue{}).error().detail;
  };
  EXPECT_EQ(detail_of("nothere"), "there is no folder \"nothere\", or it may not be read");
  const fs::path document = path() / "campaign.json";
  EXPECT_EQ(detail_of(document), "\"" + document.string() +
                                     "\" is no folder: a campaign is the folder that campaign.json lies in");
  fs::remove(document);
  expect_fault("campaign.json#", "there is no campaign.json in the folder \"" + path().string() + "\"");
}

TEST_F(DriveCampaignFolder, ColumnsOfWheelsThatTheRoverDoesNotHaveArePassedOver) {
  write("a.csv",
        "t_s,l1_motor_temp_c,LR_current_a,zz_steer_deg,yaw_rate_deg_s,bus_voltage\n0,x,,1,1,1\n1,x,,1,1,1\n");
  const auto campaign = load();
  ASSERT_TRUE(campaign) << campaign.error().detail;
  EXPECT_EQ(
      campaign->notes.back(),
      "columns that the format does not have were passed over: LR_current_a (did you mean "
      "\"lr_current_a\"?), bus_voltage (did you mean \"bus_voltage_v\"?), l1_motor_temp_c (did you mean "
      "\"lf_motor_temp_c\"?), yaw_rate_deg_s, zz_steer_deg");
}

TEST_F(DriveCampaignFolder, NothingOutsideTheFolderIsRead) {
  const testing::ScratchFolder other;
  write_file(other.path() / "b.csv", "t_s\n0\n1\n");
  fs::create_symlink(other.path() / "b.csv", path() / "link.csv");
  edit("\"b.csv\"", "\"link.csv\"");
  expect_fault("campaign.json#/drives/1/file", "is a link that leads out of the campaign's folder");
  edit("\"b.csv\"", "\"" + (other.path() / "b.csv").string() + "\"");
  expect_fault("campaign.json#/drives/1/file", "must lie in the campaign's folder");
  edit("\"b.csv\"", "\"../" + other.path().filename().string() + "/b.csv\"");
  expect_fault("campaign.json#/drives/1/file", "must lie in the campaign's folder");
  edit("\"level.tif\"", "\"../level.tif\"");
  expect_fault("campaign.json#/terrains/level/dem", "must lie in the campaign's folder");
  // A folder within is inside.
  fs::create_directory(path() / "drives");
  write("drives/b.csv", "t_s\n0\n1\n");
  edit("\"b.csv\"", "\"drives/b.csv\"");
  EXPECT_TRUE(load());
}

TEST_F(DriveCampaignFolder, ARasterWithAHoleOfAnySizeIsNotReadToItsEnd) {
  fs::resize_file(path() / "level.tif", std::uintmax_t{1} << 40U);  // takes no place on the disk
  expect_fault("campaign.json#/terrains/level/dem", "1099511627776 bytes");
}

TEST_F(DriveCampaignFolder, ClassesNameTheSoilsOfTheirCells) {
  // West of x = 0 class 3, east of it class 7, and a column without a class.
  const dem::GridGeometry grid{
      .rows = 2, .columns = 3, .west_m = -10, .north_m = 10, .cell_x_m = 10, .cell_y_m = 10};
  const std::vector<dem::SoilClass> legend{{3, "3", "sand"}, {7, "7", "dust"}, {9, "9", std::nullopt}};
  const dem::SoilMap map(grid, {3, 7, 9, 3, 7, 9}, std::vector<std::uint8_t>(6, 1), legend);
  write("classes.tif", *dem::encode_geotiff(map, 9, ""));
  const std::string sand = kDocument.substr(kDocument.find("{\"k_c\""),
                                            kDocument.find("},\n \"terrains\"") - kDocument.find("{\"k_c\""));
  std::string text = kDocument;
  text.replace(text.find("{\"sand\""), 1, "{\"dust\": " + sand + ", ");
  text.replace(text.find("\"soil\": \"sand\""), 14,
               R"("soil": {"raster": "classes.tif", "classes": {"3": "sand", "7": "dust"}})");
  write("campaign.json", text);
  const auto campaign = load();
  ASSERT_TRUE(campaign) << campaign.error().detail;
  const sim::Ground& ground = *campaign->terrains[0].ground;
  ASSERT_EQ(campaign->soils[0].name, "dust");
  EXPECT_EQ(ground.soil_at(-5.0, 5.0), 1U);
  EXPECT_EQ(ground.soil_at(5.0, 5.0), 0U);
  EXPECT_EQ(ground.soil_at(15.0, 5.0), std::nullopt);
  text.replace(text.find("\"7\": \"dust\""), 11, "\"x\": \"lust\"");
  write("campaign.json", text);
  expect_fault("campaign.json#/terrains/level/soil/classes/x", "\"x\" is no class");
  expect_fault("campaign.json#/terrains/level/soil/classes/x", "did you mean \"dust\"");
}

TEST_F(DriveCampaignFolder, TheFingerprintChangesWithEveryFile) {
  const std::string before = load()->fingerprint;
  EXPECT_EQ(load()->fingerprint, before);
  write("b.csv", "t_s\n0\n1.5\n");
  EXPECT_NE(load()->fingerprint, before);
}

// Bytes put in, taken out and changed, in every file.
TEST_F(DriveCampaignFolder, AnyBytesLoadOrTellTheirFaults) {
  constexpr std::string_view kLikely = "0123456789.,-+eE\n\r\"{}[]:_ \0\xFF/nax";
  int loaded = 0;
  for (std::uint64_t round = 0; round < 1500; ++round) {
    const std::uint64_t key = random_key(20'26, round);
    const std::string file = round % 3 == 0 ? "campaign.json" : round % 3 == 1 ? "a.csv" : "level.tif";
    const std::string whole = file_bytes(path() / file);
    std::string bytes = whole;
    const std::uint64_t edits = 1 + random_bits(key, 0) % 6;
    for (std::uint64_t e = 0; e < edits && !bytes.empty(); ++e) {
      const std::size_t at = random_bits(key, 10 * e + 1) % bytes.size();
      const char byte = kLikely[random_bits(key, 10 * e + 2) % kLikely.size()];
      switch (random_bits(key, 10 * e + 3) % 4) {
        case 0:
          bytes[at] = byte;
          break;
        case 1:
          bytes.insert(at, 1, byte);
          break;
        case 2:
          bytes.erase(at, 1 + random_bits(key, 10 * e + 4) % 8);
          break;
        default:
          bytes[at] = static_cast<char>(random_bits(key, 10 * e + 5));
          break;
      }
    }
    write(file, bytes);
    const auto campaign = load();
    if (campaign) {
      ++loaded;
      for (const gap::MeasuredDriveSeries& drive : campaign->drives) {
        EXPECT_GE(drive.samples.size(), 2U);
        EXPECT_LT(drive.terrain, campaign->terrains.size());
      }
    } else {
      EXPECT_FALSE(campaign.error().faults.empty()) << campaign.error().detail;
      for (const Fault& fault : campaign.error().faults) {
        EXPECT_NE(fault.pointer.find('#'), std::string::npos) << fault.pointer << fault.message;
        EXPECT_FALSE(fault.message.empty());
      }
    }
    write(file, whole);
  }
  EXPECT_GT(loaded, 10);
}

// Names are compared with each other: a million would be compared for hours.
TEST_F(DriveCampaignFolder, AMillionColumnsAreRefusedAtOnce) {
  std::string header = "t_s";
  for (int c = 0; c < 1'000'000; ++c) header += "," + std::to_string(c);
  expect_csv_fault(header + "\n" + kRows, "/1", "1000001 columns, must be 1000 at most");
}

}  // namespace
}  // namespace slipway::api
