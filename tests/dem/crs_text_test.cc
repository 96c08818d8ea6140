#include "dem/crs/crs_text.h"

#include <gtest/gtest.h>

#include <string>

#include "dem/crs/gdal_named_crs.h"
#include "dem/gdal_session.h"
#include "raster_fixture.h"

namespace slipway::dem {
namespace {

constexpr const char* kDegrees =
    R"(GEOGCS["g",DATUM["d",SPHEROID["s",3396190,0]],PRIMEM["r",0],UNIT["degree",0.01745]])";

TEST(CrsText, CodesProjStringsAndTreesAreTaken) {
  const GdalSession session;
  for (const std::string& text :
       {std::string("EPSG:32633"), std::string("epsg:4326"), std::string("IAU_2015:49910"),
        std::string("IAU:2015:49910"), std::string("ESRI:102100"), std::string("OGC:CRS84"),
        std::string("urn:ogc:def:crs:EPSG::4326"), std::string("urn:ogc:def:crs:OGC:1.3:CRS84"),
        std::string("urn:ogc:def:crs:IAU_2015::49900"), std::string(test::kMarsSphere),
        std::string("+proj=longlat +R=3396190 +no_defs"),
        std::string(
            " +proj=tmerc +lat_0=36.8 +lon_0=-3.75 +k=1 +a=6378137 +b=6356752.3142 +units=m +type=crs\n"),
        std::string(kDegrees)}) {
    EXPECT_EQ(fault_of_crs_text(text), std::nullopt) << text;
    EXPECT_TRUE(named_crs(text)) << text;
  }
  // As a tree in JSON.
  char* json = nullptr;
  ASSERT_EQ(named_crs("EPSG:32633")->exportToPROJJSON(&json, nullptr), OGRERR_NONE);
  EXPECT_TRUE(named_crs(json));
  CPLFree(json);
}

TEST(CrsText, WhatNamesAFileOrAnAddressIsRefused) {
  for (const std::string text :
       {"+init=/etc/passwd:1",
        "+init=epsg:4326",
        "init=/etc/passwd:1",
        "+init=../../secret:1",
        "+init=/dev/stdin:1",
        "+proj=longlat +R=1 +nadgrids=/etc/passwd",
        "+proj=longlat +R=1 +nadgrids=@null",
        "+proj=longlat +R=1 +geoidgrids=x",
        "+proj=longlat +R=1 +catalog=x",
        "+proj=longlat\t+init=/x:1",
        "+proj=longlat\v+init=/x:1",
        "+proj=longlat ++init=/x:1",
        "+proj=/etc/passwd",
        "+proj=longlat +ellps=../x",
        "proj=pipeline step init=/etc/passwd:1",
        "/etc/passwd",
        "../secret.wkt",
        "C:\\secret.prj",
        "file:///etc/passwd",
        "https://example.org/crs.wkt",
        "http://www.opengis.net/def/crs/EPSG/0/4326",
        "PROJ:/etc/passwd",
        "EPSG:../../x",
        "ESRI::/etc/passwd",
        "",
        " ",
        "WGS84x",
        R"(PROJCS["x",EXTENSION["PROJ4","+init=/etc/passwd:1"]])",
        R"(BOUNDCRS[SOURCECRS[],TARGETCRS[],ABRIDGEDTRANSFORMATION["t",PARAMETERFILE["f","/etc/passwd"]]])",
        R"(PROJCRS["x",CONVERSION["c",METHOD["PROJ longlat init=/etc/passwd:1"]]])",
        R"({"type":"BoundCRS"})",
        R"({"type":"\u0042oundCRS"})"}) {
    const auto fault = fault_of_crs_text(text);
    ASSERT_TRUE(fault) << text;
    EXPECT_FALSE(named_crs(text)) << text;
  }
  for (const std::string before : {"EPSG:", "", "+proj=", "{", "GEOGCS["})
    static_cast<void>(fault_of_crs_text(before + std::string(1'000'000, 'A')));  // ends
  EXPECT_TRUE(fault_of_crs_text("EPSG:" + std::string(1'000'000, 'A')));
  EXPECT_FALSE(fault_of_crs_text(R"(PROJCS["the extension of the map"])"));
  EXPECT_NE(fault_of_crs_text("+init=/x:1")->find("+proj=eqc +R=3396190"), std::string::npos) << "no remedy";
}

}  // namespace
}  // namespace slipway::dem
