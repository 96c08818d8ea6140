#include "raster_fixture.h"

#include <cpl_vsi.h>
#include <gdal_frmts.h>
#include <ogr_spatialref.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <stdexcept>

#include "dem/write/hillshade.h"

namespace slipway::dem::test {
namespace {

constexpr const char* kInMemory = "/vsimem/fixture.tif";

void require(bool holds, const char* what) {
  if (!holds) throw std::runtime_error(what);
}

}  // namespace

void prepare_gdal() {
  require(encode_png({0}, 1, 1).has_value(), "no session");
}

TemporaryFolder::TemporaryFolder() {
  std::string pattern = (std::filesystem::temp_directory_path() / "dem_test_XXXXXX").string();
  require(mkdtemp(pattern.data()) != nullptr, "no temporary folder");
  path_ = pattern;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

std::filesystem::path TemporaryFolder::write(const std::string& name, const std::string& text) const {
  std::ofstream(path_ / name, std::ios::binary) << text;
  return path_ / name;
}

void write_geotiff(const std::filesystem::path& path, const RasterOptions& options) {
  prepare_gdal();
  CPLStringList creation;
  for (const std::string& option : options.creation) creation.AddString(option.c_str());
  GDALDatasetUniquePtr raster(GetGDALDriverManager()->GetDriverByName("GTiff")->Create(
      kInMemory, options.columns, options.rows, options.bands, options.type, creation.List()));
  require(raster != nullptr, "the fixture could not be created");
  if (options.has_transform) {
    std::array<double, 6> transform = options.transform;
    raster->SetGeoTransform(transform.data());
  }
  if (!options.crs.empty()) {
    OGRSpatialReference crs;
    require(crs.SetFromUserInput(options.crs.c_str()) == OGRERR_NONE, "the fixture's CRS is not understood");
    raster->SetSpatialRef(&crs);
  }
  if (options.also) options.also(*raster);
  if (!options.cells.empty()) {
    std::vector<float> cells = options.cells;
    require(
        cells.size() == static_cast<std::size_t>(options.rows) * static_cast<std::size_t>(options.columns),
        "the fixture has another number of cells");
    require(raster->GetRasterBand(1)->RasterIO(GF_Write, 0, 0, options.columns, options.rows, cells.data(),
                                               options.columns, options.rows, GDT_Float32, 0, 0,
                                               nullptr) == CE_None,
            "the fixture's cells could not be written");
  }
  if (!options.overviews.empty())
    require(raster->BuildOverviews("AVERAGE", static_cast<int>(options.overviews.size()),
                                   options.overviews.data(), 0, nullptr, GDALDummyProgress, nullptr,
                                   nullptr) == CE_None,
            "the fixture's overviews could not be made");
  raster.reset();
  vsi_l_offset size = 0;
  GByte* bytes = VSIGetMemFileBuffer(kInMemory, &size, TRUE);
  require(bytes != nullptr, "the fixture is empty");
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes), static_cast<std::streamsize>(size));
  VSIFree(bytes);
}

void with_gdal(const std::filesystem::path& path, const std::function<void(GDALDataset&)>& body) {
  prepare_gdal();
  std::ifstream file(path, std::ios::binary);
  std::string bytes((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  VSIFCloseL(VSIFileFromMemBuffer(kInMemory, reinterpret_cast<GByte*>(bytes.data()), bytes.size(), FALSE));
  {
    const GDALDatasetUniquePtr raster(GDALDataset::Open(kInMemory));
    require(raster != nullptr, "GDAL can't open the fixture");
    body(*raster);
  }
  VSIUnlink(kInMemory);
}

double gdal_value_at(const std::filesystem::path& path, double x, double y) {
  double value = std::nan("");
  with_gdal(path, [&](GDALDataset& raster) {
    std::array<double, 6> forward{};
    std::array<double, 6> inverse{};
    raster.GetGeoTransform(forward.data());
    require(GDALInvGeoTransform(forward.data(), inverse.data()) != 0, "the grid can't be inverted");
    const int column = static_cast<int>(std::floor(inverse[0] + inverse[1] * x + inverse[2] * y));
    const int row = static_cast<int>(std::floor(inverse[3] + inverse[4] * x + inverse[5] * y));
    require(raster.GetRasterBand(1)->RasterIO(GF_Read, column, row, 1, 1, &value, 1, 1, GDT_Float64, 0, 0,
                                              nullptr) == CE_None,
            "GDAL can't read the fixture");
  });
  return value;
}

}  // namespace slipway::dem::test
