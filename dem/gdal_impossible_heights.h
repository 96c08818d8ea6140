#pragma once

#include <string>

namespace slipway::dem {

// Cells whose heights no ground has, as where a file does not say what marks a missing height.
struct ImpossibleHeights {
  long long cells = 0;
  double first_stored = 0.0;  // as the file has it, before its scale and offset
  bool are_radii = false;     // so large is the first of them

  void look_at(double height_m, double stored, bool is_scaled);
  // What is wrong, with the command that mends it.
  std::string fault(const std::string& file) const;
};

}  // namespace slipway::dem
