#include "api/terrain_views/terrain_profile.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "api/json/writer.h"
#include "core/angle.h"

namespace slipway::api {
namespace {

constexpr double kMostCells = 4'000'000;  // that are in memory at once

std::vector<ProfilePoint> places_along(const std::vector<Eigen::Vector2d>& corners, std::size_t points) {
  std::vector<double> at{0.0};
  for (std::size_t i = 1; i < corners.size(); ++i)
    at.push_back(at.back() + (corners[i] - corners[i - 1]).norm());
  std::vector<ProfilePoint> places;
  std::size_t leg = 1;
  for (std::size_t k = 0; k < points; ++k) {
    const double distance = at.back() * static_cast<double>(k) / static_cast<double>(points - 1);
    while (leg + 1 < corners.size() && at[leg] < distance) ++leg;
    const double length = at[leg] - at[leg - 1];
    const double share = length > 0.0 ? std::clamp((distance - at[leg - 1]) / length, 0.0, 1.0) : 0.0;
    const Eigen::Vector2d place = corners[leg - 1] + share * (corners[leg] - corners[leg - 1]);
    places.push_back({distance, place.x(), place.y(), {}, {}, {}, {}});
  }
  return places;
}

dem::Extent with(const dem::Extent& extent, const ProfilePoint& place) {
  return {std::min(extent.west_m, place.x_m), std::min(extent.south_m, place.y_m),
          std::max(extent.east_m, place.x_m), std::max(extent.north_m, place.y_m)};
}

Result<void> look(const TerrainSite& site, const Legend& legend, const dem::Extent& extent,
                  std::span<ProfilePoint> places) {
  const auto ground = site.read(extent, legend);
  if (!ground) return fail(ground.error());
  for (ProfilePoint& place : places) {
    if (const auto surface = ground->terrain->surface(place.x_m, place.y_m)) {
      place.height_m = surface->height_m;
      place.slope_rad = surface->slope_rad();
    }
    if (const auto mapped = ground->soil_map->class_at(place.x_m, place.y_m))
      for (const dem::SoilClass& each : ground->soil_map->legend())
        if (each.value == *mapped) place.label = each.label;
    if (const auto soil = ground->soil_map->soil_at(place.x_m, place.y_m))
      place.soil = ground->soil_map->soils()[*soil];
  }
  return {};
}

template <class Write>
void column(json::Writer& w, std::string_view key, const std::vector<ProfilePoint>& points,
            const Write& write) {
  w.key(key).begin_array();
  for (const ProfilePoint& point : points) write(point);
  w.end_array();
}

}  // namespace

Result<std::vector<ProfilePoint>> ground_along(const TerrainSite& site,
                                               const std::vector<Eigen::Vector2d>& corners,
                                               std::size_t points, const std::string& legend_name) {
  const Legend* const legend = site.description().legend(legend_name);
  if (legend == nullptr)
    return fail(ErrorCode::kNotFound, fmt::format("the terrain has no legend of the name {}", legend_name));
  std::vector<ProfilePoint> places = places_along(corners, points);
  const dem::GridGeometry& geometry = site.info().geometry;
  const dem::Extent map = geometry.extent();
  const auto is_small = [&](const dem::Extent& e) {
    return (e.east_m - e.west_m) / geometry.cell_x_m * (e.north_m - e.south_m) / geometry.cell_y_m <=
           kMostCells;
  };
  // Stretch by stretch, each with a window of its own.
  for (std::size_t first = 0; first < places.size();) {
    if (!map.contains(places[first].x_m, places[first].y_m)) {
      ++first;
      continue;
    }
    dem::Extent extent{places[first].x_m, places[first].y_m, places[first].x_m, places[first].y_m};
    std::size_t end = first + 1;
    while (end < places.size() && map.contains(places[end].x_m, places[end].y_m) &&
           is_small(with(extent, places[end])))
      extent = with(extent, places[end++]);
    if (const auto looked = look(site, *legend, extent, std::span(places).subspan(first, end - first));
        !looked)
      return fail(looked.error());
    first = end;
  }
  return places;
}

std::string write_profile(const TerrainSite& site, const std::string& legend,
                          const std::vector<ProfilePoint>& points) {
  json::Writer w;
  w.begin_object().text("terrain", site.description().name);
  w.text("legend", site.description().legend(legend)->name);
  w.whole("count", static_cast<std::int64_t>(points.size()));
  const auto text = [&](const std::optional<std::string>& value) {
    if (value) {
      w.text(*value);
    } else {
      w.null();
    }
  };
  column(w, "distance_m", points, [&](const ProfilePoint& p) { w.metres(p.distance_m); });
  column(w, "x_m", points, [&](const ProfilePoint& p) { w.metres(p.x_m); });
  column(w, "y_m", points, [&](const ProfilePoint& p) { w.metres(p.y_m); });
  column(w, "height_m", points, [&](const ProfilePoint& p) {
    if (p.height_m) {
      w.metres(*p.height_m);
    } else {
      w.null();
    }
  });
  column(w, "slope_deg", points, [&](const ProfilePoint& p) {
    if (p.slope_rad) {
      w.significant(deg_from_rad(*p.slope_rad));
    } else {
      w.null();
    }
  });
  column(w, "label", points, [&](const ProfilePoint& p) { text(p.label); });
  column(w, "soil", points, [&](const ProfilePoint& p) { text(p.soil); });
  w.end_object();
  return w.take();
}

}  // namespace slipway::api
