#include "dem/import/gdal_impossible_heights.h"

#include <fmt/format.h>

#include "dem/gdal_crs.h"

namespace slipway::dem {
namespace {

// No ground of a planet or moon that rovers drive on is deeper or higher than this over its datum.
constexpr double kDeepest_m = -12'000.0, kHighest_m = 30'000.0;
constexpr double kUsualMark = -9999.0;     // of cells without a height; some files forget to say so
constexpr double kLeastStored = -32768.0;  // of integers that are scaled: the usual mark there

}  // namespace

void ImpossibleHeights::look_at(double height_m, double stored, bool is_scaled) {
  const bool is_mark = stored == (is_scaled ? kLeastStored : kUsualMark);
  if (height_m >= kDeepest_m && height_m <= kHighest_m && !is_mark) return;
  if (cells++ == 0) {
    first_stored = stored;
    are_radii = height_m >= kLeastRadius_m;
  }
}

std::string ImpossibleHeights::fault(const std::string& file, bool has_nodata) const {
  // The figures that tell one float from the next.
  std::string told = fmt::format("{} has {} cells whose height no ground has, the first with {:.9g}.", file,
                                 cells, first_stored);
  if (are_radii)
    told += " If these are distances from the body's centre, make them heights above its ellipsoid first.";
  told += fmt::format(" If that marks a missing height, import it with --nodata {:.9g}", first_stored);
  if (has_nodata) return told + ".";
  return told + fmt::format(", or say so in the file: gdal_translate -a_nodata {:.9g} {} {}.", first_stored,
                            shell_word(file), shell_word(converted_name(file)));
}

}  // namespace slipway::dem
