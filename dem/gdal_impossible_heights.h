#pragma once

#include <string>

namespace slipway::dem {

// Cells whose heights no ground has, as where a file does not say what marks a missing height.
struct ImpossibleHeights {
  long long cells = 0;
  float first = 0.0F;  // as the file has it

  // `value`: what the file has for this height.
  void look_at(double height_m, float value);
  // What is wrong, with the command that mends it.
  std::string fault(const std::string& file) const;
};

}  // namespace slipway::dem
