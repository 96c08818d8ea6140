#include "dem/soil_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <stdexcept>
#include <unordered_map>
#include <utility>

#include "dem/soil_legend.h"

namespace slipway::dem {
namespace {

template <class Key>
std::vector<Fault> repeated(const std::vector<SoilClass>& legend, Key SoilClass::*key, const char* name) {
  std::vector<Fault> faults;
  std::map<Key, std::size_t> rows;
  for (std::size_t row = 0; row < legend.size(); ++row) {
    const auto [first, is_new] = rows.emplace(legend[row].*key, row);
    if (is_new) continue;
    faults.push_back({fmt::format("/legend/{}/{}", row, name),
                      fmt::format("{} = {}, is in row {} already", name, legend[row].*key, first->second)});
  }
  return faults;
}

std::string per_cent(double share) {
  const double value = 100.0 * share;
  const bool is_rounded = (value > 0.0 && value < 0.05) || (value < 100.0 && value >= 99.95);
  return is_rounded ? fmt::format("{:.4g} %", value) : fmt::format("{:.1f} %", value);
}

// The first few, and how many more there are.
std::string listed(const std::vector<std::string>& words) {
  constexpr std::size_t kMost = 12;
  std::string text;
  for (std::size_t i = 0; i < std::min(words.size(), kMost); ++i) text += (i == 0 ? "" : ", ") + words[i];
  return words.size() > kMost ? text + fmt::format(" and {} more", words.size() - kMost) : text;
}

}  // namespace

std::vector<Fault> repeated_values(const std::vector<SoilClass>& legend) {
  return repeated(legend, &SoilClass::value, "value");
}

std::vector<Fault> repeated_labels(const std::vector<SoilClass>& legend) {
  return repeated(legend, &SoilClass::label, "label");
}

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

std::vector<std::size_t> SoilMap::cells_of_rows() const {
  std::vector<std::size_t> of_class(std::size_t{1} << 16U), cells;
  for (std::size_t i = 0; i < known_.size(); ++i)
    if (known_[i] != 0) ++of_class[static_cast<std::uint16_t>(classes_[i])];
  for (const SoilClass& row : legend_) cells.push_back(of_class[static_cast<std::uint16_t>(row.value)]);
  return cells;
}

double SoilMap::unknown_fraction() const {
  std::size_t unknown = 0;
  for (std::size_t i = 0; i < known_.size(); ++i) unknown += soil_of(i) < 0 ? 1 : 0;
  return static_cast<double>(unknown) / static_cast<double>(known_.size());
}

SoilCover cover_of(const SoilMap& map, const Extent& ground, const std::string& word) {
  SoilCover cover;
  const double area = (ground.east_m - ground.west_m) * (ground.north_m - ground.south_m);
  const double cell = map.geometry().cell_x_m * map.geometry().cell_y_m;
  const std::vector<std::size_t> cells = map.cells_of_rows();
  std::vector<std::string> absent;
  double covered = 0.0;
  for (std::size_t row = 0; row < cells.size(); ++row) {
    // A map of classes may have cells that are partly beyond the elevation's edge.
    const double share = std::min(static_cast<double>(cells[row]) * cell / area, 1.0);
    covered += share;
    const std::string& label = map.legend()[row].label;
    cover.lines.push_back(fmt::format("{} {} covers {} of the map", word, label, per_cent(share)));
    if (cells[row] == 0) absent.push_back(label);
    if (share > 0.99999)
      cover.warnings.push_back(fmt::format(
          "{} {} covers 100 % of the map: look whether its places are in the system that they are taken for",
          word, label));
  }
  cover.is_empty = covered == 0.0;
  if (cover.is_empty)
    cover.warnings.push_back(fmt::format("the soil map covers 0 % of the map: all of it is unknown ground"));
  else if (!absent.empty())
    cover.warnings.push_back(fmt::format("0 % of the map is covered by {}", listed(absent)));
  if (!cover.is_empty && covered < 0.99995)
    cover.lines.push_back(fmt::format("no {} of the legend covers {} of the map: unknown ground", word,
                                      per_cent(1.0 - covered)));
  return cover;
}

}  // namespace slipway::dem
