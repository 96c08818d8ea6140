#include "dem/gdal_raster.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>

#include "core/angle.h"
#include "dem/gdal_crs.h"
#include "dem/gdal_crs_parts.h"
#include "dem/gdal_heights.h"

namespace slipway::dem {
namespace {

namespace fs = std::filesystem;

using GeoTransform = std::array<double, 6>;

// Reasons found so far, so that one attempt reports everything that must be mended.
class Refusals {
 public:
  void add(const Error& error, bool mendable) { found_.push_back({error.code, error.detail, mendable}); }
  void add(RasterFault fault) { found_.push_back(std::move(fault)); }
  void add(const std::string& sentence, bool mendable = false) {
    found_.push_back({ErrorCode::kUnreadableRaster, sentence, mendable});
  }
  std::vector<RasterFault> take() { return std::move(found_); }

 private:
  std::vector<RasterFault> found_;
};

// Only a plain file's name goes on to GDAL, and as an absolute path, which no driver takes for anything else.
Result<fs::path> regular_file(const fs::path& path) {
  std::error_code problem;
  const fs::file_status status = fs::status(path, problem);
  const std::string name = path.filename().string();
  if (!fs::exists(status)) {
    return fail(ErrorCode::kUnreadableRaster, fmt::format("{} does not exist or may not be read.", name));
  }
  if (!fs::is_regular_file(status)) {
    return fail(ErrorCode::kUnreadableRaster, fmt::format("{} is not a regular file.", name));
  }
  const fs::path absolute = fs::canonical(path, problem);
  if (problem) return fail(ErrorCode::kUnreadableRaster, fmt::format("{} has no absolute path.", name));
  return absolute;
}

// The number of bands that hold something, and the first of them.
std::pair<int, int> data_bands(GDALDataset& dataset) {
  const int alpha = alpha_band(dataset);
  return {dataset.GetRasterCount() - (alpha != 0 ? 1 : 0), alpha == 1 ? 2 : 1};
}

void check_band(GDALDataset& dataset, const std::string& file, int chosen, Refusals& refusals) {
  const auto [bands, first] = data_bands(dataset);
  if (chosen == 0 && bands != 1) {
    refusals.add(fmt::format("{} has {} bands, must be 1. Convert it with: gdal_translate -b 1 {} {}", file,
                             bands, shell_word(file), shell_word(converted_name(file))),
                 bands > 1);
  }
  if (dataset.GetRasterXSize() < 2 || dataset.GetRasterYSize() < 2) {
    refusals.add(fmt::format("{} has {} rows and {} columns, must be at least 2 of each.", file,
                             dataset.GetRasterYSize(), dataset.GetRasterXSize()));
  }
  if (bands < 1) return;
  GDALRasterBand& band = *dataset.GetRasterBand(chosen != 0 ? chosen : first);
  const GDALDataType type = band.GetRasterDataType();
  if (GDALDataTypeIsComplex(type) != 0) {
    refusals.add(
        fmt::format("{} holds complex numbers ({}). Convert it with: gdal_translate -ot Float32 {} {}", file,
                    GDALGetDataTypeName(type), shell_word(file), shell_word(converted_name(file))));
  }
  int block_columns = 0;
  int block_rows = 0;
  band.GetBlockSize(&block_columns, &block_rows);
  // Doubles: the product of two large blocks overflows even 64-bit integers in a forged header.
  const double bytes = static_cast<double>(block_columns) * block_rows * GDALGetDataTypeSizeBytes(type);
  if (!(block_columns > 0 && block_rows > 0 && bytes <= static_cast<double>(kMaxBlockBytes))) {
    refusals.add(RasterFault{
        .sentence = fmt::format(
            "{} is stored in blocks of {} x {} cells, {:.0f} MB each, must be at most {} MB. Convert "
            "it with: gdal_translate -co TILED=YES -co COMPRESS=DEFLATE {} {}",
            file, block_rows, block_columns, bytes / 1e6, kMaxBlockBytes / 1'000'000, shell_word(file),
            shell_word(converted_name(file))),
        .cells_are_closed = true});
  }
}

std::optional<GeoTransform> check_grid(GDALDataset& dataset, const std::string& file, Refusals& refusals) {
  GeoTransform g{};
  if (dataset.GetGeoTransform(g.data()) != CE_None) {
    refusals.add(
        fmt::format("{} does not say where its grid lies. Convert it with: gdal_translate -a_ullr WEST NORTH "
                    "EAST SOUTH {} {}, with its edges in metres.",
                    file, shell_word(file), shell_word(converted_name(file))));
    return std::nullopt;
  }
  for (const double coefficient : g) {
    if (!std::isfinite(coefficient) || std::abs(coefficient) > 1e12) {
      refusals.add(fmt::format("{} has a grid at {}, which is nowhere on a map.", file, coefficient));
      return std::nullopt;
    }
  }
  if (g[2] != 0.0 || g[4] != 0.0) {
    refusals.add(fmt::format("{} has a grid that is rotated against the map axes. Convert it with: {}", file,
                             warp_command("", file)),
                 true);
  } else if (g[1] <= 0.0 || g[5] >= 0.0) {
    refusals.add(
        fmt::format("{} has its first cell in the {}{}, must be north-up and west-left. Convert it with: {}",
                    file, g[5] >= 0.0 ? "south" : "north", g[1] <= 0.0 ? "-east" : "-west",
                    warp_command("", file)),
        g[1] != 0.0 && g[5] != 0.0);
  }
  return g;
}

// Of shorter cells nothing on the ground is known, and their number overflows.
void check_cell_size(const GeoTransform& g, const OGRSpatialReference* crs, const std::string& file,
                     Refusals& refusals) {
  constexpr double kLeast_m = 1e-3;
  const double unit_m = crs == nullptr             ? 1.0
                        : crs->IsGeographic() != 0 ? rad_from_deg(1.0) * crs->GetSemiMajor()
                                                   : crs->GetLinearUnits();
  const double side_m = unit_m * std::min(std::hypot(g[1], g[4]), std::hypot(g[2], g[5]));
  if (side_m == 0.0 || side_m >= kLeast_m) return;  // a grid without cells is refused as such
  refusals.add(
      fmt::format("{} has cells of {:.3g} m, must be at least {} m. State where its edges lie with: "
                  "gdal_translate -a_ullr WEST NORTH EAST SOUTH {} {}, in the map's own coordinates.",
                  file, side_m, kLeast_m, shell_word(file), shell_word(converted_name(file))));
}

GridGeometry grid_geometry(GDALDataset& dataset, const GeoTransform& g) {
  return {.rows = dataset.GetRasterYSize(),
          .columns = dataset.GetRasterXSize(),
          .west_m = g[0],
          .north_m = g[3],
          .cell_x_m = g[1],
          .cell_y_m = -g[5]};
}

RasterCentre centre_of(GDALDataset& dataset, const GeoTransform& g) {
  const double column = 0.5 * dataset.GetRasterXSize();
  const double row = 0.5 * dataset.GetRasterYSize();
  return {g[0] + column * g[1] + row * g[2], g[3] + column * g[4] + row * g[5]};
}

// Of a text with less than a digit and a blank for each cell that its head promises: GDAL would look for the
// others for minutes.
std::optional<std::string> missing_cells(GDALDataset& dataset, const fs::path& path) {
  if (std::string_view(dataset.GetDriverName()) != "AAIGrid") return std::nullopt;
  std::error_code error;
  const std::uintmax_t bytes = fs::file_size(path, error);
  const auto rows = static_cast<std::uintmax_t>(dataset.GetRasterYSize()),
             columns = static_cast<std::uintmax_t>(dataset.GetRasterXSize());
  if (error || bytes + 1 >= 2 * rows * columns) return std::nullopt;
  return fmt::format(
      "{} has {} bytes, which can't be the {} rows of {} numbers of its head: it was cut off, "
      "or nrows and ncols are wrong",
      path.filename().string(), bytes, rows, columns);
}

}  // namespace

std::string describe(const CellWindow& window) {
  return fmt::format("rows {} to {}, columns {} to {}", window.row, window.row + window.rows - 1,
                     window.column, window.column + window.columns - 1);
}

Result<GDALDatasetUniquePtr> open_raster(const fs::path& path, const GdalSession& session) {
  const Result<fs::path> absolute = regular_file(path);
  if (!absolute) return fail(absolute.error());
  const SidecarReading sidecars(true);
  GDALDatasetUniquePtr dataset(GDALDataset::Open(absolute->c_str(),
                                                 GDAL_OF_RASTER | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR,
                                                 allowed_raster_drivers(), nullptr, nullptr));
  if (dataset) {
    // GeoTIFF looks for its sidecar when it is first asked for what may be in it.
    std::array<double, 6> grid{};
    dataset->GetGeoTransform(grid.data());
    if (dataset->GetRasterCount() > 0) dataset->GetRasterBand(1)->GetNoDataValue();
    if (auto missing = missing_cells(*dataset, *absolute))
      return fail(ErrorCode::kUnreadableRaster, *std::move(missing));
    return dataset;
  }
  return fail(
      ErrorCode::kUnreadableRaster,
      fmt::format("{} is not a readable raster of a supported format (GeoTIFF, ASCII grid, PDS, PDS4, "
                  "ISIS, ENVI, EHdr): {}",
                  path.filename().string(), session.complaints()));
}

std::vector<RasterFault> faults_of(GDALDataset& dataset, const OGRSpatialReference* crs,
                                   const std::string& file, PlacelessRaster placeless, int band) {
  Refusals refusals;
  check_band(dataset, file, band, refusals);
  const std::optional<GeoTransform> grid = check_grid(dataset, file, refusals);
  if (grid) check_cell_size(*grid, crs, file, refusals);
  if (placeless == PlacelessRaster::kLocalFrame && is_local_frame(crs)) return refusals.take();
  const auto system = horizontal_part(crs);
  const Result<void> metric =
      check_metric_projection(system.get(), grid ? centre_of(dataset, *grid) : RasterCentre{}, file);
  if (!metric) refusals.add(metric.error(), can_be_reprojected(system.get()));
  return refusals.take();
}

Error error_of(const std::vector<RasterFault>& faults) {
  Error error{faults.front().code, "", {}};
  for (const RasterFault& fault : faults) {
    error.detail += (error.detail.empty() ? "" : " ") + fault.sentence;
    error.faults.push_back({"", fault.sentence});
  }
  return error;
}

Result<CheckedRaster> open_checked_raster(const fs::path& path, const GdalSession& session,
                                          PlacelessRaster placeless) {
  auto opened = open_raster(path, session);
  if (!opened) return fail(opened.error());
  CheckedRaster raster;
  raster.dataset = std::move(*opened);
  raster.system = system_of(*raster.dataset);
  const OGRSpatialReference* const crs = raster.system.get();
  const auto faults = faults_of(*raster.dataset, crs, path.filename().string(), placeless);
  if (!faults.empty()) return fail(error_of(faults));

  GeoTransform grid{};
  raster.dataset->GetGeoTransform(grid.data());
  raster.band = data_bands(*raster.dataset).second;
  raster.info.geometry = grid_geometry(*raster.dataset, grid);
  raster.info.data_type =
      GDALGetDataTypeName(raster.dataset->GetRasterBand(raster.band)->GetRasterDataType());
  if (placeless == PlacelessRaster::kLocalFrame && is_local_frame(crs)) {
    raster.info.crs_name = "local frame";
    raster.info.body = "other";
  } else {
    const auto reach = check_reach(*crs, raster.info.geometry.extent(), path.filename().string());
    if (!reach) return fail(reach.error());
    describe_crs(*crs, raster.info);
  }
  return raster;
}

}  // namespace slipway::dem
