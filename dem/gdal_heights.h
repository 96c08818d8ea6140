#pragma once

#include <gdal_priv.h>

#include <cmath>
#include <cstdint>
#include <optional>
#include <string>

#include "core/result.h"
#include "dem/grid_geometry.h"

namespace slipway::dem {

// Decides which stored values are heights, and converts them into metres.
struct HeightEncoding {
  double scale = 1.0;
  double offset_m = 0.0;
  bool has_nodata = false;
  float nodata = 0.0F;
  double wide_nodata = 0.0;                 // the same before rounding to float
  std::optional<double> other_nodata = {};  // that a person names
  bool is_float32 = false;
  bool has_mask = false;
  int alpha_band = 0;      // where the file has one: cells whose value there is 0 have no height
  bool is_sparse = false;  // the file does not hold all of its blocks

  bool is_height(double stored) const {
    if (!std::isfinite(stored)) return false;
    // -FLT_MAX as a text of 6 to 17 digits, and the special values of ISIS beside it: no height, declared or
    // not.
    constexpr double kBeyondHeights = 1e38;
    if (std::abs(stored) >= kBeyondHeights) return false;
    if (other_nodata && (stored == *other_nodata ||
                         (is_float32 && static_cast<float>(stored) == static_cast<float>(*other_nodata))))
      return false;
    if (!has_nodata) return true;
    // -9999.9 in a header is a double, in a Float32 cell it is the nearest float.
    return is_float32 ? static_cast<float>(stored) != nodata : stored != wide_nodata;
  }
};

// The band that holds opacity, whatever its type; 0 where there is none.
int alpha_band(GDALDataset& dataset);

// How a band stores heights.
HeightEncoding encoding_of(GDALRasterBand& band);

// Scale and offset must make heights of what is stored. Errors: unreadable_raster, with the command that
// converts `file`.
Result<void> check_scale(const HeightEncoding& encoding, const std::string& file);

// Metres of a unit of height, by the names in use; nothing where the name is not known. "" is the metre.
std::optional<double> metres_of_unit(std::string unit);

// Reads the window's heights (m) and which cells have one, rows * columns values each. Blocks that the file
// does not hold have none. False where the file is damaged.
bool read_heights(GDALRasterBand& band, const HeightEncoding& encoding, const CellWindow& window,
                  float* heights, std::uint8_t* valid);

}  // namespace slipway::dem
