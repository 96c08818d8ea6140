#include "api/sunlight.h"

#include <gtest/gtest.h>

#include <cmath>
#include <ctime>
#include <filesystem>
#include <iostream>
#include <limits>
#include <numbers>
#include <string>

#include "api/files/terrain_site.h"
#include "api/place_sky.h"
#include "core/angle.h"
#include "core/utc.h"
#include "small_world.h"

// Where the ground lies in the sun, and where the sun stands over it.
namespace slipway::api {
namespace {

constexpr int kSide = 128;  // of the ground, in metres and in cells of a picture
constexpr double kHeight_m = 10.0, kFrom_m = 60.0, kTo_m = 64.0;

// Flat ground with a wall from south to north, which ends half way; one cell has no data. Mirrored: the wall
// stands as far from the other side.
ShadowGround wall(bool mirrored) {
  const dem::GridGeometry grid{
      .rows = kSide, .columns = kSide, .west_m = 0.0, .north_m = kSide, .cell_x_m = 1.0, .cell_y_m = 1.0};
  std::vector<float> heights;
  std::vector<std::uint8_t> valid;
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column) {
      const int x = mirrored ? grid.columns - 1 - column : column;
      heights.push_back(x >= kFrom_m && x < kTo_m && row < kSide / 2 ? static_cast<float>(kHeight_m) : 0.0F);
      valid.push_back(row == 100 && x == 20 ? 0 : 1);
    }
  return ShadowGround(std::make_shared<const dem::Terrain>(grid, std::move(heights), std::move(valid)),
                      std::numeric_limits<double>::infinity());
}

constexpr dem::Extent kAll{0.0, 0.0, kSide, kSide};
sky::Bearing sun(double azimuth_deg, double elevation_deg) {
  return {rad_from_deg(azimuth_deg), rad_from_deg(elevation_deg)};
}
// Metres of shadow in the row of a picture of all of the ground.
double shadow_m(const dem::RgbaImage& image, int row) {
  int dark = 0;
  for (int column = 0; column < image.columns; ++column) dark += image.at(row, column) == kShadow ? 1 : 0;
  return dark * static_cast<double>(kSide) / image.columns;
}

TEST(Sunlight, AWallCastsAShadowAsLongAsItsHeightOverTheTangentOfTheSun) {
  for (const double elevation_deg : {15.0, 30.0, 45.0}) {
    const dem::RgbaImage image = wall(false).draw(kAll, {sun(270.0, elevation_deg)});
    ASSERT_EQ(image.columns, 256);
    const double expected = kHeight_m / std::tan(rad_from_deg(elevation_deg));
    // Of the wall's own slope, which lies between two cells, up to a metre is dark too.
    EXPECT_NEAR(shadow_m(image, 64), expected, 1.01) << elevation_deg;
    EXPECT_EQ(shadow_m(image, 200), 0.0) << "no wall stands there";
    EXPECT_EQ(image.at(64, 2 * 58), dem::kTransparent) << "the side to the sun is lit";
    EXPECT_EQ(image.at(64, 2 * 66), kShadow);
  }
}

TEST(Sunlight, AMirroredMapHasMirroredShadows) {
  const dem::RgbaImage one = wall(false).draw(kAll, {sun(250.0, 12.0)}),
                       other = wall(true).draw(kAll, {sun(110.0, 12.0)});
  int differ = 0, dark = 0;
  for (int row = 0; row < one.rows; ++row)
    for (int column = 0; column < one.columns; ++column) {
      differ += one.at(row, column) != other.at(row, one.columns - 1 - column) ? 1 : 0;
      dark += one.at(row, column) == kShadow ? 1 : 0;
    }
  EXPECT_GT(dark, 2000);
  EXPECT_LE(differ, 10) << "cells at the very edge of a shadow";
}

// Of a terrain of more than 1,024 cells, beyond a picture every fourth cell is known: the wall is not among
// them.
TEST(Sunlight, AWallRightBesideThePictureOfALargeTerrainCastsItsShadow) {
  const testing::ScratchFolder scratch;
  const auto folder = scratch.path() / "long";
  std::filesystem::create_directory(folder);
  constexpr int kRows = 40, kColumns = 3'100;
  for (const int wall : {1'497, 1'498, 1'499, 1'500}) {
    std::string line;
    for (int column = 0; column < kColumns; ++column) line += column == wall ? "5 " : "0 ";
    std::string grid = "ncols 3100\nnrows 40\nxllcorner 0\nyllcorner 0\ncellsize 1\n";
    for (int row = 0; row < kRows; ++row) grid += line + "\n";
    testing::write_file(folder / "elevation.asc", grid);
    testing::write_file(
        folder / "elevation.prj",
        R"(PROJCS["Mars",GEOGCS["Mars",DATUM["Mars",SPHEROID["Mars",3396190,0]],PRIMEM["Zero",0],)"
        R"(UNIT["degree",0.0174532925199433]],PROJECTION["Equirectangular"],UNIT["metre",1]])");
    testing::write_file(
        folder / "terrain.json",
        R"({"format":"terrain/1","name":"long","title":"t","elevation":"elevation.asc","gravity_m_s2":3.71})");
    const auto site = TerrainSite::open(folder);
    ASSERT_TRUE(site) << site.error().detail;
    const dem::Extent beside{wall + 1.5, 10.0, wall + 21.5, 30.0};
    const auto ground = ShadowGround::read(**site, beside);
    ASSERT_TRUE(ground);
    const dem::RgbaImage image = ground->draw(beside, {sun(270.0, 30.0)});
    EXPECT_EQ(image.at(image.rows / 2, 40), kShadow) << wall;  // 3 m of the 9 m that lie in shadow
  }
}

TEST(Sunlight, GroundOutsideThePictureCastsShadowsIntoIt) {
  const dem::Extent beside{66.0, 80.0, 76.0, 90.0};
  const dem::RgbaImage image = wall(false).draw(beside, {sun(270.0, 30.0)});
  EXPECT_EQ(image.at(image.rows / 2, image.columns / 2), kShadow);
}

TEST(Sunlight, ANightIsDarkAndWhereThereIsNoGroundNothingIsDrawn) {
  for (const double elevation_deg : {0.0, -40.0}) {
    const dem::RgbaImage image = wall(false).draw(kAll, {sun(90.0, elevation_deg)});
    EXPECT_EQ(image.at(10, 10), kShadow);
    EXPECT_EQ(image.at(200, 2 * 20), dem::kTransparent) << "a cell without data";
  }
  const dem::Extent away{1000.0, 1000.0, 1010.0, 1010.0};
  EXPECT_EQ(wall(false).draw(away, {sun(90.0, 30.0)}).at(0, 0), dem::kTransparent);
}

TEST(Sunlight, TheShareOfTheSunsHasItsClass) {
  // Five suns from the west, of which only those above 45 deg reach a place 10 m behind the wall.
  const std::vector<sky::Bearing> suns{sun(270.0, 20.0), sun(270.0, 30.0), sun(270.0, 40.0), sun(270.0, 60.0),
                                       sun(270.0, 70.0)};
  const dem::RgbaImage image = wall(false).draw(kAll, suns);
  const auto at = [&](double x_m, double y_m) {
    return image.at(static_cast<int>((kSide - y_m) / kSide * image.rows),
                    static_cast<int>(x_m / kSide * image.columns));
  };
  EXPECT_EQ(at(74.0, 100.0), kSunlitClasses[1].colour) << "two suns of five";
  EXPECT_EQ(at(30.0, 100.0), kSunlitClasses[4].colour) << "all of them";
  EXPECT_EQ(wall(false).draw(kAll, {sun(0.0, -1.0), sun(0.0, -2.0)}).at(0, 0), kSunlitClasses[0].colour);
}

// Somebody who asks for as many suns as can be must not keep the others waiting. Seconds of a shared
// processor say little, so that one sun is the measure.
TEST(Sunlight, AHundredSunsCostLittleMoreThanAFew) {
  const ShadowGround ground = wall(false);
  std::vector<sky::Bearing> suns;
  for (std::size_t k = 0; k < kMostSuns; ++k) suns.push_back(sun(3.6 * static_cast<double>(k) + 0.3, 15.0));
  const auto seconds = [&](std::size_t count) {
    const std::clock_t begun = std::clock();
    EXPECT_EQ(ground.draw(kAll, {suns.begin(), suns.begin() + static_cast<std::ptrdiff_t>(count)}).columns,
              count > 25 ? 128 : 256);
    return static_cast<double>(std::clock() - begun) / CLOCKS_PER_SEC;
  };
  seconds(25);
  const double few = seconds(25), all = seconds(kMostSuns);
  std::cout << "25 suns took " << few << " s of the processor, 100 took " << all << " s\n";
  EXPECT_LT(all, 2.5 * few);
}

std::shared_ptr<const TerrainSite> shipped(const std::string& name) {
  return TerrainSite::open(std::filesystem::path(SLIPWAY_DATA_FOLDER) / "terrains" / name).value();
}

TEST(PlaceSky, IsRefusedWithWordsWhereItIsNotComputed) {
  for (const auto& [name, body] : {std::pair{"ames_yard", "Earth"}, {"lunar_south_pole_synthetic", "Moon"}}) {
    const auto sky = sky_over(*shipped(name), 0.0, 0.0, 0, {});
    ASSERT_FALSE(sky);
    EXPECT_EQ(sky.error().code, ErrorCode::kInvalidRequest);
    EXPECT_EQ(sky.error().detail,
              std::string("the terrain lies on the ") + body + ", where the sun's direction is not computed");
  }
}

TEST(PlaceSky, EveryFaultHasItsPlace) {
  const auto sky = sky_over(*shipped("gale"), 5.0, 6.0, utc_of_text("1700-01-01T00:00:00Z").value(),
                            utc_of_text("1700-01-01T05:00:00Z"));
  ASSERT_FALSE(sky);
  EXPECT_EQ(sky.error().code, ErrorCode::kOffMap);
  ASSERT_EQ(sky.error().faults.size(), 3U);
  EXPECT_EQ(sky.error().faults[0].pointer, "/place");
  EXPECT_NE(sky.error().faults[0].message.find("(5, 6) m is off the map"), std::string::npos);
  EXPECT_EQ(sky.error().faults[1].pointer, "/from");
  EXPECT_EQ(sky.error().faults[2].pointer, "/to");
}

TEST(PlaceSky, ASolRunsFromMidnightToMidnightInStepsOfAQuarterOfAnHour) {
  const auto site = shipped("gale");
  const std::int64_t asked = utc_of_text("2016-03-22T09:00:00Z").value();
  const auto sky = sky_over(*site, 8142566.0, -276711.0, asked, {});
  ASSERT_TRUE(sky) << sky.error().detail;
  const PlaceSky::Seen &first = sky->moments.front(), &last = sky->moments.back();
  EXPECT_LE(first.moment.utc_ms, asked);
  EXPECT_GE(last.moment.utc_ms, asked);
  EXPECT_NEAR(static_cast<double>(last.moment.utc_ms - first.moment.utc_ms) / 1000.0, 88775.2, 60.0);
  for (const PlaceSky::Seen* const end : {&first, &last}) {
    const double hours = end->moment.time.true_solar_h;
    EXPECT_NEAR(std::min(hours, 24.0 - hours), 0.0, 1e-4);
    EXPECT_FALSE(end->is_lit);
  }
  int lit = 0;
  for (std::size_t k = 1; k < sky->moments.size(); ++k) {
    const PlaceSky::Seen& at = sky->moments[k];
    EXPECT_LE(at.moment.utc_ms - sky->moments[k - 1].moment.utc_ms, 900'001);
    EXPECT_EQ(at.is_lit, at.moment.sun.elevation_rad > at.horizon_rad);
    EXPECT_GE(at.horizon_rad, 0.0);
    lit += at.is_lit ? 1 : 0;
  }
  EXPECT_GT(lit, 40) << "near the equator";
  EXPECT_LT(lit, 52);
  const PlaceSky::Seen& noon = sky->moments[sky->moments.size() / 2];
  EXPECT_NEAR(noon.moment.time.true_solar_h, 12.0, 0.3);
  EXPECT_TRUE(noon.is_lit);
}

TEST(PlaceSky, IsThatOfOneMomentWhereBothTimesAreOne) {
  const std::int64_t at = utc_of_text("2016-03-22T09:00:00Z").value();
  const auto sky = sky_over(*shipped("gale"), 8142566.0, -276711.0, at, at);
  ASSERT_TRUE(sky);
  ASSERT_EQ(sky->moments.size(), 1U);
  EXPECT_EQ(sky->moments[0].moment.utc_ms, at);
}

}  // namespace
}  // namespace slipway::api
