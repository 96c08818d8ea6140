#include "dem/gdal_heights.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <string_view>
#include <utility>
#include <vector>

#include "dem/gdal_crs.h"

namespace slipway::dem {
namespace {

// Whether a window may have blocks that the file lacks. Zeros that a file system keeps as a hole are such
// blocks for GDAL too.
bool may_be_missing(GDALRasterBand& band, const CellWindow& window) {
  const int coverage = band.GetDataCoverageStatus(window.column, window.row, window.columns, window.rows,
                                                  GDAL_DATA_COVERAGE_STATUS_EMPTY, nullptr);
  return (coverage & GDAL_DATA_COVERAGE_STATUS_UNIMPLEMENTED) == 0 &&
         (coverage & GDAL_DATA_COVERAGE_STATUS_EMPTY) != 0;
}

// Whether the file has no bytes for a block, which is counted in blocks.
bool is_missing(GDALRasterBand& band, int block_row, int block_column) {
  return band.GetMetadataItem(fmt::format("BLOCK_OFFSET_{}_{}", block_column, block_row).c_str(), "TIFF") ==
         nullptr;
}

bool is_sparse(GDALRasterBand& band) {
  if (!may_be_missing(band, {0, 0, band.GetYSize(), band.GetXSize()})) return false;
  int width = 0, height = 0;
  band.GetBlockSize(&width, &height);
  for (int row = 0; row < (band.GetYSize() - 1) / height + 1; ++row)
    for (int column = 0; column < (band.GetXSize() - 1) / width + 1; ++column)
      if (is_missing(band, row, column)) return true;
  return false;
}

// GDAL gives a block that the file does not hold as zeros.
void mask_missing_blocks(GDALRasterBand& band, const CellWindow& window, std::uint8_t* valid) {
  int width = 0, height = 0;
  band.GetBlockSize(&width, &height);
  // A file may state blocks that end beyond what an int counts.
  const std::int64_t last_row = window.row + window.rows, last_column = window.column + window.columns;
  for (std::int64_t row = window.row / height * height; row < last_row; row += height) {
    for (std::int64_t column = window.column / width * width; column < last_column; column += width) {
      const int top = static_cast<int>(std::max<std::int64_t>(row, window.row)),
                bottom = static_cast<int>(std::min(row + height, last_row)),
                left = static_cast<int>(std::max<std::int64_t>(column, window.column)),
                right = static_cast<int>(std::min(column + width, last_column));
      if (!is_missing(band, static_cast<int>(row / height), static_cast<int>(column / width))) continue;
      for (int r = top; r < bottom; ++r)
        std::fill_n(valid +
                        static_cast<std::size_t>(r - window.row) * static_cast<std::size_t>(window.columns) +
                        (left - window.column),
                    right - left, std::uint8_t{0});
    }
  }
}

// GDAL takes an alpha band of 8 or 16 bits for a mask, and only where it is the second or fourth of all.
bool mask_transparent(GDALRasterBand& band, int alpha, const CellWindow& window, std::uint8_t* valid) {
  const std::size_t cells = static_cast<std::size_t>(window.rows) * static_cast<std::size_t>(window.columns);
  std::vector<double> opacity(cells);
  GDALDataset* const dataset = band.GetDataset();
  if (dataset == nullptr || dataset->GetRasterCount() < alpha ||
      dataset->GetRasterBand(alpha)->RasterIO(GF_Read, window.column, window.row, window.columns, window.rows,
                                              opacity.data(), window.columns, window.rows, GDT_Float64, 0, 0,
                                              nullptr) != CE_None)
    return false;
  for (std::size_t i = 0; i < cells; ++i)
    if (!(opacity[i] > 0.0)) valid[i] = 0;
  return true;
}

}  // namespace

int alpha_band(GDALDataset& dataset) {
  for (int band = dataset.GetRasterCount(); band > 0; --band)
    if (dataset.GetRasterBand(band)->GetColorInterpretation() == GCI_AlphaBand) return band;
  return 0;
}

HeightEncoding encoding_of(GDALRasterBand& band) {
  HeightEncoding encoding;
  int given = 0;
  encoding.scale = band.GetScale(&given);
  encoding.offset_m = band.GetOffset(&given);
  encoding.wide_nodata = band.GetNoDataValue(&given);
  encoding.has_nodata = given != 0;
  encoding.nodata = static_cast<float>(encoding.wide_nodata);
  encoding.is_float32 = band.GetRasterDataType() == GDT_Float32;
  encoding.is_sparse = is_sparse(band);
  const int mask = band.GetMaskFlags();
  encoding.has_mask = (mask & GMF_ALL_VALID) == 0 && mask != GMF_NODATA;
  if (band.GetDataset() != nullptr) encoding.alpha_band = alpha_band(*band.GetDataset());
  return encoding;
}

std::optional<double> metres_of_unit(std::string unit) {
  std::transform(unit.begin(), unit.end(), unit.begin(), [](unsigned char c) {
    return c == '_' || c == '-' ? ' ' : static_cast<char>(std::tolower(c));
  });
  constexpr double kSurveyFoot = 1200.0 / 3937.0;
  constexpr std::pair<std::string_view, double> kUnits[] = {{"", 1.0},
                                                            {"m", 1.0},
                                                            {"metre", 1.0},
                                                            {"metres", 1.0},
                                                            {"meter", 1.0},
                                                            {"meters", 1.0},
                                                            {"ft", 0.3048},
                                                            {"foot", 0.3048},
                                                            {"feet", 0.3048},
                                                            {"international foot", 0.3048},
                                                            {"ifoot", 0.3048},
                                                            {"international feet", 0.3048},
                                                            {"yd", 0.9144},
                                                            {"yard", 0.9144},
                                                            {"us ft", kSurveyFoot},
                                                            {"ftus", kSurveyFoot},
                                                            {"us survey foot", kSurveyFoot},
                                                            {"us survey feet", kSurveyFoot},
                                                            {"us foot", kSurveyFoot},
                                                            {"us feet", kSurveyFoot},
                                                            {"foot us", kSurveyFoot},
                                                            {"u.s. survey foot", kSurveyFoot},
                                                            {"survey foot", kSurveyFoot},
                                                            {"u.s. survey feet", kSurveyFoot},
                                                            {"km", 1000.0},
                                                            {"kilometre", 1000.0},
                                                            {"kilometer", 1000.0},
                                                            {"kilometres", 1000.0},
                                                            {"kilometers", 1000.0},
                                                            {"dm", 0.1},
                                                            {"decimetre", 0.1},
                                                            {"decimeter", 0.1},
                                                            {"decimetres", 0.1},
                                                            {"decimeters", 0.1},
                                                            {"cm", 0.01},
                                                            {"centimetre", 0.01},
                                                            {"centimeter", 0.01},
                                                            {"centimetres", 0.01},
                                                            {"centimeters", 0.01},
                                                            {"mm", 0.001},
                                                            {"millimetre", 0.001},
                                                            {"millimeter", 0.001}};
  for (const auto& [name, metres] : kUnits)
    if (unit == name) return metres;
  return std::nullopt;
}

Result<void> check_scale(const HeightEncoding& encoding, const std::string& file) {
  if (std::isfinite(encoding.scale) && encoding.scale != 0.0 && std::isfinite(encoding.offset_m)) return {};
  return fail(
      ErrorCode::kUnreadableRaster,
      fmt::format("{} has heights of {} * stored + {}, which are none. Convert it with: gdal_translate "
                  "-a_scale 1 -a_offset 0 {} {}, with the true scale and offset.",
                  file, encoding.scale, encoding.offset_m, shell_word(file),
                  shell_word(converted_name(file))));
}

bool read_heights(GDALRasterBand& band, const HeightEncoding& encoding, const CellWindow& window,
                  float* heights, std::uint8_t* valid) {
  const std::size_t cells = static_cast<std::size_t>(window.rows) * static_cast<std::size_t>(window.columns);
  std::vector<double> stored(cells);
  if (band.RasterIO(GF_Read, window.column, window.row, window.columns, window.rows, stored.data(),
                    window.columns, window.rows, GDT_Float64, 0, 0, nullptr) != CE_None) {
    return false;
  }
  std::fill_n(valid, cells, std::uint8_t{1});
  if (encoding.has_mask &&
      band.GetMaskBand()->RasterIO(GF_Read, window.column, window.row, window.columns, window.rows, valid,
                                   window.columns, window.rows, GDT_Byte, 0, 0, nullptr) != CE_None) {
    return false;
  }
  if (encoding.alpha_band > 0 && !mask_transparent(band, encoding.alpha_band, window, valid)) return false;
  if (encoding.is_sparse) mask_missing_blocks(band, window, valid);
  for (std::size_t i = 0; i < cells; ++i) {
    const auto height = static_cast<float>(encoding.scale * stored[i] + encoding.offset_m);
    valid[i] = valid[i] != 0 && encoding.is_height(stored[i]) && std::isfinite(height) ? 1 : 0;
    heights[i] = valid[i] != 0 ? height : 0.0F;
  }
  return true;
}

}  // namespace slipway::dem
