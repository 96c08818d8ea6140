#include <fmt/format.h>
#include <ogr_spatialref.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <set>
#include <utility>

#include "dem/gdal_crs.h"
#include "dem/gdal_heights.h"
#include "dem/gdal_import.h"
#include "dem/gdal_soil_raster.h"
#include "dem/gdal_soil_units.h"
#include "dem/terrain_import.h"

namespace slipway::dem {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxNamed = 200;  // classes or labels that a message lists

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

tl::unexpected<Error> no_legend(const std::vector<std::string>& found) {
  return fail(ErrorCode::kInvalidRequest, "The soil map has no legend.",
              {{"--legend", "name the soil of each class in a file \"value,label,soil\"; the map holds " +
                                joined(found)}});
}

// The band of classes beside one of opacity.
GDALRasterBand& class_band(GDALDataset& dataset) {
  return *dataset.GetRasterBand(alpha_band(dataset) == 1 ? 2 : 1);
}

// The classes of a raster, each once; those of cells that a mask or an opacity of 0 hides are none.
Result<std::set<int>> classes_of(const fs::path& path, const GdalSession& session) {
  const auto raster = open_raster(path, session);
  if (!raster) return fail(raster.error());
  GDALRasterBand& band = class_band(**raster);
  const bool has_mask = (band.GetMaskFlags() & GMF_PER_DATASET) != 0;
  int has_nodata = 0;
  const double nodata = band.GetNoDataValue(&has_nodata);
  std::set<int> found;
  std::vector<int> row(static_cast<std::size_t>(band.GetXSize()));
  std::vector<std::uint8_t> known(row.size(), 1);
  for (int r = 0; r < band.GetYSize(); ++r) {
    const auto read = [&](GDALRasterBand& from, void* to, GDALDataType type) {
      return from.RasterIO(GF_Read, 0, r, band.GetXSize(), 1, to, band.GetXSize(), 1, type, 0, 0, nullptr) ==
             CE_None;
    };
    if (!read(band, row.data(), GDT_Int32) ||
        (has_mask && !read(*band.GetMaskBand(), known.data(), GDT_Byte)))
      return fail(ErrorCode::kUnreadableRaster,
                  fmt::format("{} is damaged: row {} could not be read ({}).", path.filename().string(), r,
                              session.complaints()));
    for (std::size_t i = 0; i < row.size(); ++i) {
      const int value = row[i];
      if (known[i] == 0 || (has_nodata != 0 && value == nodata)) continue;
      found.insert(value);
      if (found.size() > 32'768)
        return fail(ErrorCode::kUnreadableRaster,
                    fmt::format("{} has more than 32768 different values: it is no map of classes.",
                                path.filename().string()));
    }
  }
  return found;
}

// Onto the elevation's own grid, each cell taking the nearest class.
Result<void> warp_classes(GDALDataset& source, const std::set<int>& found, const ElevationInfo& ground,
                          const fs::path& out, const GdalSession& session, Progress& progress) {
  const Extent extent = ground.geometry.extent();
  const auto number = [](double value) { return fmt::format("{}", value); };
  std::vector<std::string> options{"-of",
                                   "GTiff",
                                   "-r",
                                   "near",
                                   "-t_srs",
                                   ground.crs_wkt,
                                   "-te",
                                   number(extent.west_m),
                                   number(extent.south_m),
                                   number(extent.east_m),
                                   number(extent.north_m),
                                   "-tr",
                                   number(ground.geometry.cell_x_m),
                                   number(ground.geometry.cell_y_m)};
  int has_nodata = 0;
  class_band(source).GetNoDataValue(&has_nodata);
  // Ground beside the map has no class, which needs a value that is none.
  if (has_nodata == 0) {
    const bool byte = class_band(source).GetRasterDataType() == GDT_Byte && found.count(255) == 0;
    options.insert(options.end(), {"-dstnodata", byte ? "255" : "-32768", "-ot", byte ? "Byte" : "Int16"});
  }
  for (const std::string& option : tiled_creation(false)) {
    options.emplace_back("-co");
    options.push_back(option);
  }
  return warp_raster(source, out, options, session, progress, "reprojecting classes");
}

Result<void> copy_classes(GDALDataset& source, const fs::path& out, const GdalSession& session) {
  CPLStringList creation;
  for (const std::string& option : tiled_creation(false)) creation.AddString(option.c_str());
  CPLErrorReset();
  GDALDatasetUniquePtr made(GetGDALDriverManager()->GetDriverByName("GTiff")->CreateCopy(
      out.c_str(), &source, FALSE, creation.List(), nullptr, nullptr));
  const bool complete = made != nullptr;
  made.reset();
  if (!complete || CPLGetLastErrorType() >= CE_Failure)
    return fail(ErrorCode::kUnwritableFile, "The soil map could not be written: " + session.complaints());
  return {};
}

// What keeps a class raster from being used as it is.
std::vector<RasterFault> class_faults(GDALDataset& dataset, const fs::path& path, const ElevationInfo& ground,
                                      const GdalSession& session) {
  const std::string file = path.filename().string();
  std::vector<RasterFault> faults =
      faults_of(dataset, dataset.GetSpatialRef(), file, PlacelessRaster::kRefused);
  if (dataset.GetSpatialRef() != nullptr && is_west_positive(*dataset.GetSpatialRef()))
    for (RasterFault& fault : faults) fault.mendable = false;
  // Which of several bands holds the classes nobody can guess.
  if (dataset.GetRasterCount() - (alpha_band(dataset) != 0 ? 1 : 0) != 1)
    for (RasterFault& fault : faults) fault.mendable = false;
  if (!faults.empty()) return faults;
  const auto raster = open_checked_raster(path, session, PlacelessRaster::kRefused);
  const auto usable = raster ? check_class_raster(*raster, ground, file) : Result<void>(fail(raster.error()));
  if (!usable)
    faults.push_back(
        {usable.error().code, usable.error().detail, usable.error().code == ErrorCode::kUnsupportedCrs});
  return faults;
}

Result<ImportedSoil> write_classes(const SoilImport& order, const ElevationInfo& ground, const fs::path& out,
                                   Progress& progress) {
  const GdalSession session(order.source);
  const WritingAdmission writing(out.parent_path());
  const auto dataset = open_raster(order.source, session);
  if (!dataset) return fail(dataset.error());
  const auto faults = class_faults(**dataset, order.source, ground, session);
  for (const RasterFault& fault : faults)
    if (!(order.fix && fault.mendable)) return fail(import_error(faults, "soil"));
  if (!holds_classes(class_band(**dataset)))
    return fail(ErrorCode::kUnreadableRaster,
                fmt::format("{} holds no whole numbers.", order.source.filename().string()));
  const auto found = classes_of(order.source, session);
  if (!found) return fail(found.error());
  if (!found->empty() && (*found->begin() < -32768 || *found->rbegin() > 32767))
    return fail(ErrorCode::kUnreadableRaster,
                fmt::format("{} holds classes from {} to {}, must be in [-32768, 32767].",
                            order.source.filename().string(), *found->begin(), *found->rbegin()));
  ImportedSoil imported{(*dataset)->GetDriverName(), {}, {}};
  std::vector<std::string> names;
  for (const int value : *found) {
    if (names.size() < kMaxNamed) names.push_back(fmt::format("{}", value));
    const bool listed = std::any_of(order.legend.begin(), order.legend.end(),
                                    [&](const SoilClass& row) { return row.value == value; });
    if (!listed) imported.unlisted.push_back(fmt::format("{}", value));
  }
  if (order.legend.empty()) return no_legend(names);
  if (!faults.empty())
    imported.changes.push_back("classes were brought onto the elevation's grid (nearest cell)");
  const auto written = faults.empty() ? copy_classes(**dataset, out, session)
                                      : warp_classes(**dataset, *found, ground, out, session, progress);
  if (!written) return fail(written.error());
  if (const auto done = add_overviews(out, "MODE", session, progress); !done) return fail(done.error());
  return imported;
}

// Writes the classes, and reads back what was written: how much of the map they cover.
Result<ImportedSoil> import_classes(const SoilImport& order, const ElevationInfo& ground, const fs::path& out,
                                    Progress& progress) {
  auto imported = write_classes(order, ground, out, progress);
  if (!imported) return imported;
  const double cells = static_cast<double>(ground.geometry.rows) * ground.geometry.columns;
  const int step = std::max(1, static_cast<int>(std::ceil(std::sqrt(cells / kMaxWindowCells))));
  const auto map = read_soil_raster(out, ground, ground.geometry.extent(), order.legend, step);
  if (!map) return fail(map.error());
  const SoilCover cover = cover_of(**map, ground.geometry.extent(), "class");
  imported->warnings = cover.warnings;
  imported->cover = cover.lines;
  return imported;
}

Error at_soil(Error error) {
  for (Fault& fault : error.faults) fault.pointer = "soil#" + fault.pointer;
  return error;
}

Result<ImportedSoil> import_polygons(const SoilImport& order, const ElevationInfo& ground,
                                     const fs::path& out) {
  auto units = import_soil_units(order.source, order.property, order.coordinates, order.legend, ground, out);
  if (!units) return fail(at_soil(std::move(units.error())));
  if (order.legend.empty()) return no_legend(units->labels);
  ImportedSoil imported{units->format, {}, {}};
  for (const std::string& label : units->labels)
    if (std::none_of(order.legend.begin(), order.legend.end(),
                     [&](const SoilClass& row) { return row.label == label; }))
      imported.unlisted.push_back(label);
  imported.on_trust = units->notes;
  imported.warnings = units->cover.warnings;
  imported.cover = units->cover.lines;
  imported.coordinates = units->in_map_metres ? PolygonCoordinates::kMap : order.coordinates;
  return imported;
}

}  // namespace

Result<void> examine_soil(const SoilImport& order) {
  const GdalSession session(order.source);
  if (order.polygons) {
    auto units = read_soil_units(order.source, order.property, order.coordinates, session);
    if (!units) return fail(at_soil(std::move(units.error())));
    return {};
  }
  const auto dataset = open_raster(order.source, session);
  if (!dataset) return fail(dataset.error());
  const auto faults = faults_of(**dataset, (*dataset)->GetSpatialRef(), order.source.filename().string(),
                                PlacelessRaster::kRefused);
  for (const RasterFault& fault : faults)
    if (!(order.fix && fault.mendable)) return fail(import_error(faults, "soil"));
  return {};
}

Result<ImportedSoil> import_soil(const SoilImport& order, const ElevationInfo& ground, const fs::path& out,
                                 Progress& progress) {
  return order.polygons ? import_polygons(order, ground, out) : import_classes(order, ground, out, progress);
}

}  // namespace slipway::dem
