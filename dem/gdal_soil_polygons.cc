#include <fmt/format.h>
#include <gdal_alg.h>
#include <gdal_priv.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>

#include "dem/body_degrees.h"
#include "dem/gdal_crs.h"
#include "dem/gdal_soil_units.h"
#include "dem/soil_legend.h"
#include "dem/soil_map.h"

namespace slipway::dem {
namespace {

// Brings one place of a unit to the map.
class PlaceOnMap {
 public:
  PlaceOnMap(const SoilUnits& units, const ElevationInfo& ground)
      : map_(ground.crs_wkt, ground.body, ground.geometry.extent()) {
    if (!units.crs) return;
    if (ground.body == "Earth") {
      OGRSpatialReference to;
      if (to.importFromWkt(ground.crs_wkt.c_str()) != OGRERR_NONE) return;
      to.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
      between_.reset(OGRCreateCoordinateTransformation(units.crs.get(), &to));
    } else if (units.places == UnitPlaces::kOwnSystem) {
      ElevationInfo own;
      describe_crs(*units.crs, own);
      own_.emplace(own.crs_wkt, own.body);
    }
  }

  bool usable() const { return map_.usable() && (!own_ || own_->usable()); }
  // Metres of x of 360 deg, where edges that are straight in degrees are straight on the map, too.
  std::optional<double> turn_m() const { return map_.turn_m(); }
  // Where the units are: degrees, or what goes straight to the map.
  bool is_direct() const { return between_ != nullptr; }

  std::optional<MapPlace> degrees(const MapPlace& place) const {
    return own_ ? own_->to_degrees(place) : place;
  }
  std::optional<MapPlace> map(const MapPlace& place) const {
    if (!between_) return map_.to_map(place);
    MapPlace to = place;
    if (between_->Transform(1, &to.x, &to.y) == FALSE || !std::isfinite(to.x) || !std::isfinite(to.y))
      return std::nullopt;
    return to;
  }

 private:
  BodyDegrees map_;
  std::optional<BodyDegrees> own_;
  std::unique_ptr<OGRCoordinateTransformation> between_;  // on the Earth, whose datums differ
};

// Makes longitudes go on from place to place where a ring goes over the antimeridian; true where it does.
bool unroll(OGRLinearRing& ring) {
  bool unrolled = false;
  double turned = 0.0;
  for (int i = 1; i < ring.getNumPoints(); ++i) {
    const double step = ring.getX(i) + turned - ring.getX(i - 1);
    // A step all the way round is the edge of a map of the whole body.
    if (std::abs(step) > 180.0 && std::abs(step) < 359.999) {
      turned += step > 0.0 ? -360.0 : 360.0;
      unrolled = true;
    }
    ring.setPoint(i, ring.getX(i) + turned, ring.getY(i));
  }
  return unrolled;
}

// False where the map can't show a place of the ring.
bool move_ring(OGRLinearRing& ring, const PlaceOnMap& places, bool& unrolled) {
  for (int i = 0; i < ring.getNumPoints(); ++i) {
    const auto degrees = places.degrees({ring.getX(i), ring.getY(i)});
    if (!degrees) return false;
    ring.setPoint(i, degrees->x, degrees->y);
  }
  const auto turn = places.turn_m();
  if (!places.is_direct()) {
    constexpr double kStraight_deg = 0.1;
    unrolled = unroll(ring) || unrolled;
    if (!turn) ring.segmentize(kStraight_deg);
  }
  double longitude = 0.0;
  for (int i = 0; i < ring.getNumPoints(); ++i) {
    auto place = places.map({ring.getX(i), ring.getY(i)});
    if (!place) return false;
    if (turn && !places.is_direct() && i > 0) {
      const double expected = ring.getX(i - 1) + (ring.getX(i) - longitude) / 360.0 * *turn;
      place->x += std::round((expected - place->x) / *turn) * *turn;
    }
    longitude = ring.getX(i);
    ring.setPoint(i, place->x, place->y);
  }
  return true;
}

template <class Visit>
bool each_ring(OGRGeometry& geometry, const Visit& visit) {
  if (geometry.getGeometryType() == wkbMultiPolygon) {
    for (OGRPolygon* const polygon : *geometry.toMultiPolygon())
      if (!each_ring(*polygon, visit)) return false;
    return true;
  }
  for (OGRLinearRing* const ring : *geometry.toPolygon())
    if (!visit(*ring)) return false;
  return true;
}

// A polygon is on the map wherever it is a whole number of turns away: its copies there.
void add_copies(std::vector<LabelledPolygon>& polygons, LabelledPolygon polygon, double turn,
                const Extent& map) {
  OGREnvelope box;
  polygon.geometry->getEnvelope(&box);
  for (double k = std::ceil((map.west_m - box.MaxX) / turn); k <= std::floor((map.east_m - box.MinX) / turn);
       ++k) {
    LabelledPolygon& copy = polygons.emplace_back();
    copy.label = polygon.label;
    copy.pointer = polygon.pointer;
    copy.geometry.reset(polygon.geometry->clone());
    each_ring(*copy.geometry, [&](OGRLinearRing& ring) {
      for (int i = 0; i < ring.getNumPoints(); ++i) ring.setPoint(i, ring.getX(i) + k * turn, ring.getY(i));
      return true;
    });
  }
}

// That the units' system is one of the map's body. A label of the Earth is what every tool writes for lack of
// a better one, and says nothing.
Result<void> check_body(SoilUnits& units, const ElevationInfo& ground, const std::string& file) {
  if (!units.crs) return {};
  ElevationInfo own;
  describe_crs(*units.crs, own);
  if (own.body == ground.body &&
      (own.body != "other" ||
       std::abs(own.semi_major_axis_m - ground.semi_major_axis_m) < 0.01 * ground.semi_major_axis_m))
    return {};
  if (own.body == "Earth" && units.places == UnitPlaces::kDegrees) {
    units.notes.push_back(
        fmt::format("{} says \"{}\", which is the Earth's: its degrees were taken as those of {}.", file,
                    own.crs_name, ground.body == "other" ? "the map's body" : ground.body));
    return {};
  }
  return fail(
      ErrorCode::kUnsupportedCrs,
      fmt::format("{} is in \"{}\" on a body with a radius of {} m, the elevation on {} with {} m: it is a "
                  "map of another world.",
                  file, own.crs_name, own.semi_major_axis_m, ground.body, ground.semi_major_axis_m));
}

// Cell values while burning: 0 where no polygon is, the legend's row + 1, or this for a label that it doesn't
// have, which still covers the polygons before it.
constexpr int kUnlisted = 32767;

int burn_value(const std::vector<SoilClass>& legend, const std::string& label) {
  const auto row =
      std::find_if(legend.begin(), legend.end(), [&](const SoilClass& c) { return c.label == label; });
  return row == legend.end() ? kUnlisted : static_cast<int>(row - legend.begin()) + 1;
}

std::optional<std::vector<std::int16_t>> burned(const GridGeometry& grid,
                                                const std::vector<LabelledPolygon>& polygons,
                                                const std::vector<SoilClass>& legend) {
  const GDALDatasetUniquePtr raster(GetGDALDriverManager()->GetDriverByName("MEM")->Create(
      "", grid.columns, grid.rows, 1, GDT_Int16, nullptr));
  if (!raster) return std::nullopt;
  std::array<double, 6> transform{grid.west_m, grid.cell_x_m, 0.0, grid.north_m, 0.0, -grid.cell_y_m};
  raster->SetGeoTransform(transform.data());
  std::vector<OGRGeometryH> geometries;
  std::vector<double> values;
  for (const LabelledPolygon& polygon : polygons) {
    geometries.push_back(OGRGeometry::ToHandle(polygon.geometry.get()));
    values.push_back(burn_value(legend, polygon.label));
  }
  const int band = 1;
  if (!geometries.empty() &&
      GDALRasterizeGeometries(GDALDataset::ToHandle(raster.get()), 1, &band,
                              static_cast<int>(geometries.size()), geometries.data(), nullptr, nullptr,
                              values.data(), nullptr, nullptr, nullptr) != CE_None) {
    return std::nullopt;
  }
  std::vector<std::int16_t> cells(static_cast<std::size_t>(grid.rows) *
                                  static_cast<std::size_t>(grid.columns));
  if (raster->GetRasterBand(1)->RasterIO(GF_Read, 0, 0, grid.columns, grid.rows, cells.data(), grid.columns,
                                         grid.rows, GDT_Int16, 0, 0, nullptr) != CE_None) {
    return std::nullopt;
  }
  return cells;
}

Result<GridGeometry> grid_over(const ElevationInfo& ground, const Extent& extent, int step) {
  const std::optional<CellWindow> window = ground.geometry.window(extent);
  if (!window) return fail(ErrorCode::kOffMap, "The extent does not meet the elevation's.");
  // A large window has larger cells, in whole numbers of the elevation's.
  GridGeometry grid = ground.geometry.sub(*window);
  const auto across = [&](int cells) { return (cells + step - 1) / step; };
  while (static_cast<long long>(across(window->rows)) * across(window->columns) > kMaxWindowCells) ++step;
  grid.rows = across(window->rows);
  grid.columns = across(window->columns);
  grid.cell_x_m *= step;
  grid.cell_y_m *= step;
  return grid;
}

// A class row by row of the legend from the burned values.
std::shared_ptr<const SoilMap> mapped(const GridGeometry& grid, std::vector<std::int16_t> cells,
                                      std::vector<SoilClass> legend) {
  std::vector<std::uint8_t> known(cells.size());
  for (std::size_t i = 0; i < cells.size(); ++i) {
    known[i] = cells[i] != 0 && cells[i] != kUnlisted ? 1 : 0;
    cells[i] = known[i] != 0 ? static_cast<std::int16_t>(cells[i] - 1) : std::int16_t{0};
  }
  for (std::size_t row = 0; row < legend.size(); ++row) legend[row].value = static_cast<int>(row);
  return std::make_shared<const SoilMap>(grid, std::move(cells), std::move(known), std::move(legend));
}

}  // namespace

Result<void> bring_to_map(SoilUnits& units, const ElevationInfo& ground, const std::string& file,
                          const GdalSession& session) {
  if (units.places == UnitPlaces::kMap) return {};
  if (const auto same = check_body(units, ground, file); !same) return same;
  const PlaceOnMap places(units, ground);
  if (!places.usable())
    return fail(ErrorCode::kUnsupportedCrs, fmt::format("The places of {} can't be brought into \"{}\": {}",
                                                        file, ground.crs_name, session.complaints()));
  std::vector<Fault> faults;
  std::vector<LabelledPolygon> moved;
  int unrolled_count = 0;
  const auto turn = places.turn_m();
  for (LabelledPolygon& polygon : units.polygons) {
    bool unrolled = false;
    if (!each_ring(*polygon.geometry, [&](OGRLinearRing& ring) { return move_ring(ring, places, unrolled); }))
      faults.push_back({polygon.pointer, "has a place that the elevation's map can't show"});
    else if (turn && !places.is_direct())
      add_copies(moved, std::move(polygon), *turn, ground.geometry.extent());
    else
      moved.push_back(std::move(polygon));
    unrolled_count += unrolled ? 1 : 0;
  }
  if (!faults.empty())
    return fail(ErrorCode::kUnreadableData, fmt::format("{} has places that are not on the map.", file),
                std::move(faults));
  if (unrolled_count > 0)
    units.notes.push_back(fmt::format(
        "{} polygons have a step of more than 180 deg of longitude and were taken across the antimeridian.",
        unrolled_count));
  units.polygons = std::move(moved);
  units.places = UnitPlaces::kMap;
  units.crs.reset();
  return {};
}

Result<std::shared_ptr<const SoilMap>> read_soil_polygons(const std::filesystem::path& path,
                                                          const ElevationInfo& ground, const Extent& extent,
                                                          const std::string& property,
                                                          PolygonCoordinates coordinates,
                                                          std::vector<SoilClass> legend, int step) {
  std::vector<Fault> repeats = repeated_labels(legend);
  if (!repeats.empty())
    return fail(ErrorCode::kUnreadableData, "The soil legend repeats itself.", std::move(repeats));
  if (legend.size() >= kUnlisted)
    return fail(ErrorCode::kUnreadableData, "The soil legend has too many rows.");
  const Result<GridGeometry> grid = grid_over(ground, extent, step);
  if (!grid) return fail(grid.error());
  const GdalSession session(path);
  Result<SoilUnits> units = read_soil_units(path, property, coordinates, session);
  if (!units) return fail(std::move(units.error()));
  if (auto moved = bring_to_map(*units, ground, path.filename().string(), session); !moved)
    return fail(std::move(moved.error()));
  std::optional<std::vector<std::int16_t>> cells = burned(*grid, units->polygons, legend);
  if (!cells) {
    return fail(ErrorCode::kInternal,
                fmt::format("The polygons could not be burned: {}", session.complaints()));
  }
  return mapped(*grid, std::move(*cells), std::move(legend));
}

}  // namespace slipway::dem
