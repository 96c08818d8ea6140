#include <cpl_string.h>
#include <fmt/format.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "core/angle.h"
#include "dem/gdal_session.h"
#include "dem/write/gdal_cog_copy.h"
#include "dem/write/horizon_map.h"

namespace slipway::dem {
namespace {

constexpr std::int16_t kNoData = -32768;
constexpr double kScale_deg = 0.01;
Result<void> fill(GDALDataset& dataset, const HorizonSweep& ground, const Eyes& eyes, int directions,
                  std::size_t threads, Progress& progress) {
  const GridGeometry& cells = eyes.cells;
  std::vector<float> tangents(eyes.heights_m.size());
  std::vector<std::int16_t> values(eyes.heights_m.size());
  for (int direction = 0; direction < directions; ++direction) {
    if (progress.cancelled()) return fail(ErrorCode::kCancelled, "the map was given up");
    progress.report("looking at horizons", 0.8 * direction / directions);
    std::fill(tangents.begin(), tangents.end(), -std::numeric_limits<float>::infinity());
    ground.raise(eyes, 2.0 * std::numbers::pi * direction / directions, threads, tangents);
    for (std::size_t cell = 0; cell < values.size(); ++cell)
      values[cell] = std::isnan(eyes.heights_m[cell])
                         ? kNoData
                         : static_cast<std::int16_t>(
                               std::lround(deg_from_rad(std::atan(double{tangents[cell]})) / kScale_deg));
    if (dataset.GetRasterBand(direction + 1)
            ->RasterIO(GF_Write, 0, 0, cells.columns, cells.rows, values.data(), cells.columns, cells.rows,
                       GDT_Int16, 0, 0, nullptr) != CE_None)
      return fail(ErrorCode::kUnwritableFile, "The map could not be written");
  }
  return {};
}

Result<void> write(const std::filesystem::path& out, const std::filesystem::path& uncompressed,
                   const HorizonSweep& ground, const Eyes& eyes, const std::string& crs_wkt, double eye_m,
                   int directions, std::size_t threads, const GdalSession& session, Progress& progress) {
  const GridGeometry& cells = eyes.cells;
  GDALDriverManager& drivers = *GetGDALDriverManager();
  const char* const tiled[] = {"TILED=YES", "INTERLEAVE=BAND", "BIGTIFF=IF_SAFER", "SPARSE_OK=YES", nullptr};
  GDALDatasetUniquePtr plain(drivers.GetDriverByName("GTiff")->Create(
      uncompressed.c_str(), cells.columns, cells.rows, directions, GDT_Int16, const_cast<char**>(tiled)));
  if (!plain)
    return fail(ErrorCode::kUnwritableFile, "The map could not be written: " + session.complaints());
  std::array<double, 6> places{cells.west_m, cells.cell_x_m, 0.0, cells.north_m, 0.0, -cells.cell_y_m};
  plain->SetGeoTransform(places.data());
  if (!crs_wkt.empty()) plain->SetProjection(crs_wkt.c_str());
  plain->SetMetadataItem("EYE_M", fmt::format("{:g}", eye_m).c_str());
  for (int band = 1; band <= directions; ++band) {
    GDALRasterBand& of = *plain->GetRasterBand(band);
    of.SetDescription(
        fmt::format("horizon {:g} deg clockwise of the map's north", 360.0 * (band - 1) / directions)
            .c_str());
    of.SetNoDataValue(kNoData);
    of.SetScale(kScale_deg);
    of.SetUnitType("deg");
  }
  if (auto filled = fill(*plain, ground, eyes, directions, threads, progress); !filled) return filled;
  plain->FlushCache();
  CPLStringList options;
  options.AddNameValue("LEVEL", "1");
  options.AddNameValue("PREDICTOR", "YES");
  options.AddNameValue("OVERVIEW_RESAMPLING", "NEAREST");
  return copy_as_cog(out.string(), *plain, std::move(options), threads, session, progress);
}

}  // namespace

GridGeometry coarser_grid(const GridGeometry& geometry, int every) {
  GridGeometry coarse = geometry;
  coarse.rows = geometry.rows / every;
  coarse.columns = geometry.columns / every;
  coarse.cell_x_m *= every;
  coarse.cell_y_m *= every;
  return coarse;
}

Result<void> write_horizon_map(const std::filesystem::path& out, const HorizonSweep& ground, const Eyes& eyes,
                               const std::string& crs_wkt, double eye_m, int directions, std::size_t threads,
                               Progress& progress) {
  const std::filesystem::path whole = std::filesystem::absolute(out);
  const std::filesystem::path uncompressed = whole.string() + ".uncompressed.tmp";
  const GdalSession session;
  const WritingAdmission writing(whole.parent_path());
  auto written =
      write(whole, uncompressed, ground, eyes, crs_wkt, eye_m, directions, threads, session, progress);
  std::error_code ignored;
  std::filesystem::remove(uncompressed, ignored);
  if (written) return {};
  remove_unfinished_cog(whole);
  return written;
}

}  // namespace slipway::dem
