#include <arpa/inet.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/inotify.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <fstream>
#include <memory>
#include <stdexcept>

#include "dem/elevation_source.h"
#include "dem/gdal_session.h"
#include "dem/soil_map.h"
#include "raster_fixture.h"

namespace slipway::dem {
namespace {

// A listening socket on this machine that records whether anyone has connected.
class Listener {
 public:
  Listener() : socket_(socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof(address);
    auto* generic = reinterpret_cast<sockaddr*>(&address);
    if (bind(socket_, generic, size) != 0 || listen(socket_, 8) != 0 ||
        getsockname(socket_, generic, &size) != 0) {
      throw std::runtime_error("no listening socket");
    }
    port_ = ntohs(address.sin_port);
    // The listener accepts connections and never answers, so that without a fence a request would wait for
    // ever instead of failing the test.
    CPLSetConfigOption("GDAL_HTTP_TIMEOUT", "2");
  }
  ~Listener() { close(socket_); }
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;

  std::string url(const std::string& file) const {
    return fmt::format("http://127.0.0.1:{}/{}", port_, file);
  }
  bool was_asked() const {
    pollfd waiting{.fd = socket_, .events = POLLIN, .revents = 0};
    return poll(&waiting, 1, 200) > 0;
  }
  int port() const { return port_; }

 private:
  int socket_;
  int port_ = 0;
};

TEST(Network, AListenerHearsAConnection) {  // so that the silence below means something
  const Listener listener;
  const int client = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(static_cast<std::uint16_t>(listener.port()));
  ASSERT_EQ(connect(client, reinterpret_cast<sockaddr*>(&address), sizeof(address)), 0);
  EXPECT_TRUE(listener.was_asked());
  close(client);
}

TEST(Network, AGeoTiffThatNamesItsOverviewsByAddressMakesNoRequest) {
  const Listener listener;
  const test::TemporaryFolder folder;
  test::RasterOptions options{.cells = std::vector<float>(20, 1.0F)};
  options.also = [&](GDALDataset& raster) {
    raster.SetMetadataItem("OVERVIEW_FILE", ("/vsicurl/" + listener.url("o.tif")).c_str(), "OVERVIEWS");
  };
  test::write_geotiff(folder / "dem.tif", options);
  const auto source = open_elevation(folder / "dem.tif");
  ASSERT_TRUE(source);
  EXPECT_TRUE((*source)->read((*source)->info().geometry.extent()));
  // Reading at full resolution has no use for overviews; asking for them is what follows the address.
  test::with_gdal(folder / "dem.tif",
                  [](GDALDataset& raster) { EXPECT_EQ(raster.GetRasterBand(1)->GetOverviewCount(), 0); });
  EXPECT_FALSE(listener.was_asked());
}

TEST(Network, GdalItselfCanNoLongerReachTheNetworkOrAFileOnceTheServiceUsesIt) {
  const Listener listener;
  const test::TemporaryFolder folder;
  test::write_geotiff(folder / "dem.tif", {});  // prepares GDAL
  for (const char* prefix :
       {"/vsicurl/", "/vsicurl?url=", "/vsicurl_streaming/", "/vsis3/", "/vsigzip//vsicurl/"}) {
    EXPECT_EQ(VSIFOpenL((prefix + listener.url("x.tif")).c_str(), "rb"), nullptr) << prefix;
    EXPECT_EQ(GDALDataset::Open((prefix + listener.url("x.tif")).c_str()), nullptr) << prefix;
  }
  EXPECT_EQ(VSIFOpenL((folder / "dem.tif").c_str(), "rb"), nullptr);
  EXPECT_EQ(VSIFOpenL((folder / "new.tif").c_str(), "wb"), nullptr);
  OGRSpatialReference crs;
  EXPECT_NE(crs.importFromUrl(listener.url("crs").c_str()), OGRERR_NONE);
  EXPECT_FALSE(listener.was_asked());
}

// A file of definitions that PROJ itself understands, and whether anybody has opened it.
class ProjectionFence : public testing::Test {
 protected:
  ProjectionFence() { inotify_add_watch(watch_, definitions_.c_str(), IN_OPEN); }
  ~ProjectionFence() override { close(watch_); }
  bool was_opened() const {
    std::array<char, 4096> events{};
    return read(watch_, events.data(), events.size()) > 0;
  }
  std::string init() const { return "+init=" + definitions_ + ":1"; }

  const test::TemporaryFolder folder_;
  const std::string definitions_ = folder_.write("definitions", "<1> +proj=eqc +R=1737400 +units=m <>\n");

 private:
  const int watch_ = inotify_init1(IN_NONBLOCK | IN_CLOEXEC);
};

TEST_F(ProjectionFence, TheWatchSeesAnOpenedFile) {  // so that the silence below means something
  EXPECT_FALSE(was_opened());
  std::ifstream(definitions_).get();
  EXPECT_TRUE(was_opened());
}

TEST_F(ProjectionFence, ProjOpensNoFileButThoseOfItsDatabase) {
  // A context of before the fence, as GDAL's other users have one.
  OGRSpatialReference before;
  ASSERT_EQ(before.importFromEPSG(4326), OGRERR_NONE);
  const GdalSession session(folder_ / "dem.tif");
  OGRSpatialReference crs;
  EXPECT_EQ(crs.SetFromUserInput("IAU_2015:49910"), OGRERR_NONE);
  EXPECT_NE(crs.SetFromUserInput(init().c_str()), OGRERR_NONE);
  EXPECT_FALSE(was_opened());
  // As a .prj or a GeoTIFF can have it.
  const std::string wkt =
      R"(PROJCS["x",GEOGCS["g",DATUM["d",SPHEROID["s",3396190,0]],PRIMEM["r",0],UNIT["degree",0.01745]],)"
      R"(PROJECTION["custom_proj4"],UNIT["m",1],EXTENSION["PROJ4","+proj=merc )" +
      init() + R"("]])";
  crs.importFromWkt(wkt.c_str());
  EXPECT_FALSE(was_opened());
}

TEST_F(ProjectionFence, NoGridOfATextIsOpened) {
  const GdalSession session(folder_ / "dem.tif");
  OGRSpatialReference from, to;
  ASSERT_EQ(from.SetFromUserInput(("+proj=longlat +R=3396190 +nadgrids=" + definitions_).c_str()),
            OGRERR_NONE);
  ASSERT_EQ(to.SetFromUserInput("EPSG:4326"), OGRERR_NONE);
  const std::unique_ptr<OGRCoordinateTransformation> between(OGRCreateCoordinateTransformation(&from, &to));
  double x = 1.0, y = 2.0;
  if (between) between->Transform(1, &x, &y);
  EXPECT_FALSE(was_opened());
}

TEST_F(ProjectionFence, AGeoJsonCannotNameAFileOfDefinitions) {
  test::write_geotiff(folder_ / "dem.tif", {});
  const auto ground = open_elevation(folder_ / "dem.tif").value()->info();
  for (const std::string& name : {init(), definitions_, "proj=eqc init=" + definitions_ + ":1"}) {
    const auto path = folder_.write(
        "units.geojson",
        fmt::format(
            R"({{"type":"FeatureCollection","crs":{{"type":"name","properties":{{"name":"{}"}}}},"features":[]}})",
            name));
    const auto read = read_soil_polygons(path, ground, ground.geometry.extent(), "Name",
                                         PolygonCoordinates::kLongitudeLatitude, {});
    ASSERT_FALSE(read) << name;
    EXPECT_EQ(read.error().faults.front().pointer, "/crs");
    EXPECT_FALSE(was_opened());
  }
}

TEST(Network, AGeoJsonThatNamesItsCrsByAddressMakesNoRequest) {
  const Listener listener;
  const test::TemporaryFolder folder;
  test::write_geotiff(folder / "dem.tif", {});
  const auto ground = open_elevation(folder / "dem.tif").value()->info();
  const auto path = folder.write(
      "units.geojson",
      fmt::format(
          R"({{"type":"FeatureCollection","crs":{{"type":"link","properties":{{"href":"{}","type":"proj4"}}}},
      "features":[]}})",
          listener.url("crs")));
  EXPECT_TRUE(
      read_soil_polygons(path, ground, ground.geometry.extent(), "Name", PolygonCoordinates::kMap, {}));
  EXPECT_FALSE(listener.was_asked());
}

}  // namespace
}  // namespace slipway::dem
