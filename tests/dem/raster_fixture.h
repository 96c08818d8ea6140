#pragma once

#include <gdal_priv.h>

#include <array>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "dem/elevation_source.h"

namespace slipway::dem::test {

inline constexpr const char* kMarsSphere = "+proj=eqc +lat_ts=0 +lon_0=0 +R=3396190 +units=m +no_defs";

// A folder that is the test's own and goes away with it.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  std::filesystem::path write(const std::string& name, const std::string& text) const;

 private:
  std::filesystem::path path_;
};

// A GeoTIFF as a test wants it, also as it must not be.
struct RasterOptions {
  int rows = 4;
  int columns = 5;
  int bands = 1;
  GDALDataType type = GDT_Float32;
  std::array<double, 6> transform{100.0, 2.0, 0.0, 200.0, 0.0, -3.0};
  bool has_transform = true;
  std::string crs = kMarsSphere;  // anything OGR understands; empty: none
  std::vector<std::string> creation{};
  std::vector<float> cells{};  // the first band, row by row; empty: not written
  std::function<void(GDALDataset&)> also{};
  std::vector<int> overviews{};  // factors; their cells are means
};

// Makes it in memory (the library fences GDAL off from writing files) and copies its bytes to the path.
void write_geotiff(const std::filesystem::path& path, const RasterOptions& options);

// Opens the file with GDAL itself, from a copy in memory.
void with_gdal(const std::filesystem::path& path, const std::function<void(GDALDataset&)>& body);

// What GDAL itself says is at a place: the value of the cell, as gdallocationinfo -geoloc finds it.
double gdal_value_at(const std::filesystem::path& path, double x, double y);

// The library prepares GDAL in the first session; a test that uses GDAL before that calls this.
void prepare_gdal();

}  // namespace slipway::dem::test
