// Elevation rasters, opened fast and read by windows in stripes of whole block rows, so that memory beyond
// the answer is one stripe and GDAL's bounded block cache.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <utility>

#include "dem/elevation_source.h"
#include "dem/gdal_block_reader.h"
#include "dem/gdal_crs.h"
#include "dem/gdal_heights.h"
#include "dem/gdal_raster.h"
#include "dem/gdal_raster_meaning.h"

namespace slipway::dem {
namespace {

constexpr int kMargin = 2;  // cells around a window that the normals at its edge need

// In 64 bits: a raster may have as many rows as an int can count.
int end_with_margin(int first, int count, int cells, long long margin) {
  return static_cast<int>(std::min<long long>(static_cast<long long>(first) + count + margin, cells));
}

// With kMargin cells around, where one counts `step` cells of the raster.
CellWindow with_margin(const CellWindow& window, const GridGeometry& geometry, int step = 1) {
  const long long margin = static_cast<long long>(kMargin) * step;
  const int row = static_cast<int>(std::max<long long>(window.row - margin, 0));
  const int column = static_cast<int>(std::max<long long>(window.column - margin, 0));
  return {.row = row,
          .column = column,
          .rows = end_with_margin(window.row, window.rows, geometry.rows, margin) - row,
          .columns = end_with_margin(window.column, window.columns, geometry.columns, margin) - column};
}

// The window grown to whole steps from the raster's corner: every window then has the same samples, so that
// neighbouring pictures fit together.
CellWindow whole_steps(CellWindow window, const GridGeometry& geometry, int step) {
  const auto end = [&](int first, int count, int cells) {
    const long long steps = (static_cast<long long>(first) + count + step - 1) / step;
    return static_cast<int>(std::min<long long>(steps * step, cells));
  };
  const int last_row = end(window.row, window.rows, geometry.rows);
  const int last_column = end(window.column, window.columns, geometry.columns);
  window.row -= window.row % step;
  window.column -= window.column % step;
  window.rows = last_row - window.row;
  window.columns = last_column - window.column;
  return window;
}

// The middle of the k-th stretch of so many cells, the last stretch may be shorter.
int middle_of(int k, int step, int cells) {
  return static_cast<int>(std::min<long long>(static_cast<long long>(k) * step + step / 2, cells - 1));
}

class GdalElevation final : public ElevationSource, public std::enable_shared_from_this<GdalElevation> {
 public:
  GdalElevation(std::filesystem::path path, CheckedRaster raster, const HeightEncoding& encoding)
      : path_(std::move(path)),
        dataset_(std::move(raster.dataset)),
        system_(std::move(raster.system)),
        band_(*dataset_->GetRasterBand(raster.band)),
        info_(std::move(raster.info)),
        encoding_(encoding),
        lengths_are_true_(info_.crs_wkt.empty() ||
                          check_true_lengths(*system_, info_.geometry.extent(), path_.filename().string())),
        blocks_(GdalBlockReader::of(path_, *dataset_, encoding)) {}

  const ElevationInfo& info() const override { return info_; }

  Result<std::shared_ptr<const Terrain>> read(const Extent& extent) const override {
    const auto met = window_of(extent);
    if (!met) return fail(met.error());
    const CellWindow window = with_margin(*met, info_.geometry);
    if (const auto lengths = check_lengths(info_.geometry.sub(*met).extent()); !lengths)
      return fail(lengths.error());
    if (static_cast<long long>(window.rows) * window.columns > kMaxWindowCells)
      return std::make_shared<const Terrain>(info_.geometry.sub(window),
                                             std::make_shared<const Cells>(shared_from_this(), window));
    const std::size_t cells =
        static_cast<std::size_t>(window.rows) * static_cast<std::size_t>(window.columns);
    std::vector<float> heights(cells);
    std::vector<std::uint8_t> valid(cells);
    if (const Result<void> whole = read(window, heights.data(), valid.data()); !whole)
      return fail(whole.error());
    return std::make_shared<const Terrain>(info_.geometry.sub(window), std::move(heights), std::move(valid));
  }

  Result<std::shared_ptr<const Terrain>> read_samples(const Extent& extent, int wanted_step) const override {
    const auto met = window_of(extent);
    if (!met) return fail(met.error());
    const Overview overview = overview_of(wanted_step);
    const int step = overview.band != nullptr ? overview.factor : wanted_step;
    const CellWindow window = whole_steps(with_margin(*met, info_.geometry, step), info_.geometry, step);
    GridGeometry coarse = info_.geometry.sub(window);
    coarse.rows = (window.rows - 1) / step + 1;
    coarse.columns = (window.columns - 1) / step + 1;
    coarse.cell_x_m *= step;
    coarse.cell_y_m *= step;
    if (const auto few = check_cells(coarse.rows, coarse.columns); !few) return fail(few.error());
    if (overview.band != nullptr || step == 1) {
      if (auto read = read_blocks(overview.number, window, step, coarse)) return read;
    }
    return overview.band != nullptr ? read_overview(*overview.band, window, step, coarse)
                                    : read_rows(window, step, coarse);
  }

 private:
  // The same raster from farther away: a cell of it stands for so many of the raster's along each side.
  struct Overview {
    GDALRasterBand* band = nullptr;
    int number = GdalBlockReader::kItself;
    int factor = 1;
  };

  // The coarsest overview with cells no larger than the steps, for pictures of wide ground: reading every row
  // of a large raster for a few of its samples takes seconds. None where the file has none.
  Overview overview_of(int step) const {
    const std::lock_guard lock(mutex_);
    Overview found;
    for (int k = 0; k < band_.GetOverviewCount(); ++k) {
      GDALRasterBand* const band = band_.GetOverview(k);
      const int factor = (info_.geometry.columns + band->GetXSize() / 2) / std::max(1, band->GetXSize());
      const bool is_whole = (info_.geometry.columns + factor - 1) / factor == band->GetXSize() &&
                            (info_.geometry.rows + factor - 1) / factor == band->GetYSize();
      if (is_whole && factor <= step && factor > found.factor) found = {band, k, factor};
    }
    return found;
  }

  // The same as read_overview and read_rows by several threads at once; nothing where it can't be done.
  std::shared_ptr<const Terrain> read_blocks(int overview, const CellWindow& window, int step,
                                             const GridGeometry& coarse) const {
    if (!blocks_) return nullptr;
    std::vector<float> heights(static_cast<std::size_t>(coarse.rows) *
                               static_cast<std::size_t>(coarse.columns));
    std::vector<std::uint8_t> valid(heights.size());
    const CellWindow cells{window.row / step, window.column / step, coarse.rows, coarse.columns};
    if (!blocks_->read(overview, cells, heights.data(), valid.data())) return nullptr;
    return std::make_shared<const Terrain>(coarse, std::move(heights), std::move(valid));
  }

  // The window's cells in an overview. Its corner lies on whole steps.
  Result<std::shared_ptr<const Terrain>> read_overview(GDALRasterBand& overview, const CellWindow& window,
                                                       int step, const GridGeometry& coarse) const {
    const std::lock_guard lock(mutex_);
    const GdalSession session(path_);
    std::vector<float> heights(static_cast<std::size_t>(coarse.rows) *
                               static_cast<std::size_t>(coarse.columns));
    std::vector<std::uint8_t> valid(heights.size());
    const CellWindow cells{window.row / step, window.column / step, coarse.rows, coarse.columns};
    if (!read_heights(overview, encoding_, cells, heights.data(), valid.data()))
      return damaged(window, session);
    return std::make_shared<const Terrain>(coarse, std::move(heights), std::move(valid));
  }

  Result<CellWindow> window_of(const Extent& extent) const {
    if (const std::optional<CellWindow> met = info_.geometry.window(extent)) return *met;
    const Extent map = info_.geometry.extent();
    return fail(ErrorCode::kOffMap,
                fmt::format("The extent west {} south {} east {} north {} m does not meet the terrain, which "
                            "is west {} south {} east {} north {} m.",
                            extent.west_m, extent.south_m, extent.east_m, extent.north_m, map.west_m,
                            map.south_m, map.east_m, map.north_m));
  }

  static Result<void> check_cells(int rows, int columns) {
    const long long cells = static_cast<long long>(rows) * columns;
    if (cells <= kMaxWindowCells) return {};
    return fail(
        ErrorCode::kInvalidRequest,
        fmt::format("The extent takes {} cells of the terrain, must be at most {}; choose a smaller one.",
                    cells, kMaxWindowCells));
  }

  // One row of the window after the other, of which the samples are kept.
  Result<std::shared_ptr<const Terrain>> read_rows(const CellWindow& window, int step,
                                                   const GridGeometry& coarse) const {
    const std::lock_guard lock(mutex_);
    const GdalSession session(path_);
    std::vector<float> row(static_cast<std::size_t>(window.columns)), heights;
    std::vector<std::uint8_t> row_valid(row.size()), valid;
    heights.reserve(static_cast<std::size_t>(coarse.rows) * static_cast<std::size_t>(coarse.columns));
    valid.reserve(heights.capacity());
    for (int r = 0; r < coarse.rows; ++r) {
      const CellWindow line{window.row + middle_of(r, step, window.rows), window.column, 1, window.columns};
      if (!read_heights(band_, encoding_, line, row.data(), row_valid.data())) return damaged(line, session);
      for (int c = 0; c < coarse.columns; ++c) {
        const auto sample = static_cast<std::size_t>(middle_of(c, step, window.columns));
        heights.push_back(row[sample]);
        valid.push_back(row_valid[sample]);
      }
    }
    return std::make_shared<const Terrain>(coarse, std::move(heights), std::move(valid));
  }

  tl::unexpected<Error> damaged(const CellWindow& window, const GdalSession& session) const {
    return fail(ErrorCode::kUnreadableRaster,
                fmt::format("{} is damaged: {} could not be read ({}).", path_.filename().string(),
                            describe(window), session.complaints()));
  }

  // Of a window that is read by tiles.
  class Cells final : public CellReader {
   public:
    Cells(std::shared_ptr<const GdalElevation> source, const CellWindow& window)
        : source_(std::move(source)), window_(window) {}
    Result<void> read(const CellWindow& w, float* heights_m, std::uint8_t* valid) const override {
      return source_->read({window_.row + w.row, window_.column + w.column, w.rows, w.columns}, heights_m,
                           valid);
    }

   private:
    std::shared_ptr<const GdalElevation> source_;
    CellWindow window_;
  };

  // Where they are true over the whole map, no window is looked at.
  Result<void> check_lengths(const Extent& extent) const {
    if (lengths_are_true_) return {};
    const std::lock_guard lock(mutex_);
    return check_true_lengths(*system_, extent, path_.filename().string());
  }

  Result<void> read(const CellWindow& window, float* heights, std::uint8_t* valid) const {
    const std::lock_guard lock(mutex_);
    const GdalSession session(path_);
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
      if (!read_heights(band_, encoding_, stripe, heights + first, valid + first))
        return damaged(stripe, session);
      row = end;
    }
    return {};
  }

  std::filesystem::path path_;
  GDALDatasetUniquePtr dataset_;
  std::unique_ptr<OGRSpatialReference> system_;
  GDALRasterBand& band_;  // of dataset_
  ElevationInfo info_;
  HeightEncoding encoding_;
  bool lengths_are_true_;  // over the whole map; a map without a system is taken at its word
  std::unique_ptr<GdalBlockReader> blocks_;
  mutable std::mutex mutex_;  // a GDAL dataset is for one thread at a time
};

}  // namespace

Result<std::shared_ptr<const ElevationSource>> open_elevation(const std::filesystem::path& path,
                                                              PlacelessRaster placeless) {
  const GdalSession session(path);
  Result<CheckedRaster> raster = open_checked_raster(path, session, placeless);
  if (!raster) return fail(std::move(raster.error()));
  const std::string file = path.filename().string();
  const BandChoice band{raster->band, "", "", false};
  const RasterMeaning meaning = meaning_of(*raster->dataset, band);
  if (const auto sidecar = fault_of_sidecar(*raster->dataset))
    return fail(ErrorCode::kUnreadableRaster, *sidecar);
  if (const auto picture = fault_of_picture(*raster->dataset, band, file, !meaning.unit.empty()))
    return fail(ErrorCode::kUnreadableRaster, *picture);
  if (const auto metres = check_metres(meaning, file); !metres) return fail(metres.error());
  const HeightEncoding& encoding = meaning.encoding;
  raster->info.scaled = encoding.scale != 1.0 || encoding.offset_m != 0.0;
  std::error_code ignored;
  return std::make_shared<const GdalElevation>(std::filesystem::canonical(path, ignored), std::move(*raster),
                                               encoding);
}

}  // namespace slipway::dem
