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

// The belief about ground that no map names.
inline constexpr std::string_view kUnknownGround = "unknown_ground";

// What the service ships, by name: immutable once loaded.
struct Catalogue {
  std::map<std::string, std::shared_ptr<const sim::RoverModel>, std::less<>> rovers;
  std::map<std::string, sim::SoilDistribution, std::less<>> soils;
  std::map<std::string, std::shared_ptr<const TerrainSite>, std::less<>> terrains;
  std::map<std::string, RuleSet, std::less<>> rules;
  const sim::SoilFormat* soil_format = &sim::soil_format();  // that the soils were read by
};

// Loads rovers/*.json, soils/*.json, rules/*.json and terrains/*/terrain.json under the folder. The faults of
// all files are reported together; pointers begin with the file, "rovers/mer-class.json#/mass_kg".
Result<Catalogue> load_catalogue(const std::filesystem::path& data,
                                 const sim::SoilFormat& format = sim::soil_format());

// The catalogue with soils that stand in for those of the same names, or beside them. Errors:
// invalid_request, places under "/beliefs".
Result<Catalogue> with_soils(Catalogue catalogue, const std::vector<sim::SoilDistribution>& soils);

template <class Map>
std::vector<std::string> names_of(const Map& map) {
  std::vector<std::string> names;
  names.reserve(map.size());
  for (const auto& [name, value] : map) names.push_back(name);
  return names;
}

}  // namespace slipway::api
