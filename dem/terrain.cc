#include "dem/terrain.h"

#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "dem/terrain_tiles.h"

namespace slipway::dem {
namespace {

// A point on a centre that was computed in metres misses it by a rounding error. A masked cell of less weight
// than this takes no part, so that a cell beside a gap keeps its own height.
constexpr double kNoWeight = 1e-6;

// The four centres around a point, with weights that sum to one.
struct Blend {
  std::array<Cell, 4> cells;
  std::array<double, 4> weights;
};

std::optional<Blend> blend_at(const GridGeometry& geometry, double x_m, double y_m) {
  if (!geometry.extent().contains(x_m, y_m)) return std::nullopt;
  const Eigen::Vector2d index = geometry.fractional_index(x_m, y_m);
  const double row = std::clamp(index[0], 0.0, geometry.rows - 1.0);
  const double column = std::clamp(index[1], 0.0, geometry.columns - 1.0);
  const int r0 = static_cast<int>(row);
  const int c0 = static_cast<int>(column);
  const int r1 = std::min(r0 + 1, geometry.rows - 1);
  const int c1 = std::min(c0 + 1, geometry.columns - 1);
  const double down = row - r0;
  const double right = column - c0;
  return Blend{{{{r0, c0}, {r0, c1}, {r1, c0}, {r1, c1}}},
               {(1.0 - down) * (1.0 - right), (1.0 - down) * right, down * (1.0 - right), down * right}};
}

SurfacePoint surface_point(double height_m, const Eigen::Vector2d& gradient) {
  return {height_m, Eigen::Vector3d(-gradient.x(), -gradient.y(), 1.0).normalized()};
}

void check_cells(const GridGeometry& geometry) {
  if (geometry.rows < 1 || geometry.columns < 1 || !(geometry.cell_x_m > 0.0) || !(geometry.cell_y_m > 0.0))
    throw std::invalid_argument("a terrain has at least one cell, and cells have a positive size");
}

std::uint64_t hashed(std::uint64_t hash, std::uint64_t word) {
  hash = (hash ^ word) * 0x9e3779b97f4a7c15ULL;
  return hash ^ (hash >> 29);
}

}  // namespace

double SurfacePoint::slope_rad() const {
  return std::atan2(std::hypot(normal.x(), normal.y()), normal.z());
}

double SurfacePoint::aspect_rad() const {
  // The upward normal leans downhill.
  if (normal.x() == 0.0 && normal.y() == 0.0) return 0.0;
  const double clockwise = std::atan2(normal.x(), normal.y());
  const double turned = clockwise < 0.0 ? clockwise + 2.0 * std::numbers::pi : clockwise;
  return turned < 2.0 * std::numbers::pi ? turned : 0.0;
}

Terrain::Terrain(GridGeometry geometry, std::vector<float> heights_m, std::vector<std::uint8_t> valid)
    : geometry_(geometry), held_heights_m_(std::move(heights_m)), held_valid_(std::move(valid)) {
  check_cells(geometry_);
  const std::size_t cells =
      static_cast<std::size_t>(geometry_.rows) * static_cast<std::size_t>(geometry_.columns);
  if (held_heights_m_.size() != cells || held_valid_.size() != cells) {
    throw std::invalid_argument(
        fmt::format("a terrain of {} x {} cells was given {} heights and {} mask values", geometry_.rows,
                    geometry_.columns, held_heights_m_.size(), held_valid_.size()));
  }
  heights_m_ = held_heights_m_.data();
  valid_ = held_valid_.data();
  for (std::size_t i = 0; i < cells; ++i) {
    if (valid_[i] != 0 && !std::isfinite(heights_m_[i])) {
      throw std::invalid_argument("a cell that is not masked has a height that is not finite");
    }
    whole_ = whole_ && valid_[i] != 0;
  }
}

Terrain::Terrain(GridGeometry geometry, std::shared_ptr<const CellReader> cells) : geometry_(geometry) {
  check_cells(geometry_);
  tiles_ = std::make_unique<TerrainTiles>(geometry_, std::move(cells));
  heights_m_ = tiles_->heights_m();
  valid_ = tiles_->valid();
  whole_ = false;  // nobody knows
}

Terrain::~Terrain() = default;

std::optional<Error> Terrain::damage() const {
  return tiles_ ? tiles_->damage() : std::nullopt;
}

std::shared_ptr<const Terrain> Terrain::part(const CellWindow& window) const {
  const auto cells = static_cast<std::size_t>(window.rows) * static_cast<std::size_t>(window.columns);
  std::vector<float> heights(cells);
  std::vector<std::uint8_t> valid(cells);
  if (tiles_) {
    if (!tiles_->read_part(window, heights.data(), valid.data())) return nullptr;
  } else {
    for (int row = 0; row < window.rows; ++row) {
      const std::size_t from = index_of({window.row + row, window.column});
      const std::size_t to = static_cast<std::size_t>(row) * static_cast<std::size_t>(window.columns);
      std::copy_n(heights_m_ + from, window.columns, heights.data() + to);
      std::copy_n(valid_ + from, window.columns, valid.data() + to);
    }
  }
  return std::make_shared<const Terrain>(geometry_.sub(window), std::move(heights), std::move(valid));
}

const float* Terrain::heights_in(const CellWindow& window) const {
  const int last_row = window.row + window.rows - 1, last_column = window.column + window.columns - 1;
  if (window.row < 0 || window.column < 0 || last_row >= geometry_.rows || last_column >= geometry_.columns)
    return nullptr;
  const float* const first = heights_m_ + index_of({window.row, window.column});
  if (whole_ || (tiles_ && tiles_->need(window.row, window.column, last_row, last_column))) return first;
  for (int row = window.row; row <= last_row; ++row) {
    const std::uint8_t* const valid = valid_ + index_of({row, window.column});
    if (std::find(valid, valid + window.columns, std::uint8_t{0}) != valid + window.columns) return nullptr;
  }
  return first;
}

void Terrain::need(int row, int column) const {
  if (tiles_) tiles_->need(row, column, row, column);
}

bool Terrain::whole_around(int row, int column) const {
  return whole_ || (tiles_ && tiles_->need(row - 1, column - 1, row + 2, column + 2));
}

bool Terrain::has_data(const Cell& cell) const {
  if (cell.row < 0 || cell.row >= geometry_.rows || cell.column < 0 || cell.column >= geometry_.columns)
    return false;
  need(cell.row, cell.column);
  return valid_[index_of(cell)] != 0;
}

std::size_t Terrain::index_of(const Cell& cell) const {
  return static_cast<std::size_t>(cell.row) * static_cast<std::size_t>(geometry_.columns) +
         static_cast<std::size_t>(cell.column);
}

std::optional<double> Terrain::height_m(const Cell& cell) const {
  if (!has_data(cell)) return std::nullopt;
  return heights_m_[index_of(cell)];
}

std::optional<double> Terrain::height_m(double x_m, double y_m) const {
  const std::optional<Blend> blend = blend_at(geometry_, x_m, y_m);
  if (!blend) return std::nullopt;
  double sum = 0.0;
  double weight = 0.0;
  for (std::size_t k = 0; k < 4; ++k) {
    need(blend->cells[k].row, blend->cells[k].column);
    const std::size_t i = index_of(blend->cells[k]);
    if (valid_[i] != 0) {
      sum += blend->weights[k] * heights_m_[i];
      weight += blend->weights[k];
    } else if (blend->weights[k] > kNoWeight) {
      return std::nullopt;
    }
  }
  return sum / weight;
}

std::optional<Eigen::Vector2d> Terrain::gradient_at(const Cell& cell) const {
  const std::optional<double> here = height_m(cell);
  if (!here) return std::nullopt;
  const auto along = [&](const Cell& before, const Cell& after, double step_m) -> std::optional<double> {
    const std::optional<double> low = height_m(before);
    const std::optional<double> high = height_m(after);
    if (low && high) return (*high - *low) / (2.0 * step_m);
    if (high) return (*high - *here) / step_m;
    if (low) return (*here - *low) / step_m;
    return std::nullopt;
  };
  const auto east = along({cell.row, cell.column - 1}, {cell.row, cell.column + 1}, geometry_.cell_x_m);
  const auto north = along({cell.row + 1, cell.column}, {cell.row - 1, cell.column}, geometry_.cell_y_m);
  if (!east || !north) return std::nullopt;
  return Eigen::Vector2d(*east, *north);
}

std::optional<SurfacePoint> Terrain::surface(const Cell& cell) const {
  const std::optional<Eigen::Vector2d> gradient = gradient_at(cell);
  if (!gradient) return std::nullopt;
  return surface_point(heights_m_[index_of(cell)], *gradient);
}

// The same numbers as below, to the last bit, where no neighbour of the four centres is masked or outside.
SurfacePoint Terrain::surface_inside(int row, int column, double down, double right) const {
  const std::array<double, 4> weights{(1.0 - down) * (1.0 - right), (1.0 - down) * right,
                                      down * (1.0 - right), down * right};
  const std::ptrdiff_t columns = geometry_.columns;
  const float* here = &heights_m_[index_of({row, column})];
  double height = 0.0, weight = 0.0;
  Eigen::Vector2d gradient = Eigen::Vector2d::Zero();
  for (int k = 0; k < 4; ++k) {
    const float* corner = here + (k & 1) + (k >> 1) * columns;
    const Eigen::Vector2d slope(
        (static_cast<double>(corner[1]) - static_cast<double>(corner[-1])) / (2.0 * geometry_.cell_x_m),
        (static_cast<double>(corner[-columns]) - static_cast<double>(corner[columns])) /
            (2.0 * geometry_.cell_y_m));
    height += weights[k] * corner[0];
    gradient += weights[k] * slope;
    weight += weights[k];
  }
  return surface_point(height / weight, gradient / weight);
}

std::optional<SurfacePoint> Terrain::surface(double x_m, double y_m) const {
  if (whole_ || tiles_) {
    const Eigen::Vector2d index = geometry_.fractional_index(x_m, y_m);
    const double row = std::floor(index[0]), column = std::floor(index[1]);
    if (row >= 1.0 && column >= 1.0 && row <= geometry_.rows - 3.0 && column <= geometry_.columns - 3.0 &&
        whole_around(static_cast<int>(row), static_cast<int>(column)))
      return surface_inside(static_cast<int>(row), static_cast<int>(column), index[0] - row,
                            index[1] - column);
  }
  const std::optional<Blend> blend = blend_at(geometry_, x_m, y_m);
  if (!blend) return std::nullopt;
  double height = 0.0;
  Eigen::Vector2d gradient = Eigen::Vector2d::Zero();
  double weight = 0.0;
  for (std::size_t k = 0; k < 4; ++k) {
    const std::optional<Eigen::Vector2d> corner = gradient_at(blend->cells[k]);
    if (corner) {
      height += blend->weights[k] * heights_m_[index_of(blend->cells[k])];
      gradient += blend->weights[k] * *corner;
      weight += blend->weights[k];
    } else if (blend->weights[k] > kNoWeight) {
      return std::nullopt;
    }
  }
  return surface_point(height / weight, gradient / weight);
}

std::optional<double> Terrain::roughness_m(double x_m, double y_m, double radius_m) const {
  const auto window = geometry_.window({.west_m = x_m - radius_m,
                                        .south_m = y_m - radius_m,
                                        .east_m = x_m + radius_m,
                                        .north_m = y_m + radius_m});
  if (!window) return std::nullopt;
  // Relative to the point asked for: map coordinates of 8e6 m squared would eat the digits of the heights.
  std::vector<Eigen::Vector3d> centres;
  for (int row = window->row; row < window->row + window->rows; ++row) {
    for (int column = window->column; column < window->column + window->columns; ++column) {
      const Eigen::Vector2d offset = geometry_.centre_m({row, column}) - Eigen::Vector2d(x_m, y_m);
      const std::optional<double> height = height_m(Cell{row, column});
      if (height && offset.norm() <= radius_m) centres.emplace_back(offset.x(), offset.y(), *height);
    }
  }
  if (centres.size() < 4) return std::nullopt;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& p : centres) mean += p / static_cast<double>(centres.size());
  Eigen::Matrix2d normal_matrix = Eigen::Matrix2d::Zero();
  Eigen::Vector2d right_side = Eigen::Vector2d::Zero();
  for (const Eigen::Vector3d& p : centres) {
    const Eigen::Vector3d d = p - mean;
    normal_matrix += d.head<2>() * d.head<2>().transpose();
    right_side += d.head<2>() * d.z();
  }
  // Rank-revealing: centres in one line leave the slope across it free, and the least one is taken.
  const Eigen::Vector2d gradient = normal_matrix.completeOrthogonalDecomposition().solve(right_side);
  double squares = 0.0;
  for (const Eigen::Vector3d& p : centres) {
    const Eigen::Vector3d d = p - mean;
    const double above = d.z() - gradient.dot(d.head<2>());
    squares += above * above;
  }
  // From the vertical residual to the distance from the plane.
  return std::sqrt(squares / static_cast<double>(centres.size()) / (1.0 + gradient.squaredNorm()));
}

std::string Terrain::fingerprint() const {
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  hash = hashed(hash, static_cast<std::uint64_t>(geometry_.rows));
  hash = hashed(hash, static_cast<std::uint64_t>(geometry_.columns));
  for (const double edge : {geometry_.west_m, geometry_.north_m, geometry_.cell_x_m, geometry_.cell_y_m}) {
    hash = hashed(hash, std::bit_cast<std::uint64_t>(edge));
  }
  constexpr std::uint64_t kMasked = 1ULL << 32;  // no float's bits
  const std::vector<CellWindow> windows =
      tiles_ ? tiles_->read_tiles() : std::vector<CellWindow>{{0, 0, geometry_.rows, geometry_.columns}};
  for (const CellWindow& window : windows) {
    if (tiles_) hash = hashed(hash, index_of({window.row, window.column}));
    for (int row = window.row; row < window.row + window.rows; ++row) {
      const std::size_t first = index_of({row, window.column});
      for (std::size_t i = first; i < first + static_cast<std::size_t>(window.columns); ++i)
        hash = hashed(hash, valid_[i] != 0 ? std::bit_cast<std::uint32_t>(heights_m_[i]) : kMasked);
    }
  }
  return fmt::format("{:016x}", hash);
}

}  // namespace slipway::dem
