#include "dem/gdal_soil_raster.h"

#include <fmt/format.h>
#include <ogr_spatialref.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>

#include "dem/gdal_body_degrees.h"
#include "dem/gdal_crs.h"
#include "dem/gdal_raster.h"
#include "dem/soil_legend.h"
#include "dem/soil_map.h"

namespace slipway::dem {
namespace {

bool is_integer(GDALDataType type) {
  return type == GDT_Byte || type == GDT_Int16 || type == GDT_UInt16 || type == GDT_Int32 ||
         type == GDT_UInt32;
}

// Whether coordinates in one CRS are coordinates in the other, over this extent, to a hundredth of a cell.
// Files name the same system in many ways, so that names decide nothing.
bool same_place(const OGRSpatialReference& crs, const ElevationInfo& ground, const Extent& extent,
                double cell_m) {
  OGRSpatialReference map;
  if (map.importFromWkt(ground.crs_wkt.c_str()) != OGRERR_NONE) return false;
  if (std::abs(crs.GetSemiMajor() - map.GetSemiMajor()) > 0.01) return false;
  OGRSpatialReference from(crs);
  from.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  map.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  const std::unique_ptr<OGRCoordinateTransformation> transformation(
      OGRCreateCoordinateTransformation(&from, &map));
  if (!transformation) return false;
  std::array<double, 4> x{extent.west_m, extent.east_m, extent.west_m, extent.east_m};
  std::array<double, 4> y{extent.north_m, extent.north_m, extent.south_m, extent.south_m};
  const std::array<double, 4> x_before = x;
  const std::array<double, 4> y_before = y;
  if (transformation->Transform(4, x.data(), y.data()) == FALSE) return false;
  const std::optional<double> turn = turn_of(map);
  for (std::size_t i = 0; i < 4; ++i) {
    const double off = turn ? std::remainder(x[i] - x_before[i], *turn) : x[i] - x_before[i];
    if (!(std::hypot(off, y[i] - y_before[i]) < 0.01 * cell_m)) return false;
  }
  return true;
}

// The geometry in the x of the elevation's map, where the raster's is whole turns of longitude from it.
GridGeometry on_sheet_of(const ElevationInfo& ground, GridGeometry geometry) {
  OGRSpatialReference map;
  if (ground.crs_wkt.empty() || map.importFromWkt(ground.crs_wkt.c_str()) != OGRERR_NONE) return geometry;
  const Extent own = geometry.extent(), wanted = ground.geometry.extent();
  const double apart = 0.5 * (wanted.west_m + wanted.east_m - own.west_m - own.east_m);
  if (const auto turn = turn_of(map)) geometry.west_m += std::round(apart / *turn) * *turn;
  return geometry;
}

// The classes of the window, and which cells have one.
struct Classes {
  std::vector<std::int16_t> values;
  std::vector<std::uint8_t> known;
  std::optional<std::int32_t> beyond;  // a class that is no 16-bit number
};

// As so many rows of so many cells, which are those of the window or fewer: then GDAL takes one cell in each.
// By stripes, so that a large window costs its three bytes a cell. Nothing where the file is damaged.
std::optional<Classes> read_classes(GDALRasterBand& band, const CellWindow& window, int all_rows,
                                    int in_row) {
  const auto columns = static_cast<std::size_t>(in_row);
  const std::size_t cells = static_cast<std::size_t>(all_rows) * columns;
  Classes classes{std::vector<std::int16_t>(cells), std::vector<std::uint8_t>(cells, 1), std::nullopt};
  const bool has_mask = (band.GetMaskFlags() & GMF_PER_DATASET) != 0;
  int has_nodata = 0;
  const double nodata = band.GetNoDataValue(&has_nodata);
  const bool thinned = all_rows < window.rows || in_row < window.columns;
  const int stripe = thinned ? all_rows : std::clamp(4'000'000 / in_row, 1, all_rows);
  std::vector<std::int32_t> values;
  for (int row = 0; row < all_rows; row += stripe) {
    const int rows = std::min(stripe, all_rows - row);
    const int of_file = thinned ? window.rows : rows;
    const std::size_t first = static_cast<std::size_t>(row) * columns;
    values.resize(static_cast<std::size_t>(rows) * columns);
    const auto read = [&](GDALRasterBand& from, void* to, GDALDataType type) {
      return from.RasterIO(GF_Read, window.column, window.row + row, window.columns, of_file, to, in_row,
                           rows, type, 0, 0, nullptr) == CE_None;
    };
    if (!read(band, values.data(), GDT_Int32) ||
        (has_mask && !read(*band.GetMaskBand(), classes.known.data() + first, GDT_Byte)))
      return std::nullopt;
    for (std::size_t i = 0; i < values.size(); ++i) {
      std::uint8_t& known = classes.known[first + i];
      if (has_nodata != 0 && values[i] == nodata) known = 0;
      if (known == 0) continue;
      classes.values[first + i] = static_cast<std::int16_t>(values[i]);
      if (classes.values[first + i] != values[i] && !classes.beyond) classes.beyond = values[i];
    }
  }
  return classes;
}

}  // namespace

bool holds_classes(GDALRasterBand& band) {
  return is_integer(band.GetRasterDataType());
}

Result<void> check_class_raster(const CheckedRaster& raster, const ElevationInfo& ground,
                                const std::string& file) {
  GDALRasterBand& band = *raster.dataset->GetRasterBand(raster.band);
  if (!is_integer(band.GetRasterDataType())) {
    return fail(
        ErrorCode::kUnreadableRaster,
        fmt::format(
            "{} holds {} values, must hold whole numbers (classes). Convert it with: gdal_translate -ot "
            "Int16 {} {}",
            file, raster.info.data_type, shell_word(file), shell_word(converted_name(file))));
  }
  const GridGeometry& geometry = raster.info.geometry;
  if (ground.crs_wkt.empty()) {
    if (raster.info.crs_wkt.empty()) return {};
    return fail(
        ErrorCode::kUnsupportedCrs,
        fmt::format("{} is in \"{}\", the elevation in a local frame; both must be in the same system.", file,
                    raster.info.crs_name));
  }
  if (!same_place(*raster.system, ground, geometry.extent(),
                  std::min(geometry.cell_x_m, geometry.cell_y_m))) {
    return fail(
        ErrorCode::kUnsupportedCrs,
        fmt::format(
            "{} is in \"{}\", the elevation in \"{}\"; both must be in the same system. Convert it with: "
            "gdalwarp -t_srs {} -r near {} {}",
            file, raster.info.crs_name, ground.crs_name, shell_word(ground.crs_wkt), shell_word(file),
            shell_word(converted_name(file))));
  }
  return {};
}

Result<std::shared_ptr<const SoilMap>> read_soil_raster(const std::filesystem::path& path,
                                                        const ElevationInfo& ground, const Extent& extent,
                                                        std::vector<SoilClass> legend, int step) {
  const std::string file = path.filename().string();
  std::vector<Fault> repeats = repeated_values(legend);
  if (!repeats.empty())
    return fail(ErrorCode::kUnreadableData, "The soil legend repeats itself.", std::move(repeats));
  const GdalSession session(path);
  const Result<CheckedRaster> raster = open_checked_raster(
      path, session, ground.crs_wkt.empty() ? PlacelessRaster::kLocalFrame : PlacelessRaster::kRefused);
  if (!raster) return fail(raster.error());
  const Result<void> usable = check_class_raster(*raster, ground, file);
  if (!usable) return fail(usable.error());
  const GridGeometry geometry = on_sheet_of(ground, raster->info.geometry);
  const std::optional<CellWindow> window = geometry.window(extent);
  if (!window) return fail(ErrorCode::kOffMap, fmt::format("{} does not meet the extent asked for.", file));
  GridGeometry grid = geometry.sub(*window);
  // Its cells may be larger than the elevation's, or smaller.
  const auto thinned = [&](int cells, double ratio) {
    const int every = step == 1 ? 1 : std::max(1, static_cast<int>(step * ratio));
    return (cells + every - 1) / every;
  };
  grid.rows = thinned(window->rows, ground.geometry.cell_y_m / grid.cell_y_m);
  grid.columns = thinned(window->columns, ground.geometry.cell_x_m / grid.cell_x_m);
  grid.cell_x_m *= static_cast<double>(window->columns) / grid.columns;
  grid.cell_y_m *= static_cast<double>(window->rows) / grid.rows;
  std::optional<Classes> read =
      read_classes(*raster->dataset->GetRasterBand(raster->band), *window, grid.rows, grid.columns);
  if (!read) {
    return fail(ErrorCode::kUnreadableRaster, fmt::format("{} is damaged: {} could not be read ({}).", file,
                                                          describe(*window), session.complaints()));
  }
  if (read->beyond)
    return fail(ErrorCode::kUnreadableRaster,
                fmt::format("{} holds class = {}, must be in [-32768, 32767].", file, *read->beyond));
  return std::make_shared<const SoilMap>(grid, std::move(read->values), std::move(read->known),
                                         std::move(legend));
}

}  // namespace slipway::dem
