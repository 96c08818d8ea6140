#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/result.h"

namespace slipway::dem {

using Rgba = std::array<std::uint8_t, 4>;  // red, green, blue, opacity
inline constexpr Rgba kTransparent{0, 0, 0, 0};

// A picture in colours, row by row from the top.
struct RgbaImage {
  int rows = 0;
  int columns = 0;
  std::vector<Rgba> pixels;  // rows * columns

  RgbaImage(int rows_, int columns_)
      : rows(rows_),
        columns(columns_),
        pixels(static_cast<std::size_t>(rows_) * static_cast<std::size_t>(columns_), kTransparent) {}
  Rgba& at(int row, int column) {
    return pixels[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
                  static_cast<std::size_t>(column)];
  }
  const Rgba& at(int row, int column) const { return const_cast<RgbaImage*>(this)->at(row, column); }
};

// The picture as a PNG file in memory. Errors: invalid_request where it has no pixels.
Result<std::string> encode_png(const RgbaImage& image);

}  // namespace slipway::dem
