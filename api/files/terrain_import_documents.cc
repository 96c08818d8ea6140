#include "api/files/terrain_import_documents.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "api/json/writer.h"
#include "dem/body_degrees.h"

namespace slipway::api {
namespace {

constexpr std::string_view kNotStated = "not stated";

std::string_view stated(const std::string& text) {
  return text.empty() ? kNotStated : std::string_view(text);
}

void write_legend(json::Writer& w, const std::vector<dem::SoilClass>& legend, bool polygons) {
  w.key("legend").begin_array();
  for (const dem::SoilClass& row : legend) {
    w.begin_object();
    if (!polygons) w.whole("value", row.value);
    w.text("label", row.label).key("soil");
    row.soil ? w.text(*row.soil) : w.null();
    if (row.rock_share) w.exact("rock_share", *row.rock_share);
    w.end_object();
  }
  w.end_array();
}

std::string extent_text(const dem::GridGeometry& geometry) {
  const dem::Extent extent = geometry.extent();
  return fmt::format("west {} south {} east {} north {} m", extent.west_m, extent.south_m, extent.east_m,
                     extent.north_m);
}

std::string grid_text(const dem::GridGeometry& geometry) {
  return fmt::format("{} rows x {} columns of {:.6g} x {:.6g} m", geometry.rows, geometry.columns,
                     geometry.cell_x_m, geometry.cell_y_m);
}

std::string source_row(const SourceFile& source, const std::string& becomes) {
  return fmt::format("| `{}` | {} | `{}` | `{}` |\n", source.name, source.format, source.sha256, becomes);
}

// The corners from the north-west clockwise, in degrees of the body to a metre or better.
std::vector<std::pair<const char*, dem::MapPlace>> corners_of(const dem::ElevationInfo& info) {
  const dem::Extent at = info.geometry.extent();
  const dem::BodyDegrees degrees(info.crs_wkt, info.body);
  std::vector<std::pair<const char*, dem::MapPlace>> corners;
  for (const auto& [name, place] : {std::pair{"north-west", dem::MapPlace{at.west_m, at.north_m}},
                                    {"north-east", dem::MapPlace{at.east_m, at.north_m}},
                                    {"south-east", dem::MapPlace{at.east_m, at.south_m}},
                                    {"south-west", dem::MapPlace{at.west_m, at.south_m}}})
    if (const auto corner = degrees.to_degrees(place)) corners.emplace_back(name, *corner);
  return corners;
}

std::string corners_text(const dem::ElevationInfo& info) {
  std::string text;
  for (const auto& [name, place] : corners_of(info))
    text += fmt::format("{}{} {:.6f} {}, {:.6f} {}", text.empty() ? "" : "; ", name, std::abs(place.x),
                        place.x < 0.0 ? "W" : "E", std::abs(place.y), place.y < 0.0 ? "S" : "N");
  return text.empty() ? "not on a body" : text;
}

std::vector<std::string> all_changes(const ImportedTerrain& made) {
  std::vector<std::string> changes = made.elevation.changes;
  if (made.soil) changes.insert(changes.end(), made.soil->changes.begin(), made.soil->changes.end());
  return changes;
}

std::vector<std::string> all_on_trust(const ImportedTerrain& made) {
  std::vector<std::string> told = made.elevation.on_trust;
  for (const std::string& note : made.legend_notes) told.push_back("legend: " + note);
  if (made.soil)
    for (const std::string& note : made.soil->on_trust) told.push_back("soil map: " + note);
  return told;
}

std::vector<std::string> all_warnings(const ImportedTerrain& made) {
  std::vector<std::string> told = made.elevation.warnings;
  if (made.soil)
    for (const std::string& warning : made.soil->warnings) told.push_back("soil map: " + warning);
  return told;
}

}  // namespace

std::string terrain_document(const TerrainImport& order, const ImportedTerrain& made) {
  json::Writer w;
  w.begin_object().text("format", "terrain/1").text("name", made.name).text("title", made.title);
  w.text("elevation", "elevation.tif").exact("gravity_m_s2", made.gravity_m_s2);
  if (made.soil) {
    const bool polygons = made.soil_file.ends_with(".geojson");
    w.key("soil").begin_object().text(polygons ? "polygons" : "raster", made.soil_file);
    if (polygons) {
      w.text("property", order.property);
      w.text("coordinates",
             made.soil->coordinates == dem::PolygonCoordinates::kMap ? "map" : "longitude_latitude");
    }
    write_legend(w, made.legend, polygons);
    w.text("assumption", order.assumption.empty()
                             ? "The importer of the map has not stated why these classes are these soils."
                             : order.assumption);
    w.end_object();
  }
  w.text("provenance", "PROVENANCE.md").end_object();
  return w.take() + "\n";
}

std::string provenance_text(const TerrainImport& order, const ImportedTerrain& made) {
  const dem::ElevationInfo& info = made.elevation.info;
  std::string text = fmt::format("# {}\n\nImported by `slipway terrain import`.\n\n", made.title);
  text += fmt::format("- Source: {}\n- Licence: {}\n", stated(order.source), stated(order.licence));
  text += fmt::format("- Body: {} (semi-major axis {} m), gravity {} m/s^2\n", info.body,
                      info.semi_major_axis_m, made.gravity_m_s2);
  text += fmt::format("- System of the source: {}\n- System of the terrain: {}\n", made.elevation.source_crs,
                      info.crs_name);
  text += fmt::format("- Extent: {}\n- Grid: {}\n", extent_text(info.geometry), grid_text(info.geometry));
  text +=
      fmt::format("- Heights: {:.3f} to {:.3f} m; {:.2f} % of the cells have none\n", made.elevation.lowest_m,
                  made.elevation.highest_m, 100.0 * made.elevation.unknown_share);
  text += fmt::format("- Corners, deg: {}\n\n## What was read\n\n{}\n\n", corners_text(info),
                      made.elevation.reading);
  for (const std::string& taken : all_on_trust(made)) text += fmt::format("- On trust: {}\n", taken);
  for (const std::string& warning : all_warnings(made)) text += fmt::format("- Warning: {}\n", warning);
  text += "\n| source | format | SHA-256 of the source | became |\n|---|---|---|---|\n";
  text += source_row(made.elevation_source, "elevation.tif");
  if (made.soil) text += source_row(made.soil_source, made.soil_file);
  text += fmt::format("\nSHA-256 of `elevation.tif`: `{}`\n\n## What was changed\n\n", made.elevation_sha256);
  text += "Heights were written as Float32 metres in tiles, with overviews.\n";
  for (const std::string& change : all_changes(made)) text += fmt::format("- {}\n", change);
  text += fmt::format("\n## The terrain's system\n\n```text\n{}\n```\n", info.crs_wkt);
  return text;
}

std::string import_text(const ImportedTerrain& made) {
  const dem::ElevationInfo& info = made.elevation.info;
  std::string text =
      fmt::format("terrain {}: {}, {}\n  {}\n  heights {:.2f} to {:.2f} m, {:.2f} % unknown\n", made.name,
                  grid_text(info.geometry), info.body, extent_text(info.geometry), made.elevation.lowest_m,
                  made.elevation.highest_m, 100.0 * made.elevation.unknown_share);
  text += "  " + made.elevation.reading + "\n";
  for (const std::string& change : all_changes(made)) text += "  changed: " + change + "\n";
  for (const std::string& taken : all_on_trust(made)) text += "  on trust: " + taken + "\n";
  for (const std::string& warning : all_warnings(made)) text += "  warning: " + warning + "\n";
  if (made.soil)
    for (const std::string& line : made.soil->cover) text += "  " + line + "\n";
  if (made.soil && !made.soil->unlisted.empty())
    text += fmt::format("  classes that the legend does not have, unknown ground: {}\n",
                        fmt::join(made.soil->unlisted, ", "));
  if (!made.soil) text += "  no soil map: all of it is unknown ground\n";
  text += "  corners, deg: " + corners_text(info) + "\n";
  return text;
}

std::string import_document(const ImportedTerrain& made) {
  const dem::ElevationInfo& info = made.elevation.info;
  const dem::Extent extent = info.geometry.extent();
  json::Writer w;
  w.begin_object().text("format", "terrain-import/1").text("name", made.name).text("body", info.body);
  w.text("crs", info.crs_name).whole("rows", info.geometry.rows).whole("columns", info.geometry.columns);
  w.exact("cell_x_m", info.geometry.cell_x_m).exact("cell_y_m", info.geometry.cell_y_m);
  w.key("extent").begin_object().exact("west_m", extent.west_m).exact("south_m", extent.south_m);
  w.exact("east_m", extent.east_m).exact("north_m", extent.north_m).end_object();
  w.metres("lowest_m", made.elevation.lowest_m).metres("highest_m", made.elevation.highest_m);
  w.exact("unknown_share", made.elevation.unknown_share);
  w.text("source_sha256", made.elevation_source.sha256).text("elevation_sha256", made.elevation_sha256);
  w.text("reading", made.elevation.reading);
  w.texts("changes", all_changes(made));
  w.texts("on_trust", all_on_trust(made)).texts("warnings", all_warnings(made));
  w.key("corners").begin_array();
  for (const auto& [name, place] : corners_of(info))
    w.begin_object().exact("longitude_deg", place.x).exact("latitude_deg", place.y).end_object();
  w.end_array();
  w.texts("soil_cover", made.soil ? made.soil->cover : std::vector<std::string>{});
  w.texts("unlisted_classes", made.soil ? made.soil->unlisted : std::vector<std::string>{});
  w.end_object();
  return w.take() + "\n";
}

}  // namespace slipway::api
