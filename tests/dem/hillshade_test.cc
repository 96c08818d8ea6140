#include "dem/write/hillshade.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "core/angle.h"
#include "dem/synthetic_terrain.h"
#include "dem/write/rgba_image.h"
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

// The colour of a pixel of a decoded picture, whether it has a palette or not.
Rgba colour_at(GDALDataset& raster, int row, int column) {
  std::array<std::uint8_t, 4> value{0, 0, 0, 0xff};
  const int bands = raster.GetRasterCount();
  for (int band = 0; band < bands; ++band)
    EXPECT_EQ(raster.GetRasterBand(band + 1)->RasterIO(GF_Read, column, row, 1, 1,
                                                       &value[static_cast<std::size_t>(band)], 1, 1, GDT_Byte,
                                                       0, 0, nullptr),
              CE_None);
  if (bands > 1) return value;
  const GDALColorTable* const palette = raster.GetRasterBand(1)->GetColorTable();
  if (palette == nullptr) return {value[0], value[0], value[0], 0xff};
  const GDALColorEntry* const entry = palette->GetColorEntry(value[0]);
  return {static_cast<std::uint8_t>(entry->c1), static_cast<std::uint8_t>(entry->c2),
          static_cast<std::uint8_t>(entry->c3), static_cast<std::uint8_t>(entry->c4)};
}

// Encodes a picture, expects every pixel of it to come back, and counts the bands it took.
int bands_of(const RgbaImage& image) {
  const auto png = encode_png(image);
  if (!png) return 0;
  const test::TemporaryFolder folder;
  int bands = 0;
  test::with_gdal(folder.write("image.png", *png), [&](GDALDataset& raster) {
    bands = raster.GetRasterCount();
    for (int row = 0; row < image.rows; ++row)
      for (int column = 0; column < image.columns; ++column)
        EXPECT_EQ(colour_at(raster, row, column), image.at(row, column)) << row << " " << column;
  });
  return bands;
}

TEST(EncodePng, ColoursAndOpacityComeBackAsTheyWereAndUpTo256OfThemTakeOneBand) {
  RgbaImage image(16, 17);
  for (int row = 0; row < 16; ++row)
    for (int column = 0; column < 16; ++column)
      image.at(row, column) = {static_cast<std::uint8_t>(15 * row), static_cast<std::uint8_t>(14 * column), 7,
                               static_cast<std::uint8_t>(255 - 12 * row)};
  for (int row = 0; row < 16; ++row) image.at(row, 16) = image.at(row, 3);
  EXPECT_EQ(bands_of(image), 1);
  image.at(15, 16) = {1, 2, 3, 4};  // the 257th
  EXPECT_EQ(bands_of(image), 4);
  EXPECT_FALSE(encode_png(RgbaImage(0, 4)));
}

TEST(EncodePng, ShadesOfGreyTakeOneBandAndWhatIsTransparentStaysSo) {
  RgbaImage image(2, 3);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    const auto grey = static_cast<std::uint8_t>(40 * i);
    image.pixels[i] = {grey, grey, grey, 0xff};
  }
  EXPECT_EQ(bands_of(image), 1);
  image.at(0, 0)[3] = 0;
  EXPECT_EQ(bands_of(image), 1);
}

TEST(EncodePng, AnotherNumberOfPixelsIsRefused) {
  EXPECT_FALSE(encode_png({1, 2, 3}, 2, 2));
  EXPECT_FALSE(encode_png({}, 0, 0));
}

}  // namespace
}  // namespace slipway::dem
