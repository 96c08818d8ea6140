// Elevation rasters, opened fast and read by windows in stripes of whole block rows, so that memory beyond
// the answer is one stripe and GDAL's bounded block cache.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <utility>

#include "dem/elevation_source.h"
#include "dem/gdal_crs.h"
#include "dem/gdal_raster.h"

namespace slipway::dem {
namespace {

constexpr int kMargin = 2;  // cells around a window that the normals at its edge need

// Decides which stored values are heights, and converts them into metres.
struct Encoding {
  double scale = 1.0;
  double offset_m = 0.0;
  bool has_nodata = false;
  float nodata = 0.0F;
  double wide_nodata = 0.0;  // the same before rounding to float
  bool is_float32 = false;
  bool has_mask = false;
  bool is_sparse = false;  // the file does not hold all of its blocks

  bool is_height(double stored) const {
    if (!std::isfinite(stored)) return false;
    // -FLT_MAX as a text of 6 to 17 digits, and the special values of ISIS beside it: no height, declared or
    // not.
    constexpr double kBeyondHeights = 1e38;
    if (std::abs(stored) >= kBeyondHeights) return false;
    if (!has_nodata) return true;
    // -9999.9 in a header is a double, in a Float32 cell it is the nearest float.
    return is_float32 ? static_cast<float>(stored) != nodata : stored != wide_nodata;
  }
};

// Whether the file lacks a block of the window.
bool is_missing(GDALRasterBand& band, const CellWindow& window) {
  const int coverage = band.GetDataCoverageStatus(window.column, window.row, window.columns, window.rows,
                                                  GDAL_DATA_COVERAGE_STATUS_EMPTY, nullptr);
  return (coverage & GDAL_DATA_COVERAGE_STATUS_UNIMPLEMENTED) == 0 &&
         (coverage & GDAL_DATA_COVERAGE_STATUS_EMPTY) != 0;
}

Encoding encoding_of(GDALRasterBand& band) {
  Encoding encoding;
  int given = 0;
  encoding.scale = band.GetScale(&given);
  encoding.offset_m = band.GetOffset(&given);
  encoding.wide_nodata = band.GetNoDataValue(&given);
  encoding.has_nodata = given != 0;
  encoding.nodata = static_cast<float>(encoding.wide_nodata);
  encoding.is_float32 = band.GetRasterDataType() == GDT_Float32;
  encoding.is_sparse = is_missing(band, {0, 0, band.GetYSize(), band.GetXSize()});
  encoding.has_mask = (band.GetMaskFlags() & GMF_PER_DATASET) != 0;
  return encoding;
}

// Heights must be metres as well: a raster can say that they are not.
Result<void> check_height_unit(GDALRasterBand& band, const Encoding& encoding, const std::string& file) {
  std::string unit = band.GetUnitType();
  std::transform(unit.begin(), unit.end(), unit.begin(), [](unsigned char c) { return std::tolower(c); });
  for (const char* metre : {"", "m", "metre", "metres", "meter", "meters"}) {
    if (unit == metre) {
      if (std::isfinite(encoding.scale) && encoding.scale != 0.0 && std::isfinite(encoding.offset_m))
        return {};
      return fail(
          ErrorCode::kUnreadableRaster,
          fmt::format("{} has heights of {} * stored + {}, which are none. Convert it with: gdal_translate "
                      "-a_scale 1 -a_offset 0 {} {}, with the true scale and offset.",
                      file, encoding.scale, encoding.offset_m, shell_word(file),
                      shell_word(converted_name(file))));
    }
  }
  return fail(
      ErrorCode::kUnreadableRaster,
      fmt::format(
          "{} has heights in \"{}\", must be metres. Convert it with: gdal_calc.py -A {} "
          "--calc='A*0.3048' --type=Float32 --outfile={}, with the factor of that unit (0.3048 for feet).",
          file, band.GetUnitType(), shell_word(file), shell_word(converted_name(file))));
}

// In 64 bits: a raster may have as many rows as an int can count.
int end_with_margin(int first, int count, int cells) {
  return static_cast<int>(std::min<long long>(static_cast<long long>(first) + count + kMargin, cells));
}

CellWindow with_margin(const CellWindow& window, const GridGeometry& geometry) {
  const int row = std::max(window.row - kMargin, 0);
  const int column = std::max(window.column - kMargin, 0);
  return {.row = row,
          .column = column,
          .rows = end_with_margin(window.row, window.rows, geometry.rows) - row,
          .columns = end_with_margin(window.column, window.columns, geometry.columns) - column};
}

class GdalElevation final : public ElevationSource {
 public:
  GdalElevation(std::filesystem::path path, CheckedRaster raster, const Encoding& encoding)
      : path_(std::move(path)),
        dataset_(std::move(raster.dataset)),
        band_(*dataset_->GetRasterBand(1)),
        info_(std::move(raster.info)),
        encoding_(encoding) {}

  const ElevationInfo& info() const override { return info_; }

  Result<std::shared_ptr<const Terrain>> read(const Extent& extent) const override {
    const std::optional<CellWindow> met = info_.geometry.window(extent);
    if (!met) {
      const Extent map = info_.geometry.extent();
      return fail(
          ErrorCode::kOffMap,
          fmt::format(
              "The extent west {} south {} east {} north {} m does not meet the terrain, which is west "
              "{} south {} east {} north {} m.",
              extent.west_m, extent.south_m, extent.east_m, extent.north_m, map.west_m, map.south_m,
              map.east_m, map.north_m));
    }
    const CellWindow window = with_margin(*met, info_.geometry);
    const long long cells = static_cast<long long>(window.rows) * window.columns;
    if (cells > kMaxWindowCells) {
      return fail(
          ErrorCode::kInvalidRequest,
          fmt::format("The extent takes {} cells of the terrain, must be at most {}; choose a smaller one.",
                      cells, kMaxWindowCells));
    }
    if (const OGRSpatialReference* const crs = info_.crs_wkt.empty() ? nullptr : dataset_->GetSpatialRef()) {
      const auto lengths =
          check_true_lengths(*crs, info_.geometry.sub(*met).extent(), path_.filename().string());
      if (!lengths) return fail(lengths.error());
    }
    return read(window);
  }

 private:
  Result<std::shared_ptr<const Terrain>> read(const CellWindow& window) const {
    const std::lock_guard lock(mutex_);
    const GdalSession session(path_);
    const std::size_t cells =
        static_cast<std::size_t>(window.rows) * static_cast<std::size_t>(window.columns);
    std::vector<float> heights(cells);
    std::vector<std::uint8_t> valid(cells);
    int block_columns = 0;
    int block_rows = 0;
    band_.GetBlockSize(&block_columns, &block_rows);
    const int least_rows = std::clamp(1'000'000 / window.columns, 1, window.rows);
    for (int row = window.row; row < window.row + window.rows;) {
      // Up to the next edge of a block row, so that no block is decoded twice.
      const long long wanted = static_cast<long long>(row) + least_rows;
      const long long edge = (wanted + block_rows - 1) / block_rows * block_rows;
      const long long last = static_cast<long long>(window.row) + window.rows;
      const int end = static_cast<int>(std::min({edge, wanted + least_rows, last}));
      const CellWindow stripe{row, window.column, end - row, window.columns};
      const std::size_t first =
          static_cast<std::size_t>(row - window.row) * static_cast<std::size_t>(window.columns);
      if (!read_stripe(stripe, heights.data() + first, valid.data() + first)) {
        return fail(ErrorCode::kUnreadableRaster,
                    fmt::format("{} is damaged: {} could not be read ({}).", path_.filename().string(),
                                describe(stripe), session.complaints()));
      }
      row = end;
    }
    return std::make_shared<const Terrain>(info_.geometry.sub(window), std::move(heights), std::move(valid));
  }

  bool read_stripe(const CellWindow& stripe, float* heights, std::uint8_t* valid) const {
    const std::size_t cells =
        static_cast<std::size_t>(stripe.rows) * static_cast<std::size_t>(stripe.columns);
    std::vector<double> stored(cells);
    if (band_.RasterIO(GF_Read, stripe.column, stripe.row, stripe.columns, stripe.rows, stored.data(),
                       stripe.columns, stripe.rows, GDT_Float64, 0, 0, nullptr) != CE_None) {
      return false;
    }
    std::fill_n(valid, cells, std::uint8_t{1});
    if (encoding_.has_mask &&
        band_.GetMaskBand()->RasterIO(GF_Read, stripe.column, stripe.row, stripe.columns, stripe.rows, valid,
                                      stripe.columns, stripe.rows, GDT_Byte, 0, 0, nullptr) != CE_None) {
      return false;
    }
    if (encoding_.is_sparse) mask_missing_blocks(stripe, valid);
    for (std::size_t i = 0; i < cells; ++i) {
      const auto height = static_cast<float>(encoding_.scale * stored[i] + encoding_.offset_m);
      valid[i] = valid[i] != 0 && encoding_.is_height(stored[i]) && std::isfinite(height) ? 1 : 0;
      heights[i] = valid[i] != 0 ? height : 0.0F;
    }
    return true;
  }

  // GDAL gives a block that the file does not hold as zeros.
  void mask_missing_blocks(const CellWindow& stripe, std::uint8_t* valid) const {
    int width = 0, height = 0;
    band_.GetBlockSize(&width, &height);
    const int last_row = stripe.row + stripe.rows, last_column = stripe.column + stripe.columns;
    for (int row = stripe.row / height * height; row < last_row; row += height) {
      for (int column = stripe.column / width * width; column < last_column; column += width) {
        const int top = std::max(row, stripe.row), bottom = std::min(row + height, last_row);
        const int left = std::max(column, stripe.column), right = std::min(column + width, last_column);
        if (!is_missing(band_, {top, left, bottom - top, right - left})) continue;
        for (int r = top; r < bottom; ++r)
          std::fill_n(
              valid + static_cast<std::size_t>(r - stripe.row) * static_cast<std::size_t>(stripe.columns) +
                  (left - stripe.column),
              right - left, std::uint8_t{0});
      }
    }
  }

  std::filesystem::path path_;
  GDALDatasetUniquePtr dataset_;
  GDALRasterBand& band_;  // of dataset_
  ElevationInfo info_;
  Encoding encoding_;
  mutable std::mutex mutex_;  // a GDAL dataset is for one thread at a time
};

}  // namespace

Result<std::shared_ptr<const ElevationSource>> open_elevation(const std::filesystem::path& path,
                                                              PlacelessRaster placeless) {
  const GdalSession session(path);
  Result<CheckedRaster> raster = open_checked_raster(path, session, placeless);
  if (!raster) return fail(std::move(raster.error()));
  GDALRasterBand& band = *raster->dataset->GetRasterBand(1);
  const Encoding encoding = encoding_of(band);
  const Result<void> metres = check_height_unit(band, encoding, path.filename().string());
  if (!metres) return fail(metres.error());
  raster->info.scaled = encoding.scale != 1.0 || encoding.offset_m != 0.0;
  std::error_code ignored;
  return std::make_shared<const GdalElevation>(std::filesystem::canonical(path, ignored), std::move(*raster),
                                               encoding);
}

}  // namespace slipway::dem
