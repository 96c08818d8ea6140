#include "api/files/terrain_site.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <string_view>
#include <system_error>
#include <utility>

#include "api/files/slip_steps_file.h"
#include "api/files/terrain_file.h"
#include "api/files/whole_file.h"
#include "api/json/faults.h"
#include "api/json/parse.h"
#include "api/json/strict_reader.h"
#include "api/json/writer.h"
#include "core/sha256.h"

namespace slipway::api {
namespace {

constexpr long long kMostKeptSoilCells = 1'000'000;  // three bytes each
constexpr std::uintmax_t kMaxFileBytes = std::uintmax_t{64} << 20U;

dem::Extent clipped(const dem::Extent& wanted, const dem::Extent& map) {
  return {std::max(wanted.west_m, map.west_m), std::max(wanted.south_m, map.south_m),
          std::min(wanted.east_m, map.east_m), std::min(wanted.north_m, map.north_m)};
}

// Of a large file 256 pieces at equal distances, the first and the last of them its ends: 4 MB.
Result<std::string> spread_pieces(const std::filesystem::path& path, std::uintmax_t size) {
  constexpr std::uintmax_t kPieces = 256, kPiece = 16384;
  std::ifstream file(path, std::ios::binary);
  std::string pieces(kPieces * kPiece, '\0');
  for (std::uintmax_t k = 0; file && k < kPieces; ++k) {
    file.seekg(static_cast<std::streamoff>(k * (size - kPiece) / (kPieces - 1)));
    file.read(&pieces[k * kPiece], kPiece);
  }
  if (!file)
    return fail(ErrorCode::kUnreadableData, fmt::format("{} could not be read", path.filename().string()));
  return pieces;
}

// A plain file, not a link out of the folder.
bool is_plain_file(const std::filesystem::path& path) {
  std::error_code error;
  return std::filesystem::is_regular_file(std::filesystem::symlink_status(path, error)) && !error;
}

void check_files(const std::filesystem::path& folder, const TerrainDescription& terrain,
                 std::vector<Fault>& faults) {
  const auto check = [&](std::string_view pointer, const std::string& file) {
    if (is_plain_file(folder / file)) return;
    std::error_code error;
    const std::string why =
        std::filesystem::is_symlink(folder / file, error)
            ? fmt::format("{} is a symbolic link, which is not followed: put the file itself there", file)
            : fmt::format("there is no file {} beside terrain.json", file);
    faults.push_back({std::string(pointer), why});
  };
  check("/elevation", terrain.elevation_file);
  if (terrain.soil_source == SoilSource::kRaster) check("/soil/raster", terrain.soil_file);
  if (terrain.soil_source == SoilSource::kPolygons) check("/soil/polygons", terrain.soil_file);
  if (terrain.stops_file) check("/stops", *terrain.stops_file);
  if (terrain.outcomes_file) check("/drive_outcomes", *terrain.outcomes_file);
  if (terrain.steps_file) check("/measured_slip", *terrain.steps_file);
  if (terrain.provenance_file) check("/provenance", *terrain.provenance_file);
}

// Piece by piece: an elevation may be larger than the memory.
Result<TerrainFile> read_through(const std::filesystem::path& path) {
  TerrainFile file;
  file.name = path.filename().string();
  std::ifstream stream(path, std::ios::binary);
  Sha256 hash;
  std::string piece(std::size_t{1} << 20U, '\0');
  while (stream) {
    stream.read(piece.data(), static_cast<std::streamsize>(piece.size()));
    const auto got = static_cast<std::size_t>(stream.gcount());
    hash.add(std::string_view(piece).substr(0, got));
    file.bytes += got;
  }
  if (!stream.eof()) return fail(ErrorCode::kUnreadableData, fmt::format("{} can't be read", file.name));
  file.sha256 = hash.digest();
  return file;
}

// Of the import's digests; none where the terrain was made otherwise.
Result<std::map<std::string, std::string>> read_digests(const std::filesystem::path& folder) {
  std::map<std::string, std::string> digests;
  if (!is_plain_file(folder / kDigestsFile)) return digests;
  const auto bytes = read_data_file(folder / kDigestsFile);
  if (!bytes) return fail(bytes.error());
  const auto document = json::parse(*bytes);
  if (!document) return fail(document.error());
  std::vector<Fault> faults;
  json::ObjectReader reader(*document, "", faults);
  std::size_t format = 0;
  reader.choice("format", json::kRequired, {"digests/1"}, format);
  for (const json::Element& element : reader.list("files", json::kRequired, {0, 100})) {
    json::ObjectReader file = reader.object(element);
    std::string name, sha256;
    file.text("name", json::kRequired, {.most = 100}, name);
    file.text("sha256", json::kRequired, {.most = 64}, sha256);
    digests[name] = sha256;
  }
  if (!faults.empty()) return fail(ErrorCode::kUnreadableData, summary_of(faults), faults);
  return digests;
}

}  // namespace

std::string digests_document(const std::vector<TerrainFile>& files) {
  json::Writer w;
  w.begin_object().text("format", "digests/1").key("files").begin_array();
  for (const TerrainFile& file : files)
    w.begin_object().text("name", file.name).text("sha256", file.sha256).end_object();
  w.end_array().end_object();
  return w.take() + "\n";
}

Result<std::string> read_data_file(const std::filesystem::path& path) {
  std::error_code error;
  const auto size = std::filesystem::file_size(path, error);
  if (error || !is_plain_file(path)) {
    return fail(ErrorCode::kUnreadableData,
                fmt::format("{} can't be read as a file", path.filename().string()));
  }
  if (size > kMaxFileBytes) {
    return fail(ErrorCode::kUnreadableData, fmt::format("{} has {} bytes, at most {} are read",
                                                        path.filename().string(), size, kMaxFileBytes));
  }
  std::ifstream stream(path, std::ios::binary);
  std::string bytes((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
  if (!stream && !stream.eof()) {
    return fail(ErrorCode::kUnreadableData, fmt::format("{} can't be read", path.filename().string()));
  }
  return bytes;
}

Result<std::shared_ptr<const TerrainSite>> TerrainSite::open(const std::filesystem::path& folder) {
  const auto bytes = read_data_file(folder / "terrain.json");
  if (!bytes) return fail(bytes.error());
  auto description = json::read_terrain_file(*bytes);
  if (!description) return fail(description.error());
  std::shared_ptr<TerrainSite> site(new TerrainSite);
  site->folder_ = folder;
  site->description_ = std::move(*description);
  std::vector<Fault> faults;
  if (site->description_.name != folder.filename().string()) {
    faults.push_back({"/name", fmt::format("name = {}, must be the name of its folder, {}",
                                           in_quotes(site->description_.name), folder.filename().string())});
  }
  check_files(folder, site->description_, faults);
  if (auto digests = read_digests(folder))
    site->digests_ = *std::move(digests);
  else
    faults.push_back({"", fmt::format("{} can't be read ({}): import the terrain again", kDigestsFile,
                                      digests.error().detail)});
  if (faults.empty()) {
    auto elevation = dem::open_elevation(folder / site->description_.elevation_file);
    if (elevation) {
      site->elevation_ = *elevation;
    } else {
      faults.push_back({"/elevation", elevation.error().detail});
    }
    if (site->description_.stops_file) {
      const auto csv = read_data_file(folder / *site->description_.stops_file);
      auto stops = csv ? read_stops(*csv) : Result<std::vector<Stop>>(fail(csv.error()));
      if (stops) {
        site->stops_ = std::move(*stops);
      } else {
        faults.push_back({"/stops", stops.error().detail});
      }
    }
    if (site->description_.outcomes_file) {
      const auto table = read_data_file(folder / *site->description_.outcomes_file);
      auto outcomes = table ? read_drive_outcomes(*table) : Result<DriveOutcomeTable>(fail(table.error()));
      if (outcomes) {
        site->outcomes_ = std::move(*outcomes);
      } else {
        faults.push_back({"/drive_outcomes", outcomes.error().detail});
      }
    }
    if (site->description_.steps_file) {
      auto steps =
          read_slip_steps_file(folder / *site->description_.steps_file, *site->description_.steps_file);
      if (steps)
        site->steps_ = std::move(*steps);
      else
        faults.push_back({"/measured_slip", steps.error().detail});
    }
  }
  if (!faults.empty()) return fail(ErrorCode::kUnreadableData, summary_of(faults), faults);
  auto version = site->version_of_files();
  if (!version) return fail(version.error());
  site->version_ = *std::move(version);
  return std::shared_ptr<const TerrainSite>(std::move(site));
}

Result<std::string> TerrainSite::version_of_files() const {
  constexpr std::uintmax_t kReadThrough = std::uintmax_t{4} << 20U;
  constexpr std::size_t kDigits = 16;
  Sha256 hash;
  for (const std::string& name : file_names()) {
    std::error_code error;
    const std::uintmax_t size = std::filesystem::file_size(folder_ / name, error);
    if (error) return fail(ErrorCode::kUnreadableData, fmt::format("{}: {}", name, error.message()));
    hash.add(fmt::format("{} {}\n", size, name));
    const auto bytes =
        size > kReadThrough ? spread_pieces(folder_ / name, size) : read_data_file(folder_ / name);
    if (!bytes) return fail(bytes.error());
    hash.add(*bytes);
  }
  return hash.digest().substr(0, kDigits);
}

Result<void> TerrainSite::unaltered() const {
  const std::scoped_lock lock(stamps_mutex_);
  for (const auto& [name, sha256] : digests_) {
    struct ::stat status {};
    const bool there = ::stat((folder_ / name).c_str(), &status) == 0;
    const Stamp now{status.st_size,
                    std::int64_t{status.st_mtim.tv_sec} * 1'000'000'000 + status.st_mtim.tv_nsec,
                    status.st_ino};
    if (const auto known = stamps_.find(name); there && known != stamps_.end() && known->second == now)
      continue;
    if (const auto found = sha256_of_file(folder_ / name); !there || !found || *found != sha256)
      return fail(ErrorCode::kDamagedStore,
                  fmt::format("{} of the terrain {} is not what was imported: import the terrain again", name,
                              description_.name));
    stamps_[name] = now;
  }
  return {};
}

Result<GroundWindow> TerrainSite::read(const dem::Extent& extent, const Legend& legend) const {
  if (const auto same = unaltered(); !same) return fail(same.error());
  auto terrain = elevation_->read(clipped(extent, info().geometry.extent()));
  if (!terrain) return fail(terrain.error());
  auto soil_map = soils_over((*terrain)->geometry(), legend, (*terrain)->is_read_by_tiles());
  if (!soil_map) return fail(soil_map.error());
  return GroundWindow{*terrain, *soil_map};
}

Result<std::shared_ptr<const dem::SoilMap>> TerrainSite::read_soils(const dem::Extent& extent,
                                                                    const Legend& legend, int step) const {
  if (const auto same = unaltered(); !same) return fail(same.error());
  const dem::GridGeometry& all = info().geometry;
  const auto window = all.window(clipped(extent, all.extent()));
  if (!window) return fail(ErrorCode::kOffMap, "The extent does not meet the terrain.");
  return soils_over(all.sub(*window), legend, true, step);
}

Result<std::shared_ptr<const dem::SoilMap>> TerrainSite::soils_for_pictures(const dem::Extent& extent,
                                                                            const Legend& legend,
                                                                            int step) const {
  if (const auto same = unaltered(); !same) return fail(same.error());
  const dem::GridGeometry& all = info().geometry;
  if (static_cast<long long>(all.rows) * all.columns > kMostKeptSoilCells)
    return read_soils(extent, legend, step);
  const std::scoped_lock lock(kept_mutex_);
  std::shared_ptr<const dem::SoilMap>& kept = kept_soils_[legend.name];
  if (!kept) {
    auto read = read_soils(all.extent(), legend);
    if (!read) return read;
    kept = *read;
  }
  return kept;
}

Result<std::shared_ptr<const dem::SoilMap>> TerrainSite::soils_over(const dem::GridGeometry& geometry,
                                                                    const Legend& legend,
                                                                    bool one_cell_if_unknown,
                                                                    int step) const {
  switch (description_.soil_source) {
    case SoilSource::kRaster:
      return dem::read_soil_raster(folder_ / description_.soil_file, info(), geometry.extent(),
                                   legend.classes, step);
    case SoilSource::kPolygons:
      return dem::read_soil_polygons(folder_ / description_.soil_file, info(), geometry.extent(),
                                     description_.soil_property, description_.soil_coordinates,
                                     legend.classes, step);
    case SoilSource::kNone:
      break;
  }
  dem::GridGeometry unknown = geometry;
  if (one_cell_if_unknown) {
    unknown.cell_x_m *= unknown.columns;
    unknown.cell_y_m *= unknown.rows;
    unknown.rows = unknown.columns = 1;
  }
  const auto cells = static_cast<std::size_t>(unknown.rows) * static_cast<std::size_t>(unknown.columns);
  return std::make_shared<const dem::SoilMap>(unknown, std::vector<std::int16_t>(cells, 0),
                                              std::vector<std::uint8_t>(cells, 0),
                                              std::vector<dem::SoilClass>{});
}

Result<std::shared_ptr<const dem::Terrain>> TerrainSite::read_samples(const dem::Extent& extent,
                                                                      int step) const {
  if (const auto same = unaltered(); !same) return fail(same.error());
  return elevation_->read_samples(clipped(extent, info().geometry.extent()), step);
}

Result<std::optional<std::string>> TerrainSite::text_of(const std::optional<std::string>& file) const {
  if (!file || !is_plain_file(folder_ / *file)) return std::nullopt;
  auto text = read_data_file(folder_ / *file);
  if (!text) return fail(text.error());
  return *std::move(text);
}

std::vector<std::string> TerrainSite::file_names() const {
  std::vector<std::string> names{"terrain.json", description_.elevation_file};
  if (description_.soil_source != SoilSource::kNone) names.push_back(description_.soil_file);
  for (const auto& file : {description_.stops_file, description_.outcomes_file, description_.steps_file,
                           description_.provenance_file})
    if (file) names.push_back(*file);
  if (is_plain_file(folder_ / kLicenceFile)) names.emplace_back(kLicenceFile);
  return names;
}

Result<std::vector<TerrainFile>> TerrainSite::files() const {
  std::vector<TerrainFile> files;
  for (const std::string& name : file_names()) {
    auto file = read_through(folder_ / name);
    if (!file) return fail(file.error());
    files.push_back(*std::move(file));
  }
  return files;
}

std::optional<dem::MapPlace> TerrainSite::degrees_at(const dem::MapPlace& place) const {
  return dem::BodyDegrees(info().crs_wkt, info().body, info().geometry.extent()).to_degrees(place);
}

Result<std::shared_ptr<const dem::Terrain>> TerrainSite::read_elevation(const dem::Extent& extent) const {
  if (const auto same = unaltered(); !same) return fail(same.error());
  return elevation_->read(clipped(extent, info().geometry.extent()));
}

Result<std::shared_ptr<const dem::Terrain>> TerrainSite::read_around(double x_m, double y_m,
                                                                     double radius_m) const {
  const dem::GridGeometry& geometry = info().geometry;
  const double margin = std::max(radius_m, 2.0 * std::max(geometry.cell_x_m, geometry.cell_y_m));
  return read_elevation({x_m - margin, y_m - margin, x_m + margin, y_m + margin});
}

}  // namespace slipway::api
