#include "api/files/terrain_file.h"

#include <algorithm>

#include "api/files/relief_values.h"
#include "api/json/faults.h"
#include "api/json/parse.h"
#include "api/json/strict_reader.h"

namespace slipway::api::json {
namespace {

constexpr std::size_t kMaxClasses = 1000;

// A plain name: it can't leave its folder and names no driver, handler or hidden file.
void read_file_name(ObjectReader& reader, std::string_view key, Presence presence, std::string& out) {
  std::string name;
  if (!reader.text(key, presence, {.most = 100}, name)) return;
  const bool plain =
      name.front() != '.' && name.front() != '-' && std::all_of(name.begin(), name.end(), [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
               c == '-' || c == '.';
      });
  if (plain) {
    out = name;
  } else {
    reader.fault(
        key, std::string(key) + " = " + in_quotes(name) + ", must be a plain file name beside terrain.json");
  }
}

void read_legend(ObjectReader& soil, SoilSource source, Legend& legend) {
  int row = 0;
  for (const Element& element : soil.list("legend", kRequired, {0, kMaxClasses})) {
    ObjectReader reader(*element.value, element.pointer, soil.faults());
    dem::SoilClass& entry = legend.classes.emplace_back();
    entry.value = row++;
    if (source == SoilSource::kRaster) reader.whole("value", kRequired, -32768, 32767, entry.value);
    reader.text("label", kRequired, {}, entry.label);
    const JsonValue* const name = reader.member("soil", kRequired);
    if (name != nullptr && !name->is(JsonValue::Kind::kNull)) {
      std::string text;
      if (read_text(*name, child_pointer(element.pointer, "soil"), "soil", {.most = 64, .is_name = true},
                    text, soil.faults())) {
        entry.soil = text;
      }
    }
    reader.number("rock_share", kOptional, kRockShareRule, entry.rock_share);
    reader.refuse_unknown();
  }
  soil.text("assumption", kRequired, {.most = 2000}, legend.assumption);
  soil.number("confidence", kOptional, {"1", 0.0, 1.0, true}, legend.confidence);
}

void read_other_legends(ObjectReader& soil, TerrainDescription& terrain) {
  for (const Element& element : soil.list("other_legends", kOptional, {0, 20})) {
    ObjectReader reader(*element.value, element.pointer, soil.faults());
    Legend other;
    reader.text("name", kRequired, {.most = 64, .is_name = true}, other.name);
    if (terrain.legend(other.name) != nullptr) reader.fault("name", "another legend has this name");
    read_legend(reader, terrain.soil_source, other);
    reader.refuse_unknown();
    terrain.legends.push_back(std::move(other));
  }
}

void read_soil(ObjectReader& soil, TerrainDescription& terrain) {
  read_file_name(soil, "raster", kOptional, terrain.soil_file);
  if (!terrain.soil_file.empty()) terrain.soil_source = SoilSource::kRaster;
  std::string polygons;
  read_file_name(soil, "polygons", kOptional, polygons);
  if (!polygons.empty()) {
    if (terrain.soil_source == SoilSource::kRaster)
      soil.fault("polygons", "polygons and raster exclude each other");
    terrain.soil_source = SoilSource::kPolygons;
    terrain.soil_file = polygons;
    soil.text("property", kRequired, {.most = 64}, terrain.soil_property);
    std::size_t choice = 0;
    soil.choice("coordinates", kRequired, {"longitude_latitude", "map"}, choice);
    terrain.soil_coordinates =
        choice == 0 ? dem::PolygonCoordinates::kLongitudeLatitude : dem::PolygonCoordinates::kMap;
  }
  if (terrain.soil_source == SoilSource::kNone)
    soil.fault("raster", "raster or polygons must say where the classes are");
  Legend& first = terrain.legends.front();
  soil.text("legend_name", kOptional, {.most = 64, .is_name = true}, first.name);
  read_legend(soil, terrain.soil_source, first);
  read_other_legends(soil, terrain);
  soil.refuse_unknown();
}

}  // namespace

Result<TerrainDescription> read_terrain_file(std::string_view bytes) {
  const auto document = parse(bytes);
  if (!document) return fail(document.error());
  TerrainDescription terrain;
  std::vector<Fault> faults;
  ObjectReader reader(*document, "", faults);
  std::size_t format = 0;
  reader.choice("format", kRequired, {"terrain/1"}, format);
  reader.text("name", kRequired, {.most = 64, .is_name = true}, terrain.name);
  reader.text("title", kRequired, {}, terrain.title);
  read_file_name(reader, "elevation", kRequired, terrain.elevation_file);
  reader.number("gravity_m_s2", kRequired, {"m/s^2", 0.0, 30.0, true}, terrain.gravity_m_s2);
  if (auto soil = reader.object("soil", kOptional)) read_soil(*soil, terrain);
  std::optional<ReliefValues> relief;
  read_relief(reader, relief);
  terrain.relief = relief.value_or(ReliefValues{});
  std::string file;
  read_file_name(reader, "stops", kOptional, file);
  if (!file.empty()) terrain.stops_file = file;
  file.clear();
  read_file_name(reader, "drive_outcomes", kOptional, file);
  if (!file.empty()) terrain.outcomes_file = file;
  file.clear();
  read_file_name(reader, "measured_slip", kOptional, file);
  if (!file.empty()) terrain.steps_file = file;
  file.clear();
  read_file_name(reader, "provenance", kOptional, file);
  if (!file.empty()) terrain.provenance_file = file;
  reader.refuse_unknown();
  if (!faults.empty()) return fail(ErrorCode::kUnreadableData, summary_of(faults), faults);
  return terrain;
}

}  // namespace slipway::api::json
