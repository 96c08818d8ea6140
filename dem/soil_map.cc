#include "dem/soil_map.h"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <unordered_map>
#include <utility>

namespace slipway::dem {

SoilMap::SoilMap(GridGeometry geometry, std::vector<std::int16_t> classes, std::vector<std::uint8_t> known,
                 std::vector<SoilClass> legend)
    : geometry_(geometry),
      classes_(std::move(classes)),
      known_(std::move(known)),
      legend_(std::move(legend)) {
  const std::size_t cells = static_cast<std::size_t>(std::max(geometry_.rows, 0)) *
                            static_cast<std::size_t>(std::max(geometry_.columns, 0));
  if (cells == 0 || classes_.size() != cells || known_.size() != cells) {
    throw std::invalid_argument("a soil map has as many classes and mask values as cells, and at least one");
  }
  std::unordered_map<int, std::int16_t> index_of_value;
  for (const SoilClass& row : legend_) {
    if (!row.soil) continue;
    const auto at = std::find(soils_.begin(), soils_.end(), *row.soil);
    index_of_value.emplace(row.value, static_cast<std::int16_t>(at - soils_.begin()));
    if (at == soils_.end()) soils_.push_back(*row.soil);
  }
  soil_of_class_.assign(std::size_t{1} << 16U, -1);
  for (const auto& [value, soil] : index_of_value)
    if (value >= std::numeric_limits<std::int16_t>::min() &&
        value <= std::numeric_limits<std::int16_t>::max())
      soil_of_class_[static_cast<std::uint16_t>(value)] = soil;
}

std::optional<std::size_t> SoilMap::index_at(double x_m, double y_m) const {
  const std::optional<Cell> cell = geometry_.cell_at(x_m, y_m);
  if (!cell) return std::nullopt;
  return static_cast<std::size_t>(cell->row) * static_cast<std::size_t>(geometry_.columns) +
         static_cast<std::size_t>(cell->column);
}

std::optional<int> SoilMap::class_at(double x_m, double y_m) const {
  const std::optional<std::size_t> i = index_at(x_m, y_m);
  if (!i || known_[*i] == 0) return std::nullopt;
  return classes_[*i];
}

std::optional<std::size_t> SoilMap::soil_at(double x_m, double y_m) const {
  const std::optional<std::size_t> i = index_at(x_m, y_m);
  if (!i || soil_of(*i) < 0) return std::nullopt;
  return static_cast<std::size_t>(soil_of(*i));
}

double SoilMap::unknown_fraction() const {
  std::size_t unknown = 0;
  for (std::size_t i = 0; i < known_.size(); ++i) unknown += soil_of(i) < 0 ? 1 : 0;
  return static_cast<double>(unknown) / static_cast<double>(known_.size());
}

}  // namespace slipway::dem
