#include <cpl_string.h>
#include <fmt/format.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/angle.h"
#include "core/parallel_for.h"
#include "dem/gdal_session.h"
#include "dem/write/gdal_cog_copy.h"
#include "dem/write/horizon_map.h"

namespace slipway::dem {
namespace {

constexpr std::int16_t kNoData = -32768;
constexpr double kScale_deg = 0.01;
constexpr int kRows = 32;  // that are computed and written together

Result<void> fill(GDALDataset& dataset, const Horizon& horizon, const GridGeometry& cells, double eye_m,
                  int directions, std::size_t threads, Progress& progress) {
  std::vector<std::int16_t> values;
  for (int first = 0; first < cells.rows; first += kRows) {
    if (progress.cancelled()) return fail(ErrorCode::kCancelled, "the map was given up");
    progress.report("looking at horizons", 0.8 * first / cells.rows);
    const int rows = std::min(kRows, cells.rows - first);
    const std::size_t of_band = static_cast<std::size_t>(rows) * static_cast<std::size_t>(cells.columns);
    values.assign(of_band * static_cast<std::size_t>(directions), kNoData);
    parallel_for(of_band, threads, [&](std::size_t cell) {
      const auto columns = static_cast<std::size_t>(cells.columns);
      const Eigen::Vector2d centre =
          cells.centre_m({first + static_cast<int>(cell / columns), static_cast<int>(cell % columns)});
      const auto around = horizon.all_around_rad(centre.x(), centre.y(), eye_m, directions);
      for (std::size_t band = 0; around && band < around->size(); ++band)
        values[band * of_band + cell] =
            static_cast<std::int16_t>(std::lround(deg_from_rad((*around)[band]) / kScale_deg));
    });
    if (dataset.RasterIO(GF_Write, 0, first, cells.columns, rows, values.data(), cells.columns, rows,
                         GDT_Int16, directions, nullptr, 0, 0, 0, nullptr) != CE_None)
      return fail(ErrorCode::kUnwritableFile, "The map could not be written");
  }
  return {};
}

Result<void> write(const std::filesystem::path& out, const std::filesystem::path& uncompressed,
                   const Horizon& horizon, const GridGeometry& cells, const std::string& crs_wkt,
                   double eye_m, int directions, std::size_t threads, const GdalSession& session,
                   Progress& progress) {
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
    of.SetDescription(fmt::format("horizon at azimuth {:g} deg", 360.0 * (band - 1) / directions).c_str());
    of.SetNoDataValue(kNoData);
    of.SetScale(kScale_deg);
    of.SetUnitType("deg");
  }
  if (auto filled = fill(*plain, horizon, cells, eye_m, directions, threads, progress); !filled)
    return filled;
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

Result<void> write_horizon_map(const std::filesystem::path& out, const Horizon& horizon,
                               const GridGeometry& cells, const std::string& crs_wkt, double eye_m,
                               int directions, std::size_t threads, Progress& progress) {
  const std::filesystem::path whole = std::filesystem::absolute(out);
  const std::filesystem::path uncompressed = whole.string() + ".uncompressed.tmp";
  const GdalSession session;
  const WritingAdmission writing(whole.parent_path());
  auto written =
      write(whole, uncompressed, horizon, cells, crs_wkt, eye_m, directions, threads, session, progress);
  std::error_code ignored;
  std::filesystem::remove(uncompressed, ignored);
  if (written) return {};
  remove_unfinished_cog(whole);
  return written;
}

}  // namespace slipway::dem
