#include "dem/hillshade.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/angle.h"
#include "dem/rgba_image.h"
#include "dem/synthetic_terrain.h"
#include "raster_fixture.h"

namespace slipway::dem {
namespace {

TEST(Hillshade, LevelGroundIsAsBrightAsTheSineOfTheSunsElevation) {
  const auto grey = hillshade(*make_plane({}, 0.0), rad_from_deg(315.0), rad_from_deg(30.0), 1.0);
  EXPECT_EQ(grey.size(), 6400U);
  EXPECT_EQ(grey.at(3210), 128);  // 1 + 254 sin 30
}

TEST(Hillshade, ASlopeThatFacesTheSunIsBrightestAndOneThatTurnsAwayIsDark) {
  const double slope = rad_from_deg(30.0);
  const auto facing_east = make_ramp({}, slope, rad_from_deg(180.0));  // rises to the west
  const auto grey_at = [&](double sun_azimuth_deg) {
    return hillshade(*facing_east, rad_from_deg(sun_azimuth_deg), rad_from_deg(60.0), 1.0).at(3210);
  };
  EXPECT_EQ(grey_at(90.0), 255);
  EXPECT_EQ(grey_at(270.0), 128);
  EXPECT_GT(grey_at(45.0), grey_at(0.0));
}

TEST(Hillshade, OnlyMaskedCellsAreZero) {
  const Terrain terrain({.rows = 2, .columns = 2}, {0.0F, 50.0F, 0.0F, 0.0F}, {1, 1, 0, 1});
  const auto grey = hillshade(terrain, 0.0, 0.1, 1.0);
  EXPECT_EQ(grey[2], 0);
  for (const std::size_t i : {0U, 1U, 3U}) EXPECT_GE(grey[i], 1);
}

TEST(EncodePng, TheImageComesBackAsItWas) {
  std::vector<std::uint8_t> grey(35);
  for (std::size_t i = 0; i < grey.size(); ++i) grey[i] = static_cast<std::uint8_t>(7 * i);
  const auto png = encode_png(grey, 5, 7);
  ASSERT_TRUE(png);
  EXPECT_EQ(png->substr(1, 3), "PNG");
  const test::TemporaryFolder folder;
  const auto path = folder.write("image.png", *png);
  for (int row = 0; row < 5; ++row) {
    for (int column = 0; column < 7; ++column) {
      ASSERT_EQ(test::gdal_value_at(path, column + 0.5, row + 0.5),
                grey[static_cast<std::size_t>(7 * row + column)]);
    }
  }
}

TEST(EncodePng, ColoursAndOpacityComeBackAsTheyWere) {
  RgbaImage image(3, 4);
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column)
      image.at(row, column) = {static_cast<std::uint8_t>(80 * row), static_cast<std::uint8_t>(60 * column), 7,
                               static_cast<std::uint8_t>(255 - 20 * row)};
  const auto png = encode_png(image);
  ASSERT_TRUE(png);
  const test::TemporaryFolder folder;
  test::with_gdal(folder.write("image.png", *png), [&](GDALDataset& raster) {
    ASSERT_EQ(raster.GetRasterCount(), 4);
    for (int band = 0; band < 4; ++band) {
      for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 4; ++column) {
          std::uint8_t value = 0;
          ASSERT_EQ(raster.GetRasterBand(band + 1)->RasterIO(GF_Read, column, row, 1, 1, &value, 1, 1,
                                                             GDT_Byte, 0, 0, nullptr),
                    CE_None);
          EXPECT_EQ(value, image.at(row, column)[static_cast<std::size_t>(band)]);
        }
      }
    }
  });
  EXPECT_FALSE(encode_png(RgbaImage(0, 4)));
}

TEST(EncodePng, OpaqueGreyTakesOneBand) {
  RgbaImage image(2, 3);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    const auto grey = static_cast<std::uint8_t>(40 * i);
    image.pixels[i] = {grey, grey, grey, 0xff};
  }
  const auto bands_of = [](const RgbaImage& drawn) {
    const auto png = encode_png(drawn);
    if (!png) return 0;
    const test::TemporaryFolder folder;
    int bands = 0;
    test::with_gdal(folder.write("image.png", *png), [&](GDALDataset& raster) {
      bands = raster.GetRasterCount();
      std::uint8_t last = 0;
      EXPECT_EQ(raster.GetRasterBand(1)->RasterIO(GF_Read, 2, 1, 1, 1, &last, 1, 1, GDT_Byte, 0, 0, nullptr),
                CE_None);
      EXPECT_EQ(last, drawn.at(1, 2)[0]);
    });
    return bands;
  };
  EXPECT_EQ(bands_of(image), 1);
  image.at(0, 0)[3] = 0;  // what is transparent stays so
  EXPECT_EQ(bands_of(image), 4);
}

TEST(EncodePng, AnotherNumberOfPixelsIsRefused) {
  EXPECT_FALSE(encode_png({1, 2, 3}, 2, 2));
  EXPECT_FALSE(encode_png({}, 0, 0));
}

}  // namespace
}  // namespace slipway::dem
