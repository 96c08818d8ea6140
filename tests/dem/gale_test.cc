#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include "core/angle.h"
#include "dem/elevation_source.h"
#include "dem/soil_map.h"

namespace slipway::dem {
namespace {

const std::filesystem::path kGale = std::filesystem::path(SLIPWAY_SOURCE_DIR) / "data/terrains/gale";

std::shared_ptr<const ElevationSource> gale() {
  auto source = open_elevation(kGale / "elevation.tif");
  if (!source) throw std::runtime_error(source.error().detail);
  return *source;
}

std::shared_ptr<const Terrain> whole_gale() {
  return gale()->read(gale()->info().geometry.extent()).value();
}

// A legend with a soil for every code, so that all classes of the map stay distinct.
std::vector<SoilClass> all_units() {
  std::vector<SoilClass> legend;
  for (const char* label :
       {"CP", "CPR", "CPS", "LBRp", "LR", "MR", "MS", "PDS", "PR", "RF", "Ridge", "SM", "SMR"}) {
    legend.push_back({static_cast<int>(legend.size()), label, label});
  }
  return legend;
}

TEST(Gale, TheElevationIsAMetreGridOnTheMarsSphere) {
  const ElevationInfo info = gale()->info();
  EXPECT_EQ(info.geometry, (GridGeometry{337, 348, 8142406.0, -276455.0, 1.0, 1.0}));
  EXPECT_EQ(info.body, "Mars");
  EXPECT_EQ(info.semi_major_axis_m, 3396190.0);
}

TEST(Gale, TheBilinearHeightAtCuriositysStopsIsThePublishedOneToTheRoundingOfTheFile) {
  const auto terrain = whole_gale();
  std::ifstream file(kGale / "curiosity_stops.csv");
  std::string line;
  std::getline(file, line);
  ASSERT_EQ(line, "sol,site,pos,x_m,y_m,dem_z_m,elev_m,pitch_deg,roll_deg,tilt_deg,yaw_deg");
  int stops = 0;
  double furthest = 0.0;
  while (std::getline(file, line)) {
    std::vector<double> values;
    std::istringstream cells(line);
    for (std::string cell; std::getline(cells, cell, ',');) values.push_back(std::stod(cell));
    const auto height = terrain->height_m(values.at(3), values.at(4));
    ASSERT_TRUE(height) << line;
    furthest = std::max(furthest, std::abs(*height - values.at(5)));
    ++stops;
  }
  EXPECT_EQ(stops, 32);
  EXPECT_LT(furthest, 0.001);
}

TEST(Gale, SlopesAreThosePublishedWithTheData) {
  const auto terrain = whole_gale();
  std::vector<double> slopes_deg;
  for (int row = 0; row < 337; ++row) {
    for (int column = 0; column < 348; ++column) {
      const auto point = terrain->surface(Cell{row, column});
      if (point) slopes_deg.push_back(deg_from_rad(point->slope_rad()));
    }
  }
  ASSERT_EQ(slopes_deg.size(), 337U * 348U);
  std::sort(slopes_deg.begin(), slopes_deg.end());
  EXPECT_NEAR(slopes_deg[slopes_deg.size() / 2], 6.8, 0.1);
  EXPECT_NEAR(slopes_deg[slopes_deg.size() * 95 / 100], 17.9, 0.1);
  EXPECT_NEAR(slopes_deg.back(), 40.0, 1.0);
}

TEST(Gale, TheClassRasterIsWhatThePolygonsBurnTo) {
  const ElevationInfo ground = gale()->info();
  const Extent extent = ground.geometry.extent();
  const auto raster = read_soil_raster(kGale / "terrain_class.tif", ground, extent, all_units());
  const auto polygons = read_soil_polygons(kGale / "gale_terrain_units.geojson", ground, extent, "Name",
                                           PolygonCoordinates::kLongitudeLatitude, all_units());
  ASSERT_TRUE(raster) << raster.error().detail;
  ASSERT_TRUE(polygons) << polygons.error().detail;
  ASSERT_EQ((*raster)->geometry(), (*polygons)->geometry());
  int differing = 0;
  for (int row = 0; row < 337; ++row) {
    for (int column = 0; column < 348; ++column) {
      const Eigen::Vector2d p = ground.geometry.centre_m({row, column});
      if ((*raster)->class_at(p.x(), p.y()) != (*polygons)->class_at(p.x(), p.y())) ++differing;
    }
  }
  EXPECT_EQ(differing, 0);
  EXPECT_NEAR((*raster)->unknown_fraction(), 0.603, 0.001);
}

}  // namespace
}  // namespace slipway::dem
