#include "dem/ascii_terrain.h"

#include <gtest/gtest.h>

namespace slipway::dem {
namespace {

const AsciiOptions kOptions{
    .cell_m = 2.0, .height_step_m = 0.1, .default_soil = "firm", .soils = {{'a', "sand"}}};

TEST(AsciiTerrain, TheDrawingIsTheMapSeenFromAboveWithNorthUp) {
  const auto map = parse_ascii_terrain(R"(
    a 3 G
    S # 2a
  )",
                                       kOptions);
  ASSERT_TRUE(map);
  const Terrain& terrain = *map->terrain;
  EXPECT_EQ(terrain.geometry().extent(), (Extent{0.0, 0.0, 6.0, 4.0}));
  EXPECT_FLOAT_EQ(static_cast<float>(*terrain.height_m(Cell{0, 1})), 0.3F);
  EXPECT_FALSE(terrain.has_data({1, 1}));
  EXPECT_FLOAT_EQ(static_cast<float>(*terrain.height_m(Cell{1, 2})), 0.2F);
  EXPECT_EQ(map->start, (Pose2{1.0, 1.0, 0.0}));
  EXPECT_EQ(map->goal, (Pose2{5.0, 3.0, 0.0}));
}

TEST(AsciiTerrain, LettersAreSoilsAndEverythingElseLiesOnTheDefaultSoil) {
  const auto map = parse_ascii_terrain("a . ? 3a", kOptions);
  ASSERT_TRUE(map);
  const SoilMap& soil = *map->soil_map;
  const auto name = [&](double x_m) { return soil.soils().at(soil.soil_at(x_m, 1.0).value()); };
  EXPECT_EQ(name(1.0), "sand");
  EXPECT_EQ(name(3.0), "firm");
  EXPECT_FALSE(soil.soil_at(5.0, 1.0));
  EXPECT_EQ(name(7.0), "sand");
  EXPECT_DOUBLE_EQ(soil.unknown_fraction(), 0.25);
}

TEST(AsciiTerrain, WithoutADefaultSoilTheRestIsUnknownGround) {
  const auto map = parse_ascii_terrain("a . S", AsciiOptions{.soils = {{'a', "sand"}}});
  ASSERT_TRUE(map);
  EXPECT_NEAR(map->soil_map->unknown_fraction(), 2.0 / 3.0, 1e-15);
}

TEST(AsciiTerrain, AllFaultsAreReportedTogetherByRowAndColumn) {
  const auto map = parse_ascii_terrain("S S .\n. x .\n. !", kOptions);
  ASSERT_FALSE(map);
  EXPECT_EQ(map.error().code, ErrorCode::kUnreadableData);
  std::vector<std::string> pointers;
  for (const Fault& fault : map.error().faults) pointers.push_back(fault.pointer);
  EXPECT_EQ(pointers, (std::vector<std::string>{"/0/1", "/1/1", "/2/1", "/2"}));
}

TEST(AsciiTerrain, AnEmptyDrawingIsAFault) {
  EXPECT_FALSE(parse_ascii_terrain(" \n ", kOptions));
}

}  // namespace
}  // namespace slipway::dem
