#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "api/files/drive_rules.h"
#include "api/files/terrain_site.h"
#include "core/result.h"
#include "sim/rover/rover_model.h"
#include "sim/soil/soil_field.h"

namespace slipway::api {

// The belief about ground of Mars that no map names.
inline constexpr std::string_view kUnknownGround = "unknown_ground";

// The belief about ground that no map names, on the body of this gravity: that of Mars, or
// unknown_ground_moon or unknown_ground_earth.
std::string_view unknown_ground_at(double gravity_m_s2);

// A file of the data folder that is not used, since it has faults. Their pointers begin with the file,
// "rovers/mer-class.json#/mass_kg".
struct LeftOutFile {
  std::string kind;  // "rover", "soil", "rules" or "terrain"
  std::string name;  // of what it describes; of a file of soils, the file's
  std::vector<Fault> faults;
};

// What the service ships, by name: immutable once loaded.
struct Catalogue {
  std::map<std::string, std::shared_ptr<const sim::RoverModel>, std::less<>> rovers;
  std::map<std::string, sim::SoilDistribution, std::less<>> soils;
  std::map<std::string, std::shared_ptr<const TerrainSite>, std::less<>> terrains;
  std::map<std::string, RuleSet, std::less<>> rules;
  std::vector<LeftOutFile> left_out;
  const sim::SoilFormat* soil_format = &sim::soil_format();  // that the soils were read by
};

// Loads rovers/*.json, soils/*.json, rules/*.json and terrains/*/terrain.json under the folder. Files with
// faults are left out, and so is what needs them. Where the folder has no belief about unmapped ground of the
// Moon or of Earth, that of Mars stands in. Errors: unreadable_data where no rover is left or no soil
// of the name kUnknownGround, with the faults of all files.
Result<Catalogue> load_catalogue(const std::filesystem::path& data,
                                 const sim::SoilFormat& format = sim::soil_format());

// The catalogue with the terrains terrains/*/terrain.json under another folder beside its own, which keep
// their names. Those with faults are left out.
Catalogue with_terrains(Catalogue catalogue, const std::filesystem::path& folder);

// The catalogue with soils that stand in for those of the same names, or beside them. One that has
// alternatives can't be an alternative itself, but that unmapped ground of the Moon and of Earth keeps the
// soils that ship. Errors:
// invalid_request, places under "/beliefs".
Result<Catalogue> with_soils(Catalogue catalogue, const std::vector<sim::SoilDistribution>& soils);

// What to say of a name that the catalogue does not have: the nearest of those that it has, and whether a
// file that was left out may have had it.
std::string unknown_rover(const Catalogue& catalogue, std::string_view name);
std::string unknown_soil(const Catalogue& catalogue, std::string_view name);
std::string unknown_terrain(const Catalogue& catalogue, std::string_view name);

// The terrain of a name as it was at TerrainSite::version(); an empty version is any. Errors: not_found;
// conflict where the terrain was replaced since.
Result<std::shared_ptr<const TerrainSite>> terrain_at(const Catalogue& catalogue, std::string_view name,
                                                      const std::string& version);

template <class Map>
std::vector<std::string> names_of(const Map& map) {
  std::vector<std::string> names;
  names.reserve(map.size());
  for (const auto& [name, value] : map) names.push_back(name);
  return names;
}

}  // namespace slipway::api
