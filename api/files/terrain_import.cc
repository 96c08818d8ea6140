#include "api/files/terrain_import.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <system_error>
#include <utility>
#include <vector>

#include "api/files/legend_csv.h"
#include "api/files/terrain_file.h"
#include "api/files/terrain_import_documents.h"
#include "api/files/terrain_site.h"
#include "api/files/whole_file.h"
#include "api/json/faults.h"
#include "dem/crs/crs_text.h"

namespace slipway::api {
namespace {

namespace fs = std::filesystem;

std::string name_of_file(const fs::path& path) {
  std::string name;
  for (const char c : path.stem().string()) {
    const auto u = static_cast<unsigned char>(c);
    const bool plain = std::isalnum(u) != 0 && u < 128;
    name += plain ? static_cast<char>(std::tolower(u)) : '_';
  }
  return name.substr(0, 64);
}

bool is_name(const std::string& name) {
  return !name.empty() && name.size() <= 64 && std::all_of(name.begin(), name.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  });
}

std::optional<double> gravity_of(const std::string& body) {
  if (body == "Mars") return 3.71;
  if (body == "Moon") return 1.62;
  if (body == "Earth") return 9.81;
  return std::nullopt;
}

void check_legend_soils(const std::vector<dem::SoilClass>& legend, const Catalogue& catalogue,
                        const std::string& file, std::vector<Fault>& faults) {
  for (const dem::SoilClass& row : legend)
    if (row.soil && !catalogue.soils.contains(*row.soil))
      faults.push_back({fmt::format("{}, label {}", file, row.label), unknown_soil(catalogue, *row.soil)});
}

bool may_replace(const TerrainImport& order, const fs::path& there) {
  return order.may_replace && order.may_replace(there);
}

// What is wrong with the order before a map is opened, and its legend.
Result<LegendTable> check_order(const TerrainImport& order, const std::string& name,
                                const Catalogue& catalogue) {
  std::vector<Fault> faults;
  LegendTable legend;
  std::error_code ignored;
  if (!is_name(name))
    faults.push_back(
        {"--name", fmt::format("name = {}, must be 1 to 64 of a-z, 0-9, _ and -", in_quotes(name))});
  else if (const fs::path there = order.data / "terrains" / name;
           fs::exists(there, ignored) && !may_replace(order, there))
    faults.push_back(
        {"--name",
         fmt::format("there is a terrain {} already: give another --name, or --replace", in_quotes(name))});
  if (order.gravity_m_s2 && !(*order.gravity_m_s2 > 0.0 && *order.gravity_m_s2 <= 30.0))
    faults.push_back(
        {"--gravity", fmt::format("gravity = {} m/s^2, must be in (0, 30]", *order.gravity_m_s2)});
  if (const auto fault = order.crs.empty() ? std::nullopt : dem::fault_of_crs_text(order.crs))
    faults.push_back({"--crs", *fault});
  if (order.legend && !order.soil) faults.push_back({"--legend", "needs --soil"});
  if (order.legend && order.soil) {
    const auto text = read_data_file(*order.legend);
    const std::string file = order.legend->filename().string();
    auto read = text ? read_legend_table(*text, file, dem::is_unit_file(*order.soil))
                     : Result<LegendTable>(fail(text.error()));
    if (!read && read.error().faults.empty()) faults.push_back({"--legend", read.error().detail});
    if (!read) faults.insert(faults.end(), read.error().faults.begin(), read.error().faults.end());
    if (read) legend = *std::move(read);
    check_legend_soils(legend.classes, catalogue, file, faults);
  }
  if (!faults.empty()) return fail(ErrorCode::kInvalidRequest, summary_of(faults), faults);
  return legend;
}

// Joins the faults of both maps: one attempt tells all.
Error joined(Error error, const Error& other) {
  error.detail += "; " + other.detail;
  if (other.faults.empty()) error.faults.push_back({"soil", other.detail});
  error.faults.insert(error.faults.end(), other.faults.begin(), other.faults.end());
  return error;
}

dem::SoilImport soil_order(const TerrainImport& order, const std::vector<dem::SoilClass>& legend) {
  return {.source = *order.soil,
          .polygons = dem::is_unit_file(*order.soil),
          .property = order.property,
          .coordinates = order.coordinates,
          .legend = legend,
          .fix = order.fix};
}

// What an order that is strict does not take.
Error refused_warnings(const char* place, const std::vector<std::string>& warnings) {
  Error error{
      ErrorCode::kUnreadableRaster, "this map would be imported with a warning, and --strict was given", {}};
  for (const std::string& warning : warnings) error.faults.push_back({place, warning});
  return error;
}

Result<void> import_soil(const TerrainImport& order, const fs::path& folder, ImportedTerrain& made,
                         Progress& progress) {
  made.soil_file = dem::is_unit_file(*order.soil) ? "soil_units.geojson" : "terrain_class.tif";
  auto soil = dem::import_soil(soil_order(order, made.legend), made.elevation.info, folder / made.soil_file,
                               progress);
  if (!soil) return fail(soil.error());
  const auto hash = sha256_of_file(*order.soil);
  if (!hash) return fail(hash.error());
  if (order.strict && !soil->warnings.empty()) return fail(refused_warnings("soil", soil->warnings));
  made.soil = *std::move(soil);
  made.soil_source = {order.soil->filename().string(), *hash, made.soil->source_format};
  return {};
}

Result<void> import_maps(const TerrainImport& order, const fs::path& folder, ImportedTerrain& made,
                         Progress& progress) {
  auto elevation = dem::import_elevation({.source = order.elevation,
                                          .crs = order.crs,
                                          .fix = order.fix,
                                          .band = order.band,
                                          .unit = order.unit,
                                          .nodata = order.nodata},
                                         folder / "elevation.tif", progress);
  if (!elevation) {
    if (!order.soil) return fail(elevation.error());
    const auto soil = dem::examine_soil(soil_order(order, made.legend));
    return fail(soil ? elevation.error() : joined(elevation.error(), soil.error()));
  }
  made.elevation = *std::move(elevation);
  if (order.strict && !made.elevation.warnings.empty())
    return fail(refused_warnings("elevation", made.elevation.warnings));
  const auto source = sha256_of_file(order.elevation), written = sha256_of_file(folder / "elevation.tif");
  if (!source) return fail(source.error());
  if (!written) return fail(written.error());
  made.elevation_source = {order.elevation.filename().string(), *source, made.elevation.source_format};
  made.elevation_sha256 = *written;
  if (order.soil) return import_soil(order, folder, made, progress);
  return {};
}

// With their digests.
Result<std::vector<TerrainFile>> written_maps(const ImportedTerrain& made, const fs::path& folder) {
  std::vector<TerrainFile> maps{{.name = "elevation.tif", .sha256 = made.elevation_sha256}};
  if (!made.soil) return maps;
  const auto soil = sha256_of_file(folder / made.soil_file);
  if (!soil) return fail(soil.error());
  maps.push_back({.name = made.soil_file, .sha256 = *soil});
  return maps;
}

// In the child: everything but the last rename. The answer is the text, a zero byte and the JSON.
Result<std::string> make_folder_of(const TerrainImport& order, ImportedTerrain made, const fs::path& folder,
                                   Progress& progress) {
  if (const auto imported = import_maps(order, folder, made, progress); !imported)
    return fail(imported.error());
  const auto gravity = order.gravity_m_s2 ? order.gravity_m_s2 : gravity_of(made.elevation.info.body);
  if (!gravity)
    return fail(ErrorCode::kInvalidRequest, "The body of this map is not known.",
                {{"--gravity", "must be given, m/s^2: the map's sphere is no body whose gravity is known"}});
  made.gravity_m_s2 = *gravity;
  made.title = order.title.empty() ? made.name : order.title;
  const std::string document = terrain_document(order, made);
  const auto maps = written_maps(made, folder);
  if (!maps) return fail(maps.error());
  if (const auto read = json::read_terrain_file(document); !read)
    return fail(ErrorCode::kInvalidRequest, read.error().detail, read.error().faults);
  for (const auto& [file, text] : {std::pair{std::string("terrain.json"), document},
                                   {"PROVENANCE.md", provenance_text(order, made)},
                                   {kDigestsFile, digests_document(*maps)}})
    if (const auto written = write_whole_file(folder / file, text); !written) return fail(written.error());
  if (!order.origin.empty())
    if (const auto written = write_whole_file(folder / "upload.json", order.origin); !written)
      return fail(written.error());
  return import_text(made) + '\0' + import_document(made);
}

// Puts the finished folder in its place; what was there is removed afterwards. Whether it may be is asked of
// what was put aside: another process may have changed it since the order was checked.
Result<void> put_in_place(const TerrainImport& order, const WorkingFolder& working, const fs::path& folder,
                          const fs::path& aside) {
  std::error_code error;
  const bool replaced = fs::exists(folder, error);
  if (replaced) fs::rename(folder, aside, error);
  if (!error && replaced && !may_replace(order, aside)) {
    fs::rename(aside, folder, error);
    return fail(ErrorCode::kConflict, "A terrain of this name was made meanwhile: choose another name.");
  }
  if (!error) fs::rename(working.path(), folder, error);
  if (error) {
    const std::string why = error.message();
    if (replaced) fs::rename(aside, folder, error);
    return fail(ErrorCode::kUnwritableFile, fmt::format("cannot make {}: {}", folder.string(), why));
  }
  fs::remove_all(aside, error);
  return {};
}

}  // namespace

Result<TerrainImportReport> import_terrain(const TerrainImport& order, const Catalogue& catalogue,
                                           Progress& progress) {
  ImportedTerrain made;
  made.name = order.name.empty() ? name_of_file(order.elevation) : order.name;
  auto legend = check_order(order, made.name, catalogue);
  if (!legend) return fail(legend.error());
  made.legend = std::move(legend->classes);
  made.legend_notes = std::move(legend->notes);
  const fs::path terrains = order.data / "terrains";
  if (const auto folder = make_folder(terrains); !folder) return fail(folder.error());
  remove_abandoned(terrains, made.name);
  const WorkingFolder working(terrains / made.name);
  if (const auto folder = make_folder(working.path()); !folder) return fail(folder.error());
  const auto told = run_confined(
      order.limits, [&](Progress& inner) { return make_folder_of(order, made, working.path(), inner); },
      progress);
  if (!told) return fail(told.error());
  if (progress.cancelled()) return fail(ErrorCode::kCancelled, "The import was given up.");
  TerrainImportReport report;
  report.folder = terrains / made.name;
  const fs::path aside = unfinished_name(terrains / made.name);
  if (const auto placed = put_in_place(order, working, report.folder, aside); !placed)
    return fail(placed.error());
  report.text = told->substr(0, told->find('\0'));
  report.json = told->substr(told->find('\0') + 1);
  return report;
}

}  // namespace slipway::api
