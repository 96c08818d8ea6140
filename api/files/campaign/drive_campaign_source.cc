#include "api/files/campaign/drive_campaign_source.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <map>
#include <set>
#include <system_error>
#include <utility>

#include "api/files/campaign/drive_campaign_file.h"
#include "api/files/campaign/drive_series_csv.h"
#include "api/files/rover_file.h"
#include "api/files/terrain_site.h"
#include "api/json/faults.h"
#include "api/json/text_place.h"
#include "core/digest.h"
#include "dem/elevation_source.h"
#include "dem/soil_map.h"
#include "gap/diagnosis/model/drive_window.h"
#include "gap/diagnosis/model/reading_plausibility.h"
#include "planner/problem/terrain_ground.h"

namespace slipway::api {
namespace {

namespace fs = std::filesystem;

using json::kCampaignDocument;

// What a campaign may cost in memory: 180 MB of terrain, and about half a gigabyte of samples.
constexpr long long kMaxCells = dem::kMaxWindowCells;
// A file is read to its end for its digest, and one may have holes of any size.
constexpr std::uintmax_t kMaxRasterBytes = std::uintmax_t{4} << 30U;
constexpr std::size_t kMaxRows = 1'000'000;

// The file's true place, or why it is not to be read.
Result<fs::path> place_in(const fs::path& folder, const std::string& name) {
  const fs::path relative(name);
  const bool climbs =
      std::any_of(relative.begin(), relative.end(), [](const fs::path& p) { return p == ".."; });
  if (name.find('\0') != std::string::npos || relative.is_absolute() || climbs)
    return fail(ErrorCode::kUnreadableData,
                in_quotes(name) + " must lie in the campaign's folder: a path from there, without \"..\"");
  std::error_code error;
  const fs::path root = fs::canonical(folder, error);
  const fs::path path = error ? fs::path() : fs::canonical(root / relative, error);
  if (error)
    return fail(ErrorCode::kUnreadableData,
                in_quotes(name) + " does not exist in the campaign's folder, or may not be read");
  const auto [end, ignored] = std::mismatch(root.begin(), root.end(), path.begin(), path.end());
  if (end != root.end())
    return fail(ErrorCode::kUnreadableData,
                in_quotes(name) + " is a link that leads out of the campaign's folder");
  if (!fs::is_regular_file(path, error))
    return fail(ErrorCode::kUnreadableData, in_quotes(name) + " is no regular file");
  return path;
}

// Of a file of any size.
std::uint64_t digest_of_file(const fs::path& path, std::uint64_t digest) {
  std::ifstream stream(path, std::ios::binary);
  std::array<char, 1 << 16> block{};
  while (stream.read(block.data(), block.size()) || stream.gcount() > 0)
    digest = fnv1a({block.data(), static_cast<std::size_t>(stream.gcount())}, digest);
  return digest;
}

class Loader {
 public:
  Loader(const fs::path& folder, std::string_view document, json::DriveCampaignFile file)
      : folder_(folder), document_(document), file_(std::move(file)), digest_(fnv1a(document)) {
    for (const Fault& fault : file_.faults) add(fault.pointer, fault.message);
    if (!file_.rover) return;  // then columns of wheels are passed over, with the fault that says why
    for (const sim::WheelModel& wheel : file_.rover->wheels) wheels_.push_back(wheel.name);
  }

  Result<gap::DriveCampaign> load() {
    campaign_.name = file_.name;
    campaign_.gravity_m_s2 = file_.gravity_m_s2;
    campaign_.rover = file_.rover;
    campaign_.soils = file_.soils;
    campaign_.measurement_std = file_.measurement_std;
    campaign_.parameter_std = file_.parameter_std;
    campaign_.notes = file_.notes;
    for (const json::CampaignTerrainEntry& entry : file_.terrains) read_terrain(entry);
    for (json::CampaignDriveEntry& entry : file_.drives) read_drive(entry);
    for (const std::string& words : missing_noise(campaign_.measurement_std, campaign_.drives))
      add("/measurement_std", words);
    if (!faults_.empty()) return fail(ErrorCode::kUnreadableData, summary_of(faults_), faults_);
    note_columns();
    json::Writer rover;
    json::write_rover(rover, *campaign_.rover);
    campaign_.fingerprint = fmt::format("{:016x}", fnv1a(rover.take(), digest_));
    return std::move(campaign_);
  }

 private:
  struct Elevation {
    dem::ElevationInfo info;
    std::shared_ptr<const dem::Terrain> terrain;
    std::uint64_t digest = 0;
  };

  void add(const std::string& pointer, const std::string& message) {
    faults_.push_back({fmt::format("{}#{}", kCampaignDocument, pointer),
                       json::with_place(kCampaignDocument, document_, pointer, message)});
  }

  std::size_t soil_index(const std::string& name) const {
    const auto at = std::find_if(file_.soils.begin(), file_.soils.end(),
                                 [&](const gap::NominalSoil& soil) { return soil.name == name; });
    return at == file_.soils.end() ? 0 : static_cast<std::size_t>(at - file_.soils.begin());
  }

  // Terrains may share a raster: it is read once.
  Result<const Elevation*> elevation_in(const std::string& name) {
    const auto path = place_in(folder_, name);
    if (!path) return fail(path.error());
    if (const auto known = elevations_.find(*path); known != elevations_.end()) return &known->second;
    std::error_code unknown;
    if (const auto bytes = fs::file_size(*path, unknown); unknown || bytes > kMaxRasterBytes)
      return fail(ErrorCode::kUnreadableData,
                  fmt::format("{} has {} bytes, must have {} at most: cut it to where the drives are",
                              in_quotes(name), bytes, kMaxRasterBytes));
    const auto source = dem::open_elevation(*path, dem::PlacelessRaster::kLocalFrame);
    if (!source) return fail(source.error());
    const dem::GridGeometry& geometry = (*source)->info().geometry;
    cells_ += static_cast<long long>(geometry.rows) * geometry.columns;
    if (cells_ > kMaxCells)
      return fail(
          ErrorCode::kUnreadableData,
          fmt::format("the campaign's terrains have more than {} cells: cut them to where the drives are",
                      kMaxCells));
    const auto terrain = (*source)->read(geometry.extent());
    if (!terrain) return fail(terrain.error());
    const std::uint64_t digest = digest_of_file(*path, kFnvBasis);
    return &elevations_.emplace(*path, Elevation{(*source)->info(), *terrain, digest}).first->second;
  }

  void read_terrain(const json::CampaignTerrainEntry& entry) {
    gap::CampaignTerrain& terrain = campaign_.terrains.emplace_back();
    terrain.name = entry.name;
    if (entry.dem.empty()) return;
    const auto elevation = elevation_in(entry.dem);
    if (!elevation) return add(entry.pointer + "/dem", elevation.error().detail);
    std::uint64_t digest = fnv1a((*elevation)->terrain->fingerprint());
    if (!entry.soil.empty()) {
      terrain.ground =
          std::make_shared<const planner::TerrainGround>((*elevation)->terrain, soil_index(entry.soil));
    } else if (!entry.soil_raster.empty()) {
      terrain.ground = mapped_ground(entry, **elevation, digest);
    }
    terrain.fingerprint = fmt::format("{:016x}", digest);
    digest_ = fnv1a(fmt::format("{:016x}{}", (*elevation)->digest, terrain.fingerprint), digest_);
  }

  std::shared_ptr<const sim::Ground> mapped_ground(const json::CampaignTerrainEntry& entry,
                                                   const Elevation& elevation, std::uint64_t& digest) {
    const auto refuse = [&](const Error& error) {
      add(entry.pointer + "/soil/raster", error.detail);
      return nullptr;
    };
    const auto path = place_in(folder_, entry.soil_raster);
    if (!path) return refuse(path.error());
    const auto map =
        dem::read_soil_raster(*path, elevation.info, elevation.info.geometry.extent(), entry.classes);
    if (!map) return refuse(map.error());
    digest = digest_of_file(*path, digest);
    std::vector<std::size_t> soils;
    for (const std::string& name : (*map)->soils()) soils.push_back(soil_index(name));
    for (const dem::SoilClass& row : entry.classes)
      digest = fnv1a(fmt::format("{} {};", row.value, row.soil.value_or("")), digest);
    return std::make_shared<const planner::TerrainGround>(elevation.terrain, *map, std::move(soils));
  }

  void read_drive(json::CampaignDriveEntry& entry) {
    gap::MeasuredDriveSeries& drive = campaign_.drives.emplace_back(std::move(entry.drive));
    if (entry.file.empty()) return;
    const auto path = place_in(folder_, entry.file);
    const auto bytes = path ? read_data_file(*path) : Result<std::string>(fail(path.error()));
    if (!bytes) return add(entry.pointer + "/file", bytes.error().detail);
    digest_ = fnv1a(*bytes, digest_);
    DriveSeries series = read_drive_series(*bytes, entry.file, wheels_, kMaxRows - rows_);
    rows_ += series.samples.size();
    faults_.insert(faults_.end(), series.faults.begin(), series.faults.end());
    passed_over_.merge(series.passed_over);
    drive.samples = std::move(series.samples);
    take_ends_of_final_only(campaign_, drive);
  }

  void note_columns() {
    if (passed_over_.empty()) return;
    constexpr std::size_t kMaxNamed = 200;
    std::vector<std::string> names(passed_over_.begin(), passed_over_.end());
    const std::size_t more = names.size() > kMaxNamed ? names.size() - kMaxNamed : 0;
    names.resize(names.size() - more);
    for (std::string& name : names)
      if (const auto meant = column_meant(name, wheels_))
        name += fmt::format(" (did you mean \"{}\"?)", *meant);
    campaign_.notes.push_back(fmt::format("columns that the format does not have were passed over: {}{}",
                                          fmt::join(names, ", "),
                                          more > 0 ? fmt::format(" and {} more", more) : ""));
  }

  const fs::path& folder_;
  std::string_view document_;  // the bytes of campaign.json
  json::DriveCampaignFile file_;
  std::vector<std::string> wheels_;  // the names of the rover's
  std::uint64_t digest_;
  std::map<fs::path, Elevation> elevations_;
  long long cells_ = 0;
  std::size_t rows_ = 0;
  std::set<std::string> passed_over_;
  std::vector<Fault> faults_;
  gap::DriveCampaign campaign_;
};

// Where campaign.json is, or why nothing is to be had from what was given as its folder.
Result<fs::path> document_in(const fs::path& folder) {
  std::error_code error;
  const std::string name = folder.string();
  if (!fs::exists(folder, error))
    return fail(ErrorCode::kUnreadableData,
                fmt::format("there is no folder \"{}\", or it may not be read", name));
  if (!fs::is_directory(folder, error))
    return fail(ErrorCode::kUnreadableData,
                fmt::format("\"{}\" is no folder: a campaign is the folder that {} lies in", name,
                            kCampaignDocument));
  if (fs::symlink_status(folder / kCampaignDocument, error).type() == fs::file_type::not_found)
    return fail(ErrorCode::kUnreadableData,
                fmt::format("there is no {} in the folder \"{}\"", kCampaignDocument, name));
  return place_in(folder, std::string(kCampaignDocument));
}

}  // namespace

Result<gap::DriveCampaign> load_drive_campaign(const fs::path& folder, const Catalogue& catalogue) {
  const std::string document(kCampaignDocument);
  const auto path = document_in(folder);
  if (!path)
    return fail(ErrorCode::kUnreadableData, path.error().detail, {{document + "#", path.error().detail}});
  const auto bytes = read_data_file(*path);
  if (!bytes)
    return fail(ErrorCode::kUnreadableData, bytes.error().detail, {{document + "#", bytes.error().detail}});
  auto file = json::read_drive_campaign_file(*bytes, catalogue);
  if (!file)
    return fail(ErrorCode::kUnreadableData, summary_of(file.error().faults),
                moved_under(document + "#", file.error().faults));
  auto campaign = Loader(folder, *bytes, std::move(*file)).load();
  if (!campaign) return campaign;
  take_as_recorded(*campaign);
  return campaign;
}

std::vector<std::string> missing_noise(const gap::MeasurementStd& std,
                                       std::span<const gap::MeasuredDriveSeries> drives) {
  std::vector<std::string> missing;
  const auto ask = [&](const char* keys, double gap::WheelReading::*reading, const char* channel) {
    for (const gap::MeasuredDriveSeries& drive : drives)
      for (const gap::DriveSample& sample : drive.samples)
        for (const gap::WheelReading& wheel : sample.wheels)
          if (std::isfinite(wheel.*reading)) {
            missing.push_back(
                fmt::format("{} must be given and not 0: drive {} has {}, and no sensor is exact", keys,
                            in_quotes(drive.id), channel));
            return;
          }
  };
  if (std.current_relative == 0.0 && std.current_a == 0.0)
    ask("current_rel or current_a", &gap::WheelReading::current_a, "currents");
  if (std.sinkage_m == 0.0) ask("sinkage_m", &gap::WheelReading::sinkage_m, "sinkages");
  return missing;
}

void take_ends_of_final_only(gap::DriveCampaign& campaign, gap::MeasuredDriveSeries& drive) {
  if (!drive.final_only || drive.samples.size() <= 2) return;
  campaign.notes.push_back(
      fmt::format("drive {} is final_only and its file has {} rows: the first and the last were taken",
                  drive.id, drive.samples.size()));
  drive.samples.erase(drive.samples.begin() + 1, drive.samples.end() - 1);
}

void take_as_recorded(gap::DriveCampaign& campaign) {
  gap::adopt_measured_rates(campaign);
  gap::note_turned_against_command(campaign);
  gap::take_same_rows_as_repeats(campaign);
  for (std::string& note : gap::notes_of_implausible_readings(campaign))
    campaign.notes.push_back(std::move(note));
  if (gap::currents_split_evenly(campaign))
    campaign.notes.emplace_back(
        "all wheels have the same current in every row: it is taken for a total that was divided evenly, and "
        "compared as the wheels' mean");
}

}  // namespace slipway::api
