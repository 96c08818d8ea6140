#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "api/files/drive_outcomes.h"
#include "api/files/stops.h"
#include "api/files/terrain_description.h"
#include "core/result.h"
#include "dem/body_degrees.h"
#include "dem/elevation_source.h"
#include "dem/soil_map.h"
#include "dem/terrain.h"
#include "steps/slip_step.h"

namespace slipway::api {

// The part of a terrain that one request needs, in memory.
struct GroundWindow {
  std::shared_ptr<const dem::Terrain> terrain;
  std::shared_ptr<const dem::SoilMap> soil_map;
};

// A file of a terrain's folder, as it is now.
struct TerrainFile {
  std::string name;
  std::uintmax_t bytes = 0;
  std::string sha256;  // 64 hexadecimal digits
};

// The file beside an imported terrain's terrain.json that has the SHA-256 of its maps.
inline constexpr const char* kDigestsFile = "digests.json";
// "digests/1" of files as they are now. Only their names and digests are written.
std::string digests_document(const std::vector<TerrainFile>& files);

// A terrain that the service ships: described, opened, read by windows. Maps of which the import has kept
// digests are compared with them before the first read, and before the next one when a file has another size,
// time or place on the disk: every read fails with damaged_store where they are others. Thread-safe.
class TerrainSite {
 public:
  // Reads and checks terrain.json, opens the elevation, reads the stops. All faults together,
  // unreadable_data.
  static Result<std::shared_ptr<const TerrainSite>> open(const std::filesystem::path& folder);

  const std::filesystem::path& folder() const { return folder_; }
  // 16 hexadecimal digits: another terrain of this name has another one, and the same files have the same on
  // every machine. Of the bytes of its files; of one above 4 MB of its size and 256 pieces all over it.
  const std::string& version() const { return version_; }
  const TerrainDescription& description() const { return description_; }
  const dem::ElevationInfo& info() const { return elevation_->info(); }
  const std::vector<Stop>& stops() const { return stops_; }
  // Drives of the past on this ground; none where the terrain has no such table.
  const DriveOutcomeTable& outcomes() const { return outcomes_; }
  // Slip that was measured on this ground, by sol; none where the terrain has no such table.
  const std::vector<steps::SlipStep>& steps() const { return steps_; }

  // The ground over the extent, which is clipped to the terrain, by one of its legends. Errors as
  // dem::ElevationSource::read.
  Result<GroundWindow> read(const dem::Extent& extent, const Legend& legend) const;
  Result<GroundWindow> read(const dem::Extent& extent) const {
    return read(extent, description_.legends.front());
  }
  // Its soils only, by one of its legends: no height is read. Errors as dem::read_soil_raster and
  // dem::read_soil_polygons, off_map.
  Result<std::shared_ptr<const dem::SoilMap>> read_soils(const dem::Extent& extent, const Legend& legend,
                                                         int step = 1) const;
  // Of all of a small terrain, read once and kept; of a larger one those over the extent, of about one cell
  // for every `step` along each side.
  Result<std::shared_ptr<const dem::SoilMap>> soils_for_pictures(const dem::Extent& extent,
                                                                 const Legend& legend, int step) const;
  // Whether its maps are what was imported; so are those without digests. Errors: damaged_store with the file
  // and what to do.
  Result<void> unaltered() const;
  // Elevation only, thinned for pictures: see dem::ElevationSource::read_samples.
  Result<std::shared_ptr<const dem::Terrain>> read_samples(const dem::Extent& extent, int step) const;
  // The files that terrain.json names, with itself first, and LICENSE where there is one. Reads them through.
  Result<std::vector<TerrainFile>> files() const;
  // The text of a file beside terrain.json; nothing where there is none.
  Result<std::optional<std::string>> text_of(const std::optional<std::string>& file) const;
  // East longitude and latitude [deg] of a place of the map; nothing in a local frame.
  std::optional<dem::MapPlace> degrees_at(const dem::MapPlace& place) const;
  // Elevation only.
  Result<std::shared_ptr<const dem::Terrain>> read_elevation(const dem::Extent& extent) const;
  // The same of a few cells around a point that lies on the map.
  Result<std::shared_ptr<const dem::Terrain>> read_around(double x_m, double y_m, double radius_m) const;

 private:
  // By which a file is known again without reading it.
  struct Stamp {
    std::int64_t bytes = 0, changed_ns = 0;
    std::uint64_t inode = 0;
    bool operator==(const Stamp&) const = default;
  };

  TerrainSite() = default;

  std::vector<std::string> file_names() const;
  Result<std::string> version_of_files() const;
  // Over the cells of the terrain that the geometry has. Unknown ground all over may be a single cell.
  Result<std::shared_ptr<const dem::SoilMap>> soils_over(const dem::GridGeometry& geometry,
                                                         const Legend& legend, bool one_cell_if_unknown,
                                                         int step = 1) const;

  std::filesystem::path folder_;
  std::string version_;
  TerrainDescription description_;
  std::shared_ptr<const dem::ElevationSource> elevation_;
  std::vector<Stop> stops_;
  DriveOutcomeTable outcomes_;
  std::vector<steps::SlipStep> steps_;
  std::map<std::string, std::string> digests_;  // by the file's name
  mutable std::mutex stamps_mutex_;
  mutable std::map<std::string, Stamp> stamps_;  // of files that were as their digests say
  mutable std::mutex kept_mutex_;
  mutable std::map<std::string, std::shared_ptr<const dem::SoilMap>> kept_soils_;  // by the legend's name
};

inline constexpr const char* kLicenceFile = "LICENSE";

// A file of the service's own data, whole. Errors: unreadable_data where it can't be read or is no regular
// file.
Result<std::string> read_data_file(const std::filesystem::path& path);

}  // namespace slipway::api
