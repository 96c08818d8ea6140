#include "api/requests/soil_regions.h"

#include <map>
#include <optional>
#include <utility>

namespace slipway::api {
namespace {

std::vector<std::size_t> regions_at(const std::vector<sim::Disc>& regions, const Eigen::Vector2d& p) {
  std::vector<std::size_t> in;
  for (std::size_t k = 0; k < regions.size(); ++k)
    if (regions[k].holds(p.x(), p.y())) in.push_back(k);
  return in;
}

}  // namespace

std::string RegionalSoil::name() const {
  std::string name = base;
  for (const std::size_t region : regions) name += "@place_" + std::to_string(region + 1);
  return name;
}

RegionalSoils soils_in_regions(const std::shared_ptr<const dem::SoilMap>& map,
                               const std::vector<sim::Disc>& regions, const std::string& unknown_soil) {
  RegionalSoils result;
  for (const std::string& name : map->soils()) result.soils.push_back({name, {}});
  result.map = map;
  if (regions.empty()) return result;

  // Class values are the indices of soils; a cell without a class is unknown ground.
  const dem::GridGeometry& grid = map->geometry();
  std::vector<std::int16_t> classes;
  std::vector<std::uint8_t> known;
  std::map<std::pair<std::optional<std::size_t>, std::vector<std::size_t>>, std::int16_t> index_of;
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      const Eigen::Vector2d centre = grid.centre_m({row, column});
      const std::optional<std::size_t> soil = map->soil_at(centre.x(), centre.y());
      std::vector<std::size_t> in = regions_at(regions, centre);
      known.push_back(soil || !in.empty() ? 1 : 0);
      std::int16_t value = static_cast<std::int16_t>(soil.value_or(0));
      if (!in.empty()) {
        const std::string base = soil ? map->soils()[*soil] : unknown_soil;
        const auto [at, added] =
            index_of.emplace(std::pair{soil, in}, static_cast<std::int16_t>(result.soils.size()));
        if (added) result.soils.push_back({base, std::move(in), soil.has_value()});
        value = at->second;
      }
      classes.push_back(value);
    }
  }
  std::vector<dem::SoilClass> legend;
  for (std::size_t k = 0; k < result.soils.size(); ++k) {
    const std::string name = result.soils[k].name();
    legend.push_back({static_cast<int>(k), name, name});
  }
  result.map =
      std::make_shared<const dem::SoilMap>(grid, std::move(classes), std::move(known), std::move(legend));
  return result;
}

}  // namespace slipway::api
