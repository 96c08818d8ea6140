#include "api/files/terrain_import_documents.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "api/files/relief_values.h"
#include "api/json/faults.h"
#include "api/json/writer.h"
#include "core/csv_cells.h"

namespace slipway::api {
namespace {

constexpr std::string_view kNotStated = "not stated";

std::string_view stated(const std::string& text) {
  return text.empty() ? kNotStated : std::string_view(text);
}

// One row of the legend; what is wrong with it goes to the faults.
class LegendRow {
 public:
  LegendRow(const CsvLine& line, const CsvHeader& header, std::string_view file, std::vector<Fault>& faults)
      : cells_(csv_cells(line.text)),
        header_(header),
        place_(fmt::format("{}, line {}", file, line.number)),
        faults_(faults) {}

  bool has_all_cells() {
    if (cells_.size() == header_.width) return true;
    fault(fmt::format("{} cells, must be {} as in the header", cells_.size(), header_.width));
    return false;
  }
  std::string text(std::size_t column) const {
    const auto& place = header_.places[column];
    return place ? std::string(cells_[*place]) : std::string();
  }
  std::optional<double> number(std::size_t column, double least, double most, std::string_view name) {
    const std::string cell = text(column);
    if (cell.empty()) return std::nullopt;
    const auto value = csv_number(cell);
    if (value && *value >= least && *value <= most) return value;
    fault(fmt::format("{} = {}, must be a number in [{}, {}]", name, in_quotes(cell), least, most));
    return std::nullopt;
  }
  void fault(std::string message) { faults_.push_back({place_, std::move(message)}); }

 private:
  std::vector<std::string_view> cells_;
  const CsvHeader& header_;
  std::string place_;
  std::vector<Fault>& faults_;
};

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

std::vector<std::string> all_changes(const ImportedTerrain& made) {
  std::vector<std::string> changes = made.elevation.changes;
  if (made.soil) changes.insert(changes.end(), made.soil->changes.begin(), made.soil->changes.end());
  return changes;
}

}  // namespace

Result<std::vector<dem::SoilClass>> read_legend_csv(std::string_view text, std::string_view file,
                                                    bool polygons) {
  std::vector<Fault> faults;
  std::vector<dem::SoilClass> legend;
  const std::vector<CsvLine> lines = csv_lines(text);
  if (lines.empty())
    return fail(ErrorCode::kUnreadableData, fmt::format("{} is empty", file),
                {{std::string(file), "is empty"}});
  const CsvHeader header =
      read_csv_header(lines.front(), file, {"value", "label", "soil", "rock_share"}, faults);
  if (!header.places.empty()) {
    if (!polygons && !header.places[0])
      faults.push_back({std::string(file), "the column value is missing: the raster's number of the class"});
    if (!header.places[1]) faults.push_back({std::string(file), "the column label is missing"});
    if (!header.places[2]) faults.push_back({std::string(file), "the column soil is missing"});
  }
  if (!faults.empty()) return fail(ErrorCode::kUnreadableData, summary_of(faults), faults);
  for (std::size_t i = 1; i < lines.size(); ++i) {
    LegendRow row(lines[i], header, file, faults);
    if (!row.has_all_cells()) continue;
    dem::SoilClass& entry = legend.emplace_back();
    const auto value =
        polygons ? std::optional(static_cast<double>(i - 1)) : row.number(0, -32768, 32767, "value");
    if (value && *value != std::floor(*value)) row.fault("value must be a whole number");
    if (!polygons && row.text(0).empty()) row.fault("value is empty");
    entry.value = static_cast<int>(value.value_or(0.0));
    entry.label = row.text(1);
    if (entry.label.empty()) row.fault("label is empty");
    if (const std::string soil = row.text(2); !soil.empty()) entry.soil = soil;
    entry.rock_share = row.number(3, json::kRockShareRule.lowest, json::kRockShareRule.highest, "rock_share");
  }
  if (!faults.empty()) return fail(ErrorCode::kUnreadableData, summary_of(faults), faults);
  return legend;
}

std::string terrain_document(const TerrainImport& order, const ImportedTerrain& made) {
  json::Writer w;
  w.begin_object().text("format", "terrain/1").text("name", made.name).text("title", made.title);
  w.text("elevation", "elevation.tif").exact("gravity_m_s2", made.gravity_m_s2);
  if (made.soil) {
    const bool polygons = made.soil->source_format == "GeoJSON";
    w.key("soil").begin_object().text(polygons ? "polygons" : "raster", made.soil_file);
    if (polygons) {
      w.text("property", order.property);
      w.text("coordinates",
             order.coordinates == dem::PolygonCoordinates::kMap ? "map" : "longitude_latitude");
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
      fmt::format("- Heights: {:.3f} to {:.3f} m; {:.2f} % of the cells have none\n\n",
                  made.elevation.lowest_m, made.elevation.highest_m, 100.0 * made.elevation.unknown_share);
  text += "| source | format | SHA-256 of the source | became |\n|---|---|---|---|\n";
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
  for (const std::string& change : all_changes(made)) text += "  changed: " + change + "\n";
  if (made.soil && !made.soil->unlisted.empty())
    text += fmt::format("  classes that the legend does not have, unknown ground: {}\n",
                        fmt::join(made.soil->unlisted, ", "));
  if (!made.soil) text += "  no soil map: all of it is unknown ground\n";
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
  w.texts("changes", all_changes(made));
  w.texts("unlisted_classes", made.soil ? made.soil->unlisted : std::vector<std::string>{});
  w.end_object();
  return w.take() + "\n";
}

}  // namespace slipway::api
