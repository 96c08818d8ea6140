#include "dem/soil_legend.h"

#include <fmt/format.h>

#include <map>

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

}  // namespace

std::vector<Fault> repeated_values(const std::vector<SoilClass>& legend) {
  return repeated(legend, &SoilClass::value, "value");
}

std::vector<Fault> repeated_labels(const std::vector<SoilClass>& legend) {
  return repeated(legend, &SoilClass::label, "label");
}

}  // namespace slipway::dem
