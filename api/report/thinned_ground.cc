#include "api/report/thinned_ground.h"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

namespace slipway::api {
namespace {

dem::GridGeometry every(const dem::GridGeometry& geometry, int step) {
  dem::GridGeometry thin = geometry;
  thin.rows = geometry.rows / step;
  thin.columns = geometry.columns / step;
  thin.cell_x_m *= step;
  thin.cell_y_m *= step;
  return thin;
}

}  // namespace

Result<GroundWindow> thinned_for_picture(const GroundWindow& ground) {
  const dem::GridGeometry& all = ground.terrain->geometry();
  int step = 1;
  while (static_cast<long long>(all.rows / step) * (all.columns / step) > kMaxPictureCells) ++step;
  if (step == 1) return ground;
  const dem::GridGeometry thin = every(all, step);
  std::vector<float> heights;
  std::vector<std::uint8_t> valid;
  for (int row = 0; row < thin.rows; ++row) {
    // The middle one of the cells that it stands for. Rows are read by themselves: none of the others is
    // kept.
    const auto line = ground.terrain->part({row * step + step / 2, 0, 1, all.columns});
    if (!line) return fail(ErrorCode::kUnreadableRaster, "the terrain can't be read for a picture");
    for (int column = 0; column < thin.columns; ++column) {
      const auto height = line->height_m(dem::Cell{0, column * step + step / 2});
      heights.push_back(static_cast<float>(height.value_or(0.0)));
      valid.push_back(height ? 1 : 0);
    }
  }
  GroundWindow picture{std::make_shared<const dem::Terrain>(thin, std::move(heights), std::move(valid)),
                       ground.soil_map};
  if (!ground.soil_map || ground.soil_map->soils().empty()) return picture;
  std::vector<std::int16_t> classes;
  std::vector<std::uint8_t> known;
  for (int row = 0; row < thin.rows; ++row) {
    for (int column = 0; column < thin.columns; ++column) {
      const Eigen::Vector2d centre = thin.centre_m({row, column});
      const std::optional<int> value = ground.soil_map->class_at(centre.x(), centre.y());
      classes.push_back(static_cast<std::int16_t>(value.value_or(0)));
      known.push_back(value ? 1 : 0);
    }
  }
  picture.soil_map = std::make_shared<const dem::SoilMap>(thin, std::move(classes), std::move(known),
                                                          ground.soil_map->legend());
  return picture;
}

}  // namespace slipway::api
