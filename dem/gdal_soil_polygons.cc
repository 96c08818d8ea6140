#include <fmt/format.h>
#include <gdal_alg.h>
#include <gdal_priv.h>

#include <algorithm>
#include <array>
#include <memory>
#include <utility>

#include "dem/body_degrees.h"
#include "dem/gdal_geojson_polygons.h"
#include "dem/soil_legend.h"
#include "dem/soil_map.h"

namespace slipway::dem {
namespace {

// Brings every point of a polygon from longitude and latitude to the map. False where the map does not reach.
bool move_to_map(OGRPolygon& polygon, const BodyDegrees& degrees) {
  for (OGRLinearRing* ring : polygon) {
    for (int i = 0; i < ring->getNumPoints(); ++i) {
      const auto place = degrees.to_map({ring->getX(i), ring->getY(i)});
      if (!place) return false;
      ring->setPoint(i, place->x, place->y);
    }
  }
  return true;
}

bool move_to_map(OGRGeometry& geometry, const BodyDegrees& degrees) {
  if (geometry.getGeometryType() == wkbPolygon) return move_to_map(*geometry.toPolygon(), degrees);
  for (OGRPolygon* polygon : *geometry.toMultiPolygon())
    if (!move_to_map(*polygon, degrees)) return false;
  return true;
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

std::vector<Fault> move_to_map(std::vector<LabelledPolygon>& polygons, const BodyDegrees& degrees) {
  std::vector<Fault> faults;
  for (std::size_t i = 0; i < polygons.size(); ++i) {
    if (move_to_map(*polygons[i].geometry, degrees)) continue;
    faults.push_back(
        {fmt::format("/features/{}/geometry", i), "has a place that the elevation's map can't show"});
  }
  return faults;
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
  Result<std::vector<LabelledPolygon>> polygons = read_geojson_polygons(path, property, coordinates, session);
  if (!polygons) return fail(std::move(polygons.error()));
  if (coordinates == PolygonCoordinates::kLongitudeLatitude) {
    const BodyDegrees degrees(ground.crs_wkt, ground.body);
    if (!degrees.usable()) {
      return fail(ErrorCode::kUnsupportedCrs,
                  fmt::format("Longitude and latitude can't be brought into \"{}\": {}", ground.crs_name,
                              session.complaints()));
    }
    std::vector<Fault> faults = move_to_map(*polygons, degrees);
    if (!faults.empty()) {
      return fail(ErrorCode::kUnreadableData,
                  fmt::format("{} has places that are not on the map.", path.filename().string()),
                  std::move(faults));
    }
  }
  std::optional<std::vector<std::int16_t>> cells = burned(*grid, *polygons, legend);
  if (!cells) {
    return fail(ErrorCode::kInternal,
                fmt::format("The polygons could not be burned: {}", session.complaints()));
  }
  return mapped(*grid, std::move(*cells), std::move(legend));
}

}  // namespace slipway::dem
