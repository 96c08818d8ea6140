#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "api/jobs/open_job_store.h"
#include "api/json/parse.h"
#include "api/place_sky.h"
#include "api/sunlight.h"
#include "api/terrain_views/terrain_document.h"
#include "api/terrain_views/terrain_picture.h"
#include "api/terrain_views/terrain_profile.h"
#include "core/angle.h"
#include "core/utc.h"
#include "server/routes/responses.h"
#include "server/routes/routes.h"
#include "small_world.h"

// What is drawn and told of one terrain, as functions and over the routes.
namespace slipway::api {
namespace {

using json::JsonValue;
using testing::small_world;

const TerrainSite& yard() {
  return *small_world().catalogue()->terrains.at("yard");
}

TerrainPicture of(TerrainLayer layer, const dem::Extent& extent, int width, int height) {
  TerrainPicture wanted;
  wanted.layer = layer;
  wanted.extent = extent;
  wanted.width_px = width;
  wanted.height_px = height;
  return wanted;
}

bool is_hatched(const dem::Rgba& pixel) {
  return pixel == dem::Rgba(kHatchStripe) || pixel == dem::Rgba(kHatchGround);
}

// Holds each pixel against what the terrain itself says of the pixel's centre.
TEST(TerrainPicture, EveryPixelHasTheColourOfItsPlaceAndWhatIsNotKnownIsHatched) {
  const dem::Extent map = yard().info().geometry.extent();
  const int width = static_cast<int>(map.east_m - map.west_m),
            height = static_cast<int>(map.north_m - map.south_m);
  const auto slope = draw_terrain(yard(), of(TerrainLayer::kSlope, map, width, height));
  const auto soil = draw_terrain(yard(), of(TerrainLayer::kSoil, map, width, height));
  const auto unknown = draw_terrain(yard(), of(TerrainLayer::kUnknown, map, width, height));
  const auto shade = draw_terrain(yard(), of(TerrainLayer::kHillshade, map, width, height));
  ASSERT_TRUE(slope && soil && unknown && shade);
  const auto ground = yard().read(map);
  ASSERT_TRUE(ground);
  int holes = 0, unknowns = 0;
  for (int row = 0; row < height; ++row) {
    for (int column = 0; column < width; ++column) {
      const double x = map.west_m + column + 0.5, y = map.north_m - row - 0.5;
      const auto surface = ground->terrain->surface(x, y);
      if (!surface) ++holes;
      EXPECT_EQ(is_hatched(slope->at(row, column)), !surface);
      EXPECT_EQ(shade->at(row, column)[3] == 0, !surface);
      if (surface) {
        EXPECT_EQ(slope->at(row, column), slope_colour(surface->slope_rad() * 180.0 / M_PI));
      }
      const bool known = ground->soil_map->soil_at(x, y).has_value();
      if (!known) ++unknowns;
      EXPECT_EQ(is_hatched(soil->at(row, column)), !known);
      EXPECT_EQ(unknown->at(row, column)[3] == 0, known);
    }
  }
  EXPECT_GT(holes, 0);
  EXPECT_GT(unknowns, 0);
}

TEST(TerrainPicture, BeyondTheMapIsTransparentInEveryLayer) {
  const dem::Extent map = yard().info().geometry.extent();
  const dem::Extent wide{map.west_m - 100.0, map.south_m, map.west_m + 100.0, map.south_m + 100.0};
  for (const TerrainLayerRow& row : kTerrainLayers) {
    const auto image = draw_terrain(yard(), of(row.layer, wide, 100, 50));
    ASSERT_TRUE(image) << row.name;
    for (int column = 0; column < 50; ++column) EXPECT_EQ(image->at(25, column)[3], 0) << row.name;
    const auto away = draw_terrain(yard(), of(row.layer, {1e6, 1e6, 1e6 + 1, 1e6 + 1}, 3, 3));
    ASSERT_TRUE(away);
    EXPECT_EQ(away->at(1, 1), dem::kTransparent);
  }
}

// A pixel of several cells must not hide what is unknown in it, nor how steep it is.
TEST(TerrainPicture, ALargePixelShowsTheSteepestAndTheUnknown) {
  const dem::Extent map = yard().info().geometry.extent();
  const auto fine = draw_terrain(yard(), of(TerrainLayer::kUnknown, map, 120, 100));
  const auto coarse = draw_terrain(yard(), of(TerrainLayer::kUnknown, map, 40, 50));
  ASSERT_TRUE(fine && coarse);
  for (int row = 0; row < 50; ++row) {
    for (int column = 0; column < 40; ++column) {
      bool any = false;
      for (int r = 0; r < 2; ++r)
        for (int c = 0; c < 3; ++c) any = any || fine->at(2 * row + r, 3 * column + c)[3] != 0;
      EXPECT_EQ(coarse->at(row, column)[3] != 0, any) << row << " " << column;
    }
  }
}

TEST(TerrainPicture, TilesOfNeighboursFitTogetherAndCoverTheTerrain) {
  const dem::GridGeometry& geometry = yard().info().geometry;
  const TerrainTiles tiles(geometry);
  const dem::Extent map = geometry.extent(), whole = tiles.extent(0, 0, 0);
  EXPECT_EQ(whole.west_m, map.west_m);
  EXPECT_EQ(whole.north_m, map.north_m);
  EXPECT_GE(whole.east_m, map.east_m);
  EXPECT_LE(whole.south_m, map.south_m);
  EXPECT_TRUE(tiles.has(0, 0, 0));
  EXPECT_FALSE(tiles.has(0, 1, 0));
  EXPECT_FALSE(tiles.has(tiles.most_z() + 1, 0, 0));
  EXPECT_DOUBLE_EQ(tiles.extent(2, 1, 0).east_m, tiles.extent(2, 2, 0).west_m);
  EXPECT_DOUBLE_EQ(tiles.extent(2, 1, 0).south_m, tiles.extent(2, 1, 1).north_m);
}

TEST(TerrainProfile, HasTheGroundAtEveryPlaceOfTheLine) {
  const dem::Extent map = yard().info().geometry.extent();
  const Eigen::Vector2d from(map.west_m - 5.0, map.south_m + 20.0),
      corner(map.west_m + 40.0, map.south_m + 20.0), to(map.west_m + 40.0, map.north_m - 5.0);
  const auto along = ground_along(yard(), {from, corner, to}, 101, "");
  ASSERT_TRUE(along);
  ASSERT_EQ(along->size(), 101U);
  const double length = (corner - from).norm() + (to - corner).norm();
  EXPECT_NEAR(along->back().distance_m, length, 1e-9);
  EXPECT_FALSE(along->front().height_m) << "off the map";
  EXPECT_FALSE(along->front().soil);
  const auto ground = yard().read(map);
  ASSERT_TRUE(ground);
  for (std::size_t k = 0; k < along->size(); ++k) {
    const ProfilePoint& place = (*along)[k];
    EXPECT_NEAR(place.distance_m, length * static_cast<double>(k) / 100.0, 1e-9);
    const auto surface = ground->terrain->surface(place.x_m, place.y_m);
    ASSERT_EQ(place.height_m.has_value(), surface.has_value()) << k;
    if (surface) {
      EXPECT_DOUBLE_EQ(*place.height_m, surface->height_m);
      EXPECT_DOUBLE_EQ(*place.slope_rad, surface->slope_rad());
    }
  }
  EXPECT_FALSE(ground_along(yard(), {from, to}, 3, "no such legend"));
}

class TerrainRoutes : public ::testing::Test {
 protected:
  server::HttpResponse get(const std::string& path, server::NamedValues query = {},
                           server::NamedValues headers = {}) {
    server::HttpRequest request;
    request.method = "GET";
    request.path = request.raw_path = path;
    request.query = std::move(query);
    request.headers = std::move(headers);
    return table_.answer(request, server::problem_response);
  }
  static std::vector<std::string> faults_of(const server::HttpResponse& response) {
    std::vector<std::string> pointers;
    const auto problem = json::parse(response.body).value();
    if (const JsonValue* const faults = problem.find("faults"))
      for (const JsonValue& fault : faults->elements) pointers.push_back(fault.find("pointer")->text);
    return pointers;
  }

  JobRunner runner_{open_job_store("").value(),
                    [](const std::string&, const std::string&, Progress&) -> Result<std::string> {
                      return fail(ErrorCode::kInternal, "");
                    }};
  server::RouteTable table_{server::api_routes(small_world(), runner_)};
};

TEST_F(TerrainRoutes, TheDocumentNamesItsFilesAndAddressesThatAnswer) {
  const auto response = get("/v1/terrains/yard");
  ASSERT_EQ(response.status, 200) << response.body;
  const JsonValue document = json::parse(response.body).value();
  EXPECT_EQ(document.find("terrain")->find("name")->text, "yard");
  EXPECT_EQ(document.find("files")->elements.size(), 5U);
  EXPECT_EQ(document.find("files")->elements[0].find("sha256")->text.size(), 64U);
  EXPECT_FALSE(document.find("provenance")->text.empty());
  EXPECT_TRUE(document.find("licence")->is(JsonValue::Kind::kNull));
  const std::string hash = document.find("hash")->text;
  const auto tile = get("/v1/terrains/yard/tiles/slope/0/0/0.png", {{"v", hash}});
  ASSERT_EQ(tile.status, 200) << tile.body;
  EXPECT_EQ(tile.content_type, "image/png");
  EXPECT_EQ(tile.body.substr(1, 3), "PNG");
  EXPECT_NE(tile.header("Cache-Control")->find("immutable"), std::string::npos);
  // Another version's address must be asked for again.
  EXPECT_EQ(get("/v1/terrains/yard/tiles/slope/0/0/0.png", {{"v", "0"}}).header("Cache-Control"), "no-cache");
  const std::string tag = response.header("ETag").value();
  EXPECT_EQ(get("/v1/terrains/yard", {}, {{"If-None-Match", tag}}).status, 304);
}

TEST_F(TerrainRoutes, WhatIsNotThereIsNotFoundAndWhatIsWrongIsNamedAtOnce) {
  EXPECT_EQ(get("/v1/terrains/yrd").status, 404);
  EXPECT_EQ(get("/v1/terrains/yard/tiles/slip/0/0/0.png").status, 404);
  for (const char* tile :
       {"0/0/1.png", "0/1/0.png", "99/0/0.png", "-1/0/0.png", "0/0/0", "0/0/0.jpg", "0/0/a.png"})
    EXPECT_EQ(get(std::string("/v1/terrains/yard/tiles/slope/") + tile).status, 404) << tile;
  EXPECT_EQ(get("/v1/terrains/yard/slope.jpg").status, 404);
  EXPECT_EQ(get("/v1/terrains/yard/tiles/soil/0/0/0.png", {{"legend", "none"}}).status, 404);
  const auto picture =
      get("/v1/terrains/yard/slope.png", {{"west_m", "1"}, {"width", "4000"}, {"tint", "red"}});
  EXPECT_EQ(picture.status, 422);
  EXPECT_EQ(faults_of(picture),
            (std::vector<std::string>{"/tint", "/south_m", "/east_m", "/north_m", "/width"}));
  const auto turned = get("/v1/terrains/yard/slope.png",
                          {{"west_m", "5"}, {"east_m", "1"}, {"south_m", "0"}, {"north_m", "0"}});
  EXPECT_EQ(faults_of(turned), (std::vector<std::string>{"/east_m", "/north_m"}));
  EXPECT_EQ(faults_of(get("/v1/terrains/yard/profile", {{"path", "1,2,x"}, {"points", "1"}})),
            (std::vector<std::string>{"/path", "/points"}));
  EXPECT_EQ(faults_of(get("/v1/terrains/yard/profile", {{"path", "1,2,3"}})),
            (std::vector<std::string>{"/path"}));
  EXPECT_EQ(faults_of(get("/v1/terrains/yard/profile")), (std::vector<std::string>{"/path"}));
}

TEST_F(TerrainRoutes, AShadowIsAPictureOfTheBoundsUnderTheSunsAndEveryFaultIsNamed) {
  const dem::Extent map = yard().info().geometry.extent();
  const std::string bounds = fmt::format("{},{},{},{}", map.west_m, map.south_m, map.east_m, map.north_m);
  const auto picture = get("/v1/terrains/yard/shadow.png", {{"bounds", bounds}, {"sun", "270,5"}});
  ASSERT_EQ(picture.status, 200) << picture.body;
  EXPECT_EQ(picture.content_type, "image/png");
  const auto ground = ShadowGround::read(yard(), map);
  ASSERT_TRUE(ground);
  const auto drawn = [&](const std::vector<sky::Bearing>& suns) {
    return dem::encode_png(ground->draw(map, suns)).value();
  };
  EXPECT_EQ(picture.body, drawn({{1.5 * std::numbers::pi, rad_from_deg(5.0)}}));
  const auto share = get("/v1/terrains/yard/shadow.png", {{"bounds", bounds}, {"sun", "270,5;90,5"}});
  EXPECT_EQ(share.body, drawn({{1.5 * std::numbers::pi, rad_from_deg(5.0)},
                               {0.5 * std::numbers::pi, rad_from_deg(5.0)}}));
  EXPECT_NE(share.body, picture.body);
  const auto faults = [&](server::NamedValues query) {
    return faults_of(get("/v1/terrains/yard/shadow.png", std::move(query)));
  };
  using Pointers = std::vector<std::string>;
  EXPECT_EQ(faults({{"at", "noon"}}), (Pointers{"/at", "/bounds", "/sun"}));
  EXPECT_EQ(faults({{"bounds", "1,2,1,4"}, {"sun", "0,91"}}), (Pointers{"/bounds", "/sun"}));
  EXPECT_EQ(faults({{"bounds", "1,2,3"}, {"sun", "1,2,3"}}), (Pointers{"/bounds", "/sun"}));
  EXPECT_EQ(faults({{"bounds", "-1e308,0,1e308,1"}, {"sun", "1,2"}}), (Pointers{"/bounds"}));
  EXPECT_EQ(faults({{"bounds", "1;2"}, {"sun", "1,2;"}}), (Pointers{"/bounds", "/sun"}));
  std::string many = "0,1";
  for (std::size_t k = 0; k < kMostSuns; ++k) many += ";0,1";
  EXPECT_EQ(faults({{"bounds", bounds}, {"sun", many}}), (Pointers{"/sun"}));
  EXPECT_EQ(get("/v1/terrains/yrd/shadow.png", {{"bounds", bounds}, {"sun", "0,1"}}).status, 404);
}

TEST_F(TerrainRoutes, ASkyIsThatOverThePlaceAndItsFaultsAreNamed) {
  const std::string noon = "2026-07-01T12:00:00Z";
  const auto sky = get("/v1/terrains/yard/sky", {{"place", "10,10"}, {"from", noon}, {"to", noon}});
  ASSERT_EQ(sky.status, 200) << sky.body;
  const auto known = sky_over(yard(), 10.0, 10.0, utc_of_text(noon).value(), utc_of_text(noon));
  EXPECT_EQ(sky.body, write_place_sky(yard(), known.value()));
  EXPECT_EQ(get("/v1/terrains/yard/sky", {{"place", "1e6,10"}, {"from", noon}}).status, 422) << "off the map";
  using Pointers = std::vector<std::string>;
  EXPECT_EQ(faults_of(get("/v1/terrains/yard/sky", {{"place", "1"}, {"from", "noon"}, {"sun", "0,1"}})),
            (Pointers{"/sun", "/place", "/from"}));
  const auto turned =
      get("/v1/terrains/yard/sky",
          {{"place", "1,2"}, {"from", "2026-07-01T12:00:00Z"}, {"to", "2026-07-01T11:00:00Z"}});
  EXPECT_EQ(faults_of(turned), (Pointers{"/to"}));
  const auto long_one =
      get("/v1/terrains/yard/sky",
          {{"place", "1,2"}, {"from", "2026-07-01T12:00:00Z"}, {"to", "2026-07-04T12:00:00Z"}});
  EXPECT_EQ(faults_of(long_one), (Pointers{"/to"}));
}

TEST_F(TerrainRoutes, AProfileHasNullsWhereTheMapHasNothing) {
  const auto response = get("/v1/terrains/yard/profile", {{"path", "-1e6,0,1e6,0"}, {"points", "3"}});
  ASSERT_EQ(response.status, 200) << response.body;
  const JsonValue document = json::parse(response.body).value();
  for (const char* key : {"distance_m", "x_m", "y_m", "height_m", "slope_deg", "label", "soil"})
    EXPECT_EQ(document.find(key)->elements.size(), 3U) << key;
  EXPECT_TRUE(document.find("height_m")->elements[0].is(JsonValue::Kind::kNull));
}

}  // namespace
}  // namespace slipway::api
