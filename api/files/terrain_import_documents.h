#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "api/files/terrain_import.h"
#include "dem/terrain_import.h"

// The texts of an imported terrain.
namespace slipway::api {

// A file that was imported, and what it is.
struct SourceFile {
  std::string name;    // without its folder
  std::string sha256;  // of its bytes
  std::string format;  // "GTiff"
};

struct ImportedTerrain {
  std::string name, title;
  double gravity_m_s2 = 0.0;
  dem::ImportedElevation elevation;
  SourceFile elevation_source;
  std::string elevation_sha256;  // of what was written
  std::optional<dem::ImportedSoil> soil;
  SourceFile soil_source;
  std::string soil_file;
  std::vector<dem::SoilClass> legend;
  std::vector<std::string> legend_notes = {};  // of its text
};

// terrain.json ("terrain/1").
std::string terrain_document(const TerrainImport& order, const ImportedTerrain& made);
// PROVENANCE.md: the sources with their hashes, system, extent, licence, what was changed.
std::string provenance_text(const TerrainImport& order, const ImportedTerrain& made);
// What the command prints.
std::string import_text(const ImportedTerrain& made);
// The same as JSON ("terrain-import/1").
std::string import_document(const ImportedTerrain& made);

}  // namespace slipway::api
