// The reader of soil units drawn as polygons.

#include "dem/soil_map.h"
#include "fuzz_target.h"

namespace {

constexpr const char* kMarsPlateCarree =
    R"(PROJCS["Mars",GEOGCS["Mars",DATUM["Mars",SPHEROID["Mars",3396190,0]],PRIMEM["Reference_Meridian",0],)"
    R"(UNIT["degree",0.0174532925199433]],PROJECTION["Equirectangular"],PARAMETER["standard_parallel_1",0],)"
    R"(PARAMETER["central_meridian",0],PARAMETER["false_easting",0],PARAMETER["false_northing",0],UNIT["metre",1]])";

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace slipway;
  dem::ElevationInfo ground;
  ground.geometry = {
      .rows = 16, .columns = 16, .west_m = 0.0, .north_m = 16.0, .cell_x_m = 1.0, .cell_y_m = 1.0};
  ground.crs_wkt = kMarsPlateCarree;
  ground.body = "Mars";
  ground.semi_major_axis_m = 3396190.0;
  const auto path = fuzz::as_file(fuzz::text_of(data, size), "units.geojson");
  for (const auto coordinates :
       {dem::PolygonCoordinates::kMap, dem::PolygonCoordinates::kLongitudeLatitude}) {
    const auto map = dem::read_soil_polygons(path, ground, ground.geometry.extent(), "Name", coordinates,
                                             {{0, "A", "sand"}, {0, "B", "rock"}});
    fuzz::require(map || !map.error().detail.empty(), "a refusal says why");
  }
  return 0;
}
