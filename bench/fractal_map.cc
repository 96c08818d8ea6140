// Writes a fractal map as a tiled GeoTIFF of Float32 heights, of any size in little memory, for plans over
// kilometres. Usage: fractal_map OUT.tif [side=16384] [cell_m=1] [seed=1] [slope_deg=8] [wall]
// "wall": a wall from edge to edge in the middle, whose only gap of 6 cells is at 95 % of its length.
//
// Heights are the sum of octaves of gradient noise whose slopes fall slowly with wavelength (a Hurst exponent
// of 0.85), scaled to this slope as the root mean square.

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

#include "core/parallel_for.h"
#include "core/random.h"

namespace {

constexpr int kTile = 256;

// Gradient noise of unit lattice; its slope has about the root mean square 1.
double noise(std::uint64_t key, double x, double y) {
  const double fx = std::floor(x), fy = std::floor(y);
  const double u = x - fx, v = y - fy;
  const auto corner = [&](int dx, int dy) {
    const std::uint64_t bits = slipway::random_bits(
        key, static_cast<std::uint64_t>(static_cast<std::uint32_t>(static_cast<std::int64_t>(fx) + dx))
                     << 32U |
                 static_cast<std::uint32_t>(static_cast<std::int64_t>(fy) + dy));
    const double gx = static_cast<double>(bits >> 40U) / (1 << 23) - 1.0;
    const double gy = static_cast<double>((bits >> 16U) & 0xffffffU) / (1 << 23) - 1.0;
    return gx * (u - dx) + gy * (v - dy);
  };
  const auto fade = [](double t) { return t * t * t * (t * (6.0 * t - 15.0) + 10.0); };
  const double s = fade(u), t = fade(v);
  const double south = corner(0, 0) + s * (corner(1, 0) - corner(0, 0));
  const double north = corner(0, 1) + s * (corner(1, 1) - corner(0, 1));
  return south + t * (north - south);
}

struct Fractal {
  double side_m, slope;
  std::uint64_t seed;

  double height(double x, double y) const {
    double sum = 0.0, squares = 0.0;
    int octave = 0;
    for (double wave = 4096.0; wave >= 8.0; wave *= 0.5, ++octave) {
      const double rough = std::pow(wave / 4096.0, -0.15);  // slope of the octave
      squares += rough * rough;
      sum += rough * wave *
             noise(slipway::random_key(seed, static_cast<std::uint64_t>(octave)), x / wave, y / wave);
    }
    return 1.35 * slope * sum / std::sqrt(squares);
  }
};

template <class T>
void put(std::vector<char>& out, T value) {
  const auto* bytes = reinterpret_cast<const char*>(&value);
  out.insert(out.end(), bytes, bytes + sizeof(T));
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) return std::puts("fractal_map OUT.tif [side] [cell_m] [seed] [slope_deg] [wall]"), 2;
  const int side = argc > 2 ? std::atoi(argv[2]) : 16384;
  const double cell = argc > 3 ? std::atof(argv[3]) : 1.0;
  const std::uint64_t seed = argc > 4 ? std::strtoull(argv[4], nullptr, 10) : 1;
  const double slope = std::tan((argc > 5 ? std::atof(argv[5]) : 8.0) * 3.14159265358979 / 180.0);
  const bool wall = argc > 6 && std::string(argv[6]) == "wall";
  const Fractal fractal{side * cell, slope, seed};
  const int tiles = (side + kTile - 1) / kTile;

  struct Tag {
    std::uint16_t tag, type;
    std::uint32_t count, value;
  };
  const auto count = static_cast<std::uint32_t>(tiles * tiles);
  const std::uint32_t data = 8 + 2 + 16 * 12 + 4;
  const std::array<double, 3> scale{cell, cell, 0.0};
  // UTM 31 N, about its central meridian.
  const std::array<double, 6> tie{0, 0, 0, 500000.0 - 0.5 * side * cell, 4000000.0, 0};
  const std::array<std::uint16_t, 16> keys{1, 1, 0, 3, 1024, 0, 1, 1, 1025, 0, 1, 1, 3072, 0, 1, 32631};
  const std::uint32_t scale_at = data, tie_at = scale_at + 24, keys_at = tie_at + 48,
                      offsets_at = keys_at + 32;
  const std::uint32_t counts_at = offsets_at + 4 * count,
                      first = (counts_at + 4 * count + 4095) / 4096 * 4096;
  const std::uint32_t tile_bytes = kTile * kTile * 4;
  std::vector<char> head;
  put<std::uint16_t>(head, 0x4949);
  put<std::uint16_t>(head, 42);
  put<std::uint32_t>(head, 8);
  const auto width = static_cast<std::uint32_t>(side);
  const std::vector<Tag> tags{{256, 4, 1, width},
                              {257, 4, 1, width},
                              {258, 3, 1, 32},
                              {259, 3, 1, 1},
                              {262, 3, 1, 1},
                              {277, 3, 1, 1},
                              {284, 3, 1, 1},
                              {322, 3, 1, kTile},
                              {323, 3, 1, kTile},
                              {324, 4, count, offsets_at},
                              {325, 4, count, counts_at},
                              {339, 3, 1, 3},
                              {33550, 12, 3, scale_at},
                              {33922, 12, 6, tie_at},
                              {34735, 3, 16, keys_at}};
  put<std::uint16_t>(head, static_cast<std::uint16_t>(tags.size()));
  for (const Tag& tag : tags) {
    put(head, tag.tag);
    put(head, tag.type);
    put(head, tag.count);
    // One tile: its offset and count stand in the tag itself.
    put(head, count == 1 && tag.tag == 324 ? first : count == 1 && tag.tag == 325 ? tile_bytes : tag.value);
  }
  put<std::uint32_t>(head, 0);
  head.resize(data);
  for (const double v : scale) put(head, v);
  for (const double v : tie) put(head, v);
  for (const std::uint16_t v : keys) put(head, v);
  for (std::uint32_t k = 0; k < count; ++k) put(head, first + k * tile_bytes);
  for (std::uint32_t k = 0; k < count; ++k) put(head, tile_bytes);
  head.resize(first);
  std::ofstream out(argv[1], std::ios::binary);
  out.write(head.data(), static_cast<std::streamsize>(head.size()));

  std::vector<float> row_of_tiles(static_cast<std::size_t>(tiles) * kTile * kTile);
  for (int tile_row = 0; tile_row < tiles; ++tile_row) {
    slipway::parallel_for(static_cast<std::size_t>(tiles), 0, [&](std::size_t tile_column) {
      float* const to = &row_of_tiles[tile_column * kTile * kTile];
      for (int r = 0; r < kTile; ++r) {
        for (int c = 0; c < kTile; ++c) {
          const int row = tile_row * kTile + r, column = static_cast<int>(tile_column) * kTile + c;
          double height = fractal.height((column + 0.5) * cell, (row + 0.5) * cell);
          const int gap = static_cast<int>(0.95 * side);
          if (wall && std::abs(column - side / 2) < 2 && (row < gap || row >= gap + 6)) height += 30.0;
          to[r * kTile + c] = static_cast<float>(height);
        }
      }
    });
    out.write(reinterpret_cast<const char*>(row_of_tiles.data()),
              static_cast<std::streamsize>(row_of_tiles.size() * sizeof(float)));
  }
  return out.good() ? 0 : 1;
}
