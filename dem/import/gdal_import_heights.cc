#include "dem/import/gdal_import_heights.h"

#include <cpl_string.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "dem/gdal_import.h"
#include "dem/gdal_raster.h"

namespace slipway::dem {
namespace {

namespace fs = std::filesystem;

constexpr float kNoHeight = std::numeric_limits<float>::lowest();  // as planetary maps have it
constexpr int kRowsAtOnce = 256;                                   // a row of tiles

// The heights row of tiles by row of tiles, in the arrangement's order.
class ArrangedHeights {
 public:
  ArrangedHeights(const HeightSource& source, bool counts)
      : band_(source.band),
        encoding_(source.encoding),
        a_(source.arrangement),
        counts_(counts),
        census_(band_.GetXSize(), counts ? cell_side_m(a_) : 0.0, counts ? quantum_m() : 0.0) {}

  int rows() const { return band_.GetYSize(); }
  int columns() const { return band_.GetXSize(); }

  // Rows [row, row + count); cells without a height are kNoHeight. The window where the file is damaged.
  std::optional<CellWindow> read(int row, int count, std::vector<float>& heights, Scan& scan) {
    const auto width = static_cast<std::size_t>(columns());
    const std::size_t cells = static_cast<std::size_t>(count) * width;
    heights.resize(cells);
    valid_.resize(cells);
    const CellWindow window{a_.flips_rows ? rows() - row - count : row, 0, count, columns()};
    if (!read_heights(band_, encoding_, window, heights.data(), valid_.data())) return window;
    for (std::size_t i = 0; i < cells; ++i) {
      if (valid_[i] == 0) {
        heights[i] = kNoHeight;
        continue;
      }
      scan.impossible.look_at(heights[i] * a_.metres_per_height, stored(heights[i]), is_scaled());
      heights[i] = static_cast<float>(heights[i] * a_.metres_per_height);
      scan.lowest_m = std::min<double>(scan.lowest_m, heights[i]);
      scan.highest_m = std::max<double>(scan.highest_m, heights[i]);
      ++scan.heights;
    }
    turn(heights, count);
    for (int r = 0; counts_ && r < count; ++r)
      census_.add_row(heights.data() + static_cast<std::ptrdiff_t>(r) * columns(), kNoHeight);
    return std::nullopt;
  }

  HeightCensus& census() { return census_; }

 private:
  // What the file has for a height; bands that are scaled hold whole numbers.
  double stored(float height_m) const {
    return is_scaled() ? std::round((height_m - encoding_.offset_m) / encoding_.scale) : height_m;
  }
  double quantum_m() const {
    const bool is_whole = GDALDataTypeIsInteger(band_.GetRasterDataType()) != 0;
    return is_whole ? std::abs(encoding_.scale * a_.metres_per_height) : 0.0;
  }
  bool is_scaled() const { return encoding_.scale != 1.0 || encoding_.offset_m != 0.0; }

  void turn(std::vector<float>& heights, int count) const {
    const auto width = static_cast<std::ptrdiff_t>(columns());
    const auto row = [&](int r) { return heights.begin() + r * width; };
    if (a_.flips_rows)
      for (int r = 0; r < count / 2; ++r) std::swap_ranges(row(r), row(r + 1), row(count - 1 - r));
    if (a_.flips_columns)
      for (int r = 0; r < count; ++r) std::reverse(row(r), row(r + 1));
  }

  GDALRasterBand& band_;
  const HeightEncoding& encoding_;
  const Arrangement& a_;
  bool counts_;  // heights that many cells have
  HeightCensus census_;
  std::vector<std::uint8_t> valid_;
};

// Creates the file that the heights go to.
GDALDatasetUniquePtr create(const fs::path& out, const Arrangement& a, int rows, int columns) {
  CPLStringList creation;
  for (const std::string& option : tiled_creation(true)) creation.AddString(option.c_str());
  GDALDatasetUniquePtr made(GetGDALDriverManager()->GetDriverByName("GTiff")->Create(
      out.c_str(), columns, rows, 1, GDT_Float32, creation.List()));
  if (!made) return made;
  std::array<double, 6> grid = a.grid;
  GDALRasterBand& band = *made->GetRasterBand(1);
  if (made->SetGeoTransform(grid.data()) != CE_None || made->SetSpatialRef(a.crs.get()) != CE_None ||
      band.SetNoDataValue(kNoHeight) != CE_None || band.SetUnitType("m") != CE_None)
    made.reset();
  return made;
}

// Writes the cells where there is a file.
Result<Scan> pass_through(const HeightSource& from, GDALDataset* made, const GdalSession& session,
                          Progress& progress) {
  ArrangedHeights source(from, made != nullptr);
  Scan scan;
  std::vector<float> heights;
  for (int row = 0; row < source.rows(); row += kRowsAtOnce) {
    progress.report(made != nullptr ? "copying heights" : "reading heights",
                    static_cast<double>(row) / source.rows());
    const int count = std::min(kRowsAtOnce, source.rows() - row);
    if (const auto lost = source.read(row, count, heights, scan)) {
      return fail(ErrorCode::kUnreadableRaster,
                  fmt::format("{} is damaged: {} could not be read ({}). Copy or fetch it again.", from.file,
                              describe(*lost), session.complaints()));
    }
    if (made != nullptr &&
        made->GetRasterBand(1)->RasterIO(GF_Write, 0, row, source.columns(), count, heights.data(),
                                         source.columns(), count, GDT_Float32, 0, 0, nullptr) != CE_None) {
      return fail(ErrorCode::kUnwritableFile, "The heights could not be written: " + session.complaints());
    }
  }
  if (scan.heights == 0)
    return fail(ErrorCode::kUnreadableRaster,
                from.file + " has no cell with a height: nothing can drive there.");
  if (scan.impossible.cells > 0)
    return fail(ErrorCode::kUnreadableRaster, scan.impossible.fault(from.file, from.encoding.has_nodata));
  if (made != nullptr) scan.constant = source.census().findings();
  return scan;
}

}  // namespace

Result<Scan> scan_heights(const HeightSource& source, const GdalSession& session, Progress& progress) {
  return pass_through(source, nullptr, session, progress);
}

Result<Scan> write_heights(const HeightSource& source, const fs::path& out, const GdalSession& session,
                           Progress& progress) {
  CPLErrorReset();
  GDALDatasetUniquePtr made = create(out, source.arrangement, source.band.GetYSize(), source.band.GetXSize());
  if (!made) return fail(ErrorCode::kUnwritableFile, "The map can't be created: " + session.complaints());
  auto scan = pass_through(source, made.get(), session, progress);
  CPLErrorReset();
  made.reset();  // closing writes what is left
  if (scan && CPLGetLastErrorType() >= CE_Failure)
    return fail(ErrorCode::kUnwritableFile, "The map could not be closed: " + session.complaints());
  return scan;
}

}  // namespace slipway::dem
