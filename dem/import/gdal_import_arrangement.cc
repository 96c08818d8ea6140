#include "dem/import/gdal_import_arrangement.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "dem/gdal_crs.h"

namespace slipway::dem {
namespace {

constexpr double kRadPerDeg = std::numbers::pi / 180.0;

// Degrees that count to the west become degrees that count to the east.
void count_eastwards(Arrangement& a) {
  auto east = std::make_unique<OGRSpatialReference>();
  east->SetGeogCS("longitude to the east", "the map's own datum", "its ellipsoid", a.crs->GetSemiMajor(),
                  a.crs->GetInvFlattening());
  east->SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  a.crs = std::move(east);
  for (int i : {0, 1, 2}) a.grid[static_cast<std::size_t>(i)] = -a.grid[static_cast<std::size_t>(i)];
  a.changes.emplace_back("longitudes that counted to the west now count to the east");
}

// The same of map coordinates.
void count_eastings(Arrangement& a) {
  a.crs = eastward_projection(*a.crs);
  for (int i : {0, 1, 2}) a.grid[static_cast<std::size_t>(i)] = -a.grid[static_cast<std::size_t>(i)];
  a.changes.emplace_back("map coordinates that counted to the west now count to the east");
}

void turn_north_up(Arrangement& a, int rows, int columns) {
  if (a.grid[2] != 0.0 || a.grid[4] != 0.0) {
    a.reprojects = true;
    return;
  }
  if (a.grid[5] > 0.0) {
    a.flips_rows = true;
    a.grid[3] += rows * a.grid[5];
    a.grid[5] = -a.grid[5];
    a.changes.emplace_back("the first row was in the south; the rows were turned round");
  }
  if (a.grid[1] < 0.0) {
    a.flips_columns = true;
    a.grid[0] += columns * a.grid[1];
    a.grid[1] = -a.grid[1];
    a.changes.emplace_back("the first column was in the east; the columns were turned round");
  }
}

void measure_in_metres(Arrangement& a) {
  const double metres = a.crs->GetLinearUnits();
  if (a.crs->IsProjected() == 0 || std::abs(metres - 1.0) <= 1e-9) return;
  a.crs->SetLinearUnitsAndUpdateParameters(SRS_UL_METER, 1.0);
  for (double& coefficient : a.grid) coefficient *= metres;
  a.changes.push_back(fmt::format("map coordinates were multiplied by {} to be metres", metres));
}

}  // namespace

Arrangement arrange(GDALDataset& dataset, const OGRSpatialReference& crs) {
  Arrangement a;
  a.crs.reset(crs.Clone());
  a.crs->SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  dataset.GetGeoTransform(a.grid.data());
  if (is_west_positive(*a.crs)) a.crs->IsGeographic() != 0 ? count_eastwards(a) : count_eastings(a);
  measure_in_metres(a);
  turn_north_up(a, dataset.GetRasterYSize(), dataset.GetRasterXSize());
  a.reprojects = a.reprojects || a.crs->IsGeographic() != 0;
  return a;
}

Extent extent_of(const Arrangement& a, int rows, int columns) {
  Extent extent{a.grid[0], a.grid[3], a.grid[0], a.grid[3]};
  for (const int row : {0, rows}) {
    for (const int column : {0, columns}) {
      const double x = a.grid[0] + column * a.grid[1] + row * a.grid[2];
      const double y = a.grid[3] + column * a.grid[4] + row * a.grid[5];
      extent = {std::min(extent.west_m, x), std::min(extent.south_m, y), std::max(extent.east_m, x),
                std::max(extent.north_m, y)};
    }
  }
  return extent;
}

double cell_side_m(const Arrangement& a) {
  const double unit = a.crs->IsGeographic() != 0 ? kRadPerDeg * a.crs->GetSemiMajor() : 1.0;
  return unit * std::min(std::hypot(a.grid[1], a.grid[4]), std::hypot(a.grid[2], a.grid[5]));
}

// A conformal projection's scale leaves kMaxScaleError at an arc of about 16 degrees from its centre.
std::optional<std::string> fault_of_size(const Arrangement& a, const Extent& extent) {
  constexpr double kMaxArc_rad = 0.27;
  double width = extent.east_m - extent.west_m, height = extent.north_m - extent.south_m;
  if (a.crs->IsGeographic() != 0) {
    width *= kRadPerDeg * std::cos(0.5 * (extent.north_m + extent.south_m) * kRadPerDeg);
    height *= kRadPerDeg;
  } else {
    width /= a.crs->GetSemiMajor();
    height /= a.crs->GetSemiMajor();
  }
  const double arc = 0.5 * std::hypot(width, height);
  if (arc <= kMaxArc_rad) return std::nullopt;
  return fmt::format(
      "reaches {:.0f} deg from its middle, where no map in metres has true lengths (at most {:.0f} deg). Cut "
      "a site out with: gdal_translate -projwin WEST NORTH EAST SOUTH, in the map's own coordinates",
      arc / kRadPerDeg, kMaxArc_rad / kRadPerDeg);
}

}  // namespace slipway::dem
