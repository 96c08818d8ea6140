#include "api/files/drive_table/campaign_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <system_error>
#include <utility>

#include "api/chart/drive_table_charts.h"
#include "api/files/drive_table/campaign_documents.h"
#include "api/files/terrain_site.h"
#include "api/files/whole_file.h"
#include "campaign/campaign_files.h"
#include "campaign/deformed_terrain.h"
#include "campaign/drive_csv.h"
#include "dem/geotiff.h"

namespace slipway::api {
namespace {

namespace fs = std::filesystem;

// Sorted, so that the first complaint is the same everywhere.
std::vector<fs::path> records_in(const fs::path& folder) {
  std::vector<fs::path> paths;
  std::error_code error;
  for (fs::directory_iterator it(folder / "drives", error), end; !error && it != end; it.increment(error))
    if (it->path().extension() == ".json") paths.push_back(it->path());
  std::sort(paths.begin(), paths.end());
  return paths;
}

// What a killed run was in the middle of.
void delete_unfinished(const fs::path& folder) {
  std::error_code error;
  for (const fs::path& place : {folder, folder / "drives", folder / "plots"}) {
    std::vector<fs::path> unfinished;
    for (fs::directory_iterator it(place, error), end; !error && it != end; it.increment(error))
      if (is_unfinished(it->path())) unfinished.push_back(it->path());
    for (const fs::path& path : unfinished) fs::remove(path, error);
  }
}

std::string title_of(const campaign::TableDrive& drive, const campaign::MadeDrive& made) {
  return fmt::format("{}: {}, {:.2f} of {:.2f} m", drive.id, sim::describe(made.drive->end),
                     made.drive->progress_m, made.drive->commanded_m);
}

}  // namespace

Result<CampaignFolder> CampaignFolder::open(fs::path path, std::string digest, bool start_over) {
  CampaignFolder folder(std::move(path), std::move(digest));
  std::error_code error;
  const std::vector<fs::path> records = records_in(folder.folder_);
  if (records.empty() && fs::exists(folder.folder_ / "campaign.json", error))
    return fail(ErrorCode::kConflict,
                fmt::format("{} holds a campaign that was not made here; give another folder",
                            folder.folder_.string()));
  if (const auto made = make_folder(folder.folder_); !made) return fail(made.error());
  auto lock = FileLock::take(folder.folder_);
  if (!lock)
    return fail(lock.error().code,
                fmt::format("{}; wait until it has ended, or give another folder", lock.error().detail));
  folder.lock_ = *std::move(lock);
  for (const char* part : {"drives", "plots"})
    if (const auto made = make_folder(folder.folder_ / part); !made) return fail(made.error());
  delete_unfinished(folder.folder_);
  if (start_over) folder.delete_drives();
  if (const auto read = folder.read_records(); !read) return fail(read.error());
  return folder;
}

Result<void> CampaignFolder::read_records() {
  done_.clear();
  notes_.clear();
  for (const fs::path& path : records_in(folder_)) {
    const auto bytes = read_data_file(path);
    auto record =
        bytes ? json::read_drive_record(*bytes) : Result<campaign::DriveRecord>(fail(bytes.error()));
    if (!record) {
      notes_.push_back(fmt::format("{} is no drive's record, the drive is not done: {}", path.string(),
                                   record.error().detail));
      continue;
    }
    if (record->digest != digest_)
      return fail(
          ErrorCode::kConflict,
          fmt::format("{} was made from another table, rover, soil or version; give another folder, or "
                      "--no-resume to start over",
                      path.string()));
    std::string id = record->id;
    done_.insert_or_assign(std::move(id), std::move(*record));
  }
  return {};
}

// The record first: without it a drive is not done.
void CampaignFolder::delete_drives() {
  std::error_code ignored;
  for (const fs::path& path : records_in(folder_)) {
    const auto bytes = read_data_file(path);
    const auto record =
        bytes ? json::read_drive_record(*bytes) : Result<campaign::DriveRecord>(fail(bytes.error()));
    fs::remove(path, ignored);
    if (!record) continue;
    // Only what a record of ours names, and only in this folder.
    for (const std::string& file : record->files)
      if (file.find("..") == std::string::npos && !fs::path(file).is_absolute())
        fs::remove(folder_ / file, ignored);
  }
}

Result<void> CampaignFolder::write(const std::string& file, const std::string& bytes) const {
  return write_whole_file(folder_ / file, bytes);
}

Result<std::vector<std::string>> CampaignFolder::write_measurements(const campaign::DriveTable& table,
                                                                    const campaign::TableDrive& drive,
                                                                    const campaign::MadeDrive& made) const {
  const campaign::DriveEntry& entry = table.entries[drive.entry];
  const campaign::CsvOptions options{.final_only = entry.final_only,
                                     .bus_voltage_v = table.rover->drive.bus_voltage_v,
                                     .motor_temp_c = campaign::motor_temp_c(table, entry)};
  std::vector<std::string> files;
  const int legs = static_cast<int>(entry.legs.size());
  for (int leg = 0; leg < legs; ++leg) {
    const auto readings = legs > 1 ? campaign::readings_of_leg(made.readings, leg) : made.readings;
    if (readings.empty()) continue;
    files.push_back(campaign::measurement_file(table, drive, leg));
    if (const auto written = write(files.back(), campaign::drive_csv(*table.rover, readings, options));
        !written)
      return fail(written.error());
  }
  return files;
}

Result<void> CampaignFolder::write_drive(const campaign::DriveTable& table, const campaign::TableDrive& drive,
                                         const campaign::MadeDrive& made) const {
  const campaign::DriveEntry& entry = table.entries[drive.entry];
  std::vector<std::string> files;
  if (made.drive) {
    auto measured = write_measurements(table, drive, made);
    if (!measured) return fail(std::move(measured.error()));
    files = std::move(*measured);
    const campaign::TableTerrain& terrain = table.terrains[drive.terrain];
    const auto deformed =
        entry.deformed_terrain ? campaign::deformed_terrain(*terrain.ground, made.drive->ruts) : nullptr;
    if (deformed) {
      const auto raster = dem::encode_geotiff(*deformed, terrain.crs_wkt);
      if (!raster) return fail(raster.error());
      files.push_back(campaign::deformed_terrain_file(drive));
      if (const auto written = write(files.back(), *raster); !written) return written;
    }
    if (entry.plot) {
      files.push_back(campaign::time_history_file(drive));
      const auto written =
          write(files.back(), draw_time_history(title_of(drive, made), *table.rover, made.readings));
      if (!written) return written;
    }
  }
  const campaign::DriveRecord record = campaign::record_of(table, drive, made, digest_, std::move(files));
  return write(campaign::record_file(drive), json::drive_record_document(record));
}

Result<void> CampaignFolder::write_terrains(const campaign::DriveTable& table,
                                            std::span<const campaign::TableDrive> drives) const {
  std::set<std::size_t> used;
  for (const campaign::TableDrive& drive : drives)
    if (const auto record = done_.find(drive.id); record != done_.end() && record->second.answered)
      used.insert(drive.terrain);
  for (const std::size_t t : used) {
    const campaign::TableTerrain& terrain = table.terrains[t];
    const auto raster = dem::encode_geotiff(*terrain.ground, terrain.crs_wkt);
    if (!raster) return fail(raster.error());
    if (const auto written = write(campaign::elevation_file(terrain), *raster); !written) return written;
    if (!terrain.soil_map) continue;
    const auto classes =
        dem::encode_geotiff(*terrain.soil_map, campaign::class_elsewhere(terrain), terrain.crs_wkt);
    if (!classes) return fail(classes.error());
    if (const auto written = write(campaign::soil_map_file(terrain), *classes); !written) return written;
  }
  return {};
}

Result<std::vector<campaign::TerrainSummary>> CampaignFolder::conclude(
    const campaign::DriveTable& table, std::span<const campaign::TableDrive> drives) {
  if (const auto read = read_records(); !read) return fail(read.error());
  if (const auto written = write_terrains(table, drives); !written) return fail(written.error());
  std::vector<campaign::TerrainSummary> summaries = campaign::summarise(table, drives, done_);
  const std::string poses = draw_final_poses(table, drives, done_);
  std::vector<std::pair<std::string, std::string>> files;
  if (!poses.empty()) {
    files.emplace_back(campaign::kSlipPlotFile, draw_slip_by_terrain(table, drives, done_, summaries));
    files.emplace_back(campaign::kPosesPlotFile, poses);
  }
  files.emplace_back("summary.json", json::campaign_summary_document(table, drives.size(), summaries));
  files.emplace_back("campaign.json", json::campaign_document(table, drives, done_));
  for (const auto& [file, bytes] : files)
    if (const auto written = write(file, bytes); !written) return fail(written.error());
  return summaries;
}

}  // namespace slipway::api
