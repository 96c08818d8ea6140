// One ground, written as people write maps: however its numbers, blocks, axes, system and units are, the
// terrain is the same within half a cell and a centimetre.

#include <gdal_priv.h>
#include <gtest/gtest.h>
#include <ogr_spatialref.h>

#include <cmath>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/random.h"
#include "dem/elevation_source.h"
#include "dem/terrain_import.h"
#include "raster_fixture.h"

namespace slipway::dem {
namespace {

using test::RasterOptions;
using test::TemporaryFolder;
using test::write_geotiff;

constexpr int kRows = 60, kColumns = 80;
constexpr double kCell_m = 2.0;
constexpr double kWest_m = 500000.0, kNorth_m = 3950000.0;  // of UTM zone 13 north, at its central meridian

// The ground by its place in metres of the zone.
double height_m(double x_m, double y_m) {
  return 1500.0 + 0.05 * (x_m - kWest_m) + 0.02 * (y_m - kNorth_m);
}

// How a map is written: all that does not change the ground.
struct Form {
  std::string name;
  std::string crs = "EPSG:32613";
  double metres_per_unit = 1.0;  // of the map
  double height_unit_m = 1.0;
  std::string height_unit = "";
  GDALDataType type = GDT_Float32;
  double scale = 1.0, offset = 0.0;
  bool south_up = false;
  std::vector<std::string> creation{};
};

RasterOptions raster_of(const Form& form) {
  const double cell = kCell_m / form.metres_per_unit;
  const double west = kWest_m / form.metres_per_unit, north = kNorth_m / form.metres_per_unit;
  RasterOptions options{
      .rows = kRows, .columns = kColumns, .type = form.type, .crs = form.crs, .creation = form.creation};
  options.transform = {west, cell, 0.0, north, 0.0, -cell};
  if (form.south_up) options.transform = {west, cell, 0.0, north - kRows * cell, 0.0, cell};
  for (int row = 0; row < kRows; ++row)
    for (int column = 0; column < kColumns; ++column) {
      const double x = options.transform[0] + (column + 0.5) * cell;
      const double y = options.transform[3] + (row + 0.5) * options.transform[5];
      const double height = height_m(x * form.metres_per_unit, y * form.metres_per_unit) / form.height_unit_m;
      options.cells.push_back(static_cast<float>((height - form.offset) / form.scale));
    }
  options.also = [form](GDALDataset& raster) {
    GDALRasterBand& band = *raster.GetRasterBand(1);
    if (!form.height_unit.empty()) band.SetUnitType(form.height_unit.c_str());
    if (form.scale != 1.0) band.SetScale(form.scale);
    if (form.offset != 0.0) band.SetOffset(form.offset);
  };
  return options;
}

std::string in_form(const char* what,
                    const std::function<OGRErr(const OGRSpatialReference&, char**)>& written) {
  OGRSpatialReference system;
  system.SetFromUserInput(what);
  char* text = nullptr;
  written(system, &text);
  std::string form = text == nullptr ? "" : text;
  CPLFree(text);
  return form;
}

std::string wkt(const char* what, const char* kind) {
  return in_form(what, [kind](const OGRSpatialReference& system, char** text) {
    const std::string format = std::string("FORMAT=") + kind;
    const char* const options[] = {format.c_str(), nullptr};
    return system.exportToWkt(text, options);
  });
}

std::vector<Form> forms() {
  constexpr double kFoot_m = 0.3048, kSurveyFoot_m = 1200.0 / 3937.0;
  const std::string in_feet = "+proj=utm +zone=13 +datum=WGS84 +units=us-ft +no_defs";
  return {{.name = "float64", .type = GDT_Float64},
          {.name = "int16 with scale and offset", .type = GDT_Int16, .scale = 0.005, .offset = 1500.0},
          {.name = "int32 of millimetres", .type = GDT_Int32, .scale = 0.001},
          {.name = "tiles", .creation = {"TILED=YES", "BLOCKXSIZE=16", "BLOCKYSIZE=16"}},
          {.name = "strips, deflated, big-endian",
           .creation = {"COMPRESS=DEFLATE", "ENDIANNESS=BIG", "BLOCKYSIZE=7"}},
          {.name = "south up", .south_up = true},
          {.name = "WKT1", .crs = wkt("EPSG:32613", "WKT1_GDAL")},
          {.name = "WKT1 of ESRI", .crs = wkt("EPSG:32613", "WKT1_ESRI")},
          {.name = "WKT2", .crs = wkt("EPSG:32613", "WKT2_2019")},
          {.name = "PROJ string", .crs = "+proj=utm +zone=13 +datum=WGS84 +units=m +no_defs"},
          {.name = "with a vertical system", .crs = "EPSG:32613+5773"},
          {.name = "heights in feet", .height_unit_m = kFoot_m, .height_unit = "ft"},
          {.name = "heights in survey feet", .height_unit_m = kSurveyFoot_m, .height_unit = "US survey foot"},
          {.name = "map in survey feet", .crs = in_feet, .metres_per_unit = kSurveyFoot_m}};
}

// A place of the zone in a terrain's own map.
std::pair<double, double> in_map(double x_m, double y_m, const std::string& crs_wkt) {
  OGRSpatialReference zone, map;
  zone.importFromEPSG(32613);
  map.SetFromUserInput(crs_wkt.c_str());
  for (OGRSpatialReference* system : {&zone, &map})
    system->SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  const std::unique_ptr<OGRCoordinateTransformation> to(OGRCreateCoordinateTransformation(&zone, &map));
  if (to == nullptr || to->Transform(1, &x_m, &y_m) == 0) return {NAN, NAN};
  return {x_m, y_m};
}

TEST(RasterForms, OfOneGroundGiveTheSameTerrain) {
  test::prepare_gdal();
  for (const Form& form : forms()) {
    SCOPED_TRACE(form.name);
    TemporaryFolder folder;
    write_geotiff(folder / "dem.tif", raster_of(form));
    std::filesystem::create_directories(folder / "made");
    NoProgress quiet;
    const auto made = import_elevation({.source = folder / "dem.tif", .fix = true},
                                       folder / "made" / "elevation.tif", quiet);
    ASSERT_TRUE(made) << made.error().detail
                      << (made.error().faults.empty() ? "" : made.error().faults.front().message);
    const auto source = open_elevation(folder / "made" / "elevation.tif");
    ASSERT_TRUE(source) << source.error().detail;
    EXPECT_NEAR((*source)->info().geometry.cell_x_m, kCell_m, 0.02);
    for (std::uint64_t k = 0; k < 20; ++k) {
      const double x_m = kWest_m + (0.1 + 0.8 * random_uniform(1, k)) * kColumns * kCell_m;
      const double y_m = kNorth_m - (0.1 + 0.8 * random_uniform(2, k)) * kRows * kCell_m;
      const auto [x, y] = in_map(x_m, y_m, (*source)->info().crs_wkt);
      const auto ground = (*source)->read({x - 4.0, y - 4.0, x + 4.0, y + 4.0});
      ASSERT_TRUE(ground) << ground.error().detail;
      const double found = (*ground)->height_m(x, y).value_or(NAN);
      EXPECT_NEAR(found, height_m(x_m, y_m), 0.01 + 0.06 * 0.5 * kCell_m) << x_m << ", " << y_m;
    }
  }
}

}  // namespace
}  // namespace slipway::dem
