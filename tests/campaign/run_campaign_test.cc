#include "campaign/run_campaign.h"

#include <gtest/gtest.h>

#include <atomic>
#include <fstream>
#include <map>
#include <mutex>
#include <sstream>

#include "api/files/drive_table/campaign_folder.h"
#include "campaign/deformed_terrain.h"
#include "campaign/drive_csv.h"
#include "tables.h"

namespace slipway::campaign {
namespace {

namespace fs = std::filesystem;

DriveTable small_table() {
  return *read_table(kSmallTable);
}

// Every file under a folder, by name.
std::map<std::string, std::string> files_of(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file()) continue;
    std::ostringstream bytes;
    bytes << std::ifstream(entry.path(), std::ios::binary).rdbuf();
    files[fs::relative(entry.path(), folder).string()] = bytes.str();
  }
  return files;
}

// Given up once so many drives are done.
class Impatient final : public Progress {
 public:
  explicit Impatient(int drives) : left_(drives) {}
  void report(std::string_view /*stage*/, double /*fraction*/) override { --left_; }
  bool cancelled() const override { return left_ <= 0; }

 private:
  std::atomic<int> left_;
};

Result<void> run_into(const DriveTable& table, api::CampaignFolder& folder, std::size_t threads,
                      Progress& progress) {
  const std::vector<TableDrive> all = expand(table);
  std::vector<TableDrive> missing;
  for (const TableDrive& drive : all)
    if (!folder.done().contains(drive.id)) missing.push_back(drive);
  const auto run = run_campaign(
      table, missing, {.threads = threads},
      [&](const TableDrive& drive, const MadeDrive& made) { return folder.write_drive(table, drive, made); },
      progress);
  if (!run) return run;
  const auto summaries = folder.conclude(table, all);
  if (!summaries) return fail(summaries.error());
  return {};
}

std::map<std::string, std::string> whole_campaign(const std::string& name, std::size_t threads) {
  const DriveTable table = small_table();
  const fs::path path = empty_folder(name);
  auto folder = api::CampaignFolder::open(path, "a digest", false);
  NoProgress progress;
  const auto run = run_into(table, *folder, threads, progress);
  EXPECT_TRUE(run) << run.error().detail;
  return files_of(path);
}

TEST(RunCampaign, TheSameBytesOnAnyNumberOfThreads) {
  const auto one = whole_campaign("one_thread", 1);
  EXPECT_EQ(one, whole_campaign("three_threads", 3));
  EXPECT_TRUE(one.contains("ahead-level-h000-r1.csv"));
  EXPECT_TRUE(one.contains("both-leg1.csv"));
  EXPECT_TRUE(one.contains("both-leg2.csv"));
  EXPECT_TRUE(one.contains("both-deformed.tif"));
  EXPECT_TRUE(one.contains("level.tif"));
  EXPECT_TRUE(one.contains("drives/turn.json"));
  EXPECT_TRUE(one.contains("plots/ahead-slope-h090-r2.svg"));
  EXPECT_TRUE(one.contains("plots/slip_by_terrain.svg"));
  EXPECT_TRUE(one.contains("summary.json"));
}

TEST(RunCampaign, GoingOnGivesTheBytesOfAnUnbrokenRun) {
  const auto unbroken = whole_campaign("unbroken", 2);
  const DriveTable table = small_table();
  const fs::path path = empty_folder("broken");
  {
    auto folder = api::CampaignFolder::open(path, "a digest", false);
    Impatient impatient(3);
    const auto run = run_into(table, *folder, 1, impatient);
    ASSERT_FALSE(run);
    EXPECT_EQ(run.error().code, ErrorCode::kCancelled);
  }
  // What a kill leaves behind: a file that is not whole, and one whose drive has no record yet.
  std::ofstream(path / ".turn.csv.17-3.slipway-part") << "t_s,x";
  std::ofstream(path / "turn.csv") << "t_s,x_m\n0,1\n";
  auto folder = api::CampaignFolder::open(path, "a digest", false);
  ASSERT_TRUE(folder);
  EXPECT_EQ(folder->done().size(), 3U);
  NoProgress progress;
  ASSERT_TRUE(run_into(table, *folder, 2, progress));
  EXPECT_EQ(files_of(path), unbroken);
}

TEST(RunCampaign, WhatIsNotOfThisProgramIsLeftInTheFolder) {
  const fs::path path = empty_folder("foreign");
  fs::create_directories(path / "drives");
  const std::vector<fs::path> foreign{path / "thesis.part", path / "turn.csv.part",
                                      path / "drives" / "x.part"};
  for (const fs::path& file : foreign) std::ofstream(file) << "mine";
  auto folder = api::CampaignFolder::open(path, "a digest", false);
  ASSERT_TRUE(folder) << folder.error().detail;
  NoProgress progress;
  ASSERT_TRUE(run_into(small_table(), *folder, 2, progress));
  for (const fs::path& file : foreign) EXPECT_EQ(fs::file_size(file), 4U) << file;
}

TEST(RunCampaign, TwoAtOnceInOneFolderAreAConflict) {
  const fs::path path = empty_folder("shared");
  {
    const auto first = api::CampaignFolder::open(path, "a digest", false);
    ASSERT_TRUE(first) << first.error().detail;
    const auto second = api::CampaignFolder::open(path, "a digest", true);
    ASSERT_FALSE(second);
    EXPECT_EQ(second.error().code, ErrorCode::kConflict);
    EXPECT_NE(second.error().detail.find("another process works with"), std::string::npos);
  }
  EXPECT_TRUE(api::CampaignFolder::open(path, "a digest", false)) << "the right to it ends with its holder";
}

TEST(RunCampaign, ARecordThatCantBeReadIsADriveToMakeAgain) {
  const auto whole = whole_campaign("torn", 2);
  const fs::path path = fs::path(SLIPWAY_TEST_OUTPUT) / "torn";
  std::ofstream(path / "drives" / "turn.json") << R"({"id": "tu)";
  auto folder = api::CampaignFolder::open(path, "a digest", false);
  ASSERT_TRUE(folder) << folder.error().detail;
  EXPECT_FALSE(folder->done().contains("turn"));
  ASSERT_EQ(folder->notes().size(), 1U);
  EXPECT_NE(folder->notes()[0].find("turn.json is no drive's record"), std::string::npos);
  NoProgress progress;
  ASSERT_TRUE(run_into(small_table(), *folder, 2, progress));
  EXPECT_TRUE(folder->notes().empty());
  EXPECT_EQ(files_of(path), whole);
}

TEST(RunCampaign, AFolderOfAnotherTableIsLeftAlone) {
  whole_campaign("another", 2);
  const fs::path path = fs::path(SLIPWAY_TEST_OUTPUT) / "another";
  const auto refused = api::CampaignFolder::open(path, "another digest", false);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::kConflict);
  EXPECT_TRUE(fs::exists(path / "turn.csv"));
  const auto over = api::CampaignFolder::open(path, "another digest", true);
  ASSERT_TRUE(over);
  EXPECT_TRUE(over->done().empty());
  EXPECT_FALSE(fs::exists(path / "turn.csv"));
}

TEST(RunCampaign, AFolderOfSomebodyElsesCampaignIsRefused) {
  const fs::path path = empty_folder("measured");
  fs::create_directories(path);
  std::ofstream(path / "campaign.json") << "{}";
  EXPECT_FALSE(api::CampaignFolder::open(path, "a digest", true));
}

TEST(RunCampaign, ADriveIsTheSameInAnyCompany) {
  const DriveTable table = small_table();
  const std::vector<TableDrive> all = expand(table);
  NoProgress progress;
  std::mutex mutex;
  std::map<std::string, MadeDrive> made;
  const auto run = run_campaign(
      table, all, {.threads = 2},
      [&](const TableDrive& drive, const MadeDrive& m) {
        const std::lock_guard lock(mutex);
        made.emplace(drive.id, m);
        return Result<void>();
      },
      progress);
  ASSERT_TRUE(run);
  const MadeDrive alone = make_drive(table, all[3], &sim::simulate_drive, progress);
  const CsvOptions options;
  EXPECT_EQ(drive_csv(*table.rover, alone.readings, options),
            drive_csv(*table.rover, made.at(all[3].id).readings, options));
  // Repeats meet soils of their own.
  EXPECT_NE(made.at(all[2].id).soils.unknown.friction_angle_rad,
            made.at(all[3].id).soils.unknown.friction_angle_rad);
}

TEST(RunCampaign, WithoutDrawsEveryDriveIsOnTheMeanSoil) {
  DriveTable table = small_table();
  table.draw_soils = false;
  NoProgress progress;
  const MadeDrive made = make_drive(table, expand(table)[1], &sim::simulate_drive, progress);
  EXPECT_EQ(made.soils.unknown.friction_angle_rad,
            table.soils.find("dry_sand")->second.mean.friction_angle_rad);
}

Result<sim::DynamicDrive> lost(const sim::RoverModel&, double, const sim::Ground&, const sim::DriveSoils&,
                               const Pose2&, std::span<const sim::DriveLeg>, const sim::DynamicOptions&,
                               const sim::DriveSink&, Progress&) {
  return fail(ErrorCode::kNoData, "the drive leaves the ground at (1, 2) m");
}

TEST(RunCampaign, ADriveWithoutAnAnswerIsRecordedAndTheOthersGoOn) {
  const DriveTable table = small_table();
  const fs::path path = empty_folder("lost");
  auto folder = api::CampaignFolder::open(path, "a digest", false);
  NoProgress progress;
  const std::vector<TableDrive> all = expand(table);
  ASSERT_TRUE(run_campaign(
      table, all, {.threads = 2, .simulator = &lost},
      [&](const TableDrive& drive, const MadeDrive& made) { return folder->write_drive(table, drive, made); },
      progress));
  const auto summaries = folder->conclude(table, all);
  ASSERT_TRUE(summaries) << summaries.error().detail;
  EXPECT_EQ(summaries->front().ends.at("no_data"), 6);
  EXPECT_FALSE(folder->done().at("turn").answered);
  EXPECT_FALSE(fs::exists(path / "turn.csv"));
}

TEST(RunCampaign, AnErrorOfTheTakerEndsIt) {
  const DriveTable table = small_table();
  NoProgress progress;
  const auto run = run_campaign(
      table, expand(table), {.threads = 1, .simulator = &lost},
      [](const TableDrive&, const MadeDrive&) {
        return Result<void>(fail(ErrorCode::kUnwritableFile, "full"));
      },
      progress);
  ASSERT_FALSE(run);
  EXPECT_EQ(run.error().code, ErrorCode::kUnwritableFile);
}

TEST(RunCampaign, ASoilMapIsDrivenOnAndTold) {
  DriveTable table = small_table();
  TableTerrain& slope = table.terrains[1];
  const dem::GridGeometry halves{
      .rows = 1, .columns = 2, .west_m = -3.0, .north_m = 3.0, .cell_x_m = 3.0, .cell_y_m = 6.0};
  slope.soil_map = std::make_shared<const dem::SoilMap>(
      halves, std::vector<std::int16_t>{0, 4}, std::vector<std::uint8_t>{0, 1},
      std::vector<dem::SoilClass>{{.value = 4, .label = "", .soil = "mpf_drift"}});
  const fs::path path = empty_folder("soil_map");
  auto folder = api::CampaignFolder::open(path, "a digest", false);
  NoProgress progress;
  ASSERT_TRUE(run_into(table, *folder, 2, progress));
  const MadeDrive made = make_drive(table, expand(table)[4], &sim::simulate_drive, progress);
  ASSERT_EQ(made.soils.known.size(), 1U);
  EXPECT_NE(made.soils.known[0].friction_angle_rad, made.soils.unknown.friction_angle_rad);
  const auto files = files_of(path);
  EXPECT_TRUE(files.contains("slope-soil.tif"));
  EXPECT_FALSE(files.contains("level-soil.tif"));
  EXPECT_NE(files.at("campaign.json")
                .find(R"("soil":{"raster":"slope-soil.tif","classes":{"4":"mpf_drift","0":"dry_sand"}})"),
            std::string::npos);
}

TEST(DeformedTerrain, IsLoweredByTheRutsAndNowhereElse) {
  const DriveTable table = small_table();
  const dem::Terrain& ground = *table.terrains[1].ground;
  sim::RutMap ruts;
  EXPECT_EQ(deformed_terrain(ground, ruts), nullptr);
  ruts.press({0.0, 0.0}, {0.5, 0.0}, 0.12, 0.03);
  const auto deformed = deformed_terrain(ground, ruts);
  ASSERT_NE(deformed, nullptr);
  EXPECT_NEAR(*deformed->height_m(0.25, 0.0), *ground.height_m(0.25, 0.0) - 0.03, 1e-4);
  EXPECT_NEAR(*deformed->height_m(0.25, 0.5), *ground.height_m(0.25, 0.5), 1e-4);
  EXPECT_FALSE(deformed->height_m(2.5, 0.0));
}

}  // namespace
}  // namespace slipway::campaign
