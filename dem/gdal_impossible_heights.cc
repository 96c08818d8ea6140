#include "dem/gdal_impossible_heights.h"

#include <fmt/format.h>

#include "dem/gdal_crs.h"

namespace slipway::dem {
namespace {

// No ground of a planet or moon that rovers drive on is deeper or higher than this over its datum.
constexpr double kDeepest_m = -12'000.0, kHighest_m = 30'000.0;
constexpr float kUsualMark = -9999.0F;  // of cells without a height; some files forget to say so
constexpr float kLeastRadius_m = 1e6F;  // heights as large as this are distances from a body's centre

}  // namespace

void ImpossibleHeights::look_at(double height_m, float value) {
  if (height_m >= kDeepest_m && height_m <= kHighest_m && value != kUsualMark) return;
  if (cells++ == 0) first = value;
}

std::string ImpossibleHeights::fault(const std::string& file) const {
  const std::string mended = converted_name(file);
  const std::string radius =
      first < kLeastRadius_m
          ? ""
          : fmt::format(
                " If these are distances from the body's centre, take the radius of the map's sphere off "
                "them "
                "instead: gdal_calc.py -A {} --calc='A.astype(float)-RADIUS' --type=Float32 --outfile={}",
                file, mended);
  return fmt::format(
      "{} has {} cells whose height no ground has, the first with {:g}. If that marks a missing height, say "
      "so "
      "in the file: gdal_translate -a_nodata {:g} {} {}.{}",
      file, cells, first, first, file, mended, radius);
}

}  // namespace slipway::dem
