#pragma once

#include <string>

namespace slipway::dem {

// Cells whose heights no ground has, as where a file does not say what marks a missing height.
struct ImpossibleHeights {
  long long cells = 0;
  double first_stored = 0.0;  // as the file has it, before its scale and offset
  bool are_radii = false;     // so large is the first of them

  void look_at(double height_m, double stored, bool is_scaled);
  // What is wrong, with the command that mends it. has_nodata: the file declares another mark already, which
  // gdal_translate would replace.
  std::string fault(const std::string& file, bool has_nodata) const;
};

constexpr double kLeastRadius_m = 1e6;  // heights as large as this are distances from a body's centre

}  // namespace slipway::dem
