// A raster's tiles as a GDAL dataset, whose copy by the COG driver is the file.

#include <cpl_string.h>
#include <fmt/format.h>
#include <gdal_frmts.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <algorithm>
#include <cstring>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "dem/gdal_import.h"
#include "dem/gdal_memory_file.h"
#include "dem/gdal_session.h"
#include "dem/write/cog.h"
#include "dem/write/gdal_cog_copy.h"

namespace slipway::dem {
namespace {

GDALColorTable colours_of(const RasterLayer& layer) {
  GDALColorTable table;
  for (const RasterClass& each : layer.classes) {
    const GDALColorEntry entry{each.colour[0], each.colour[1], each.colour[2], 255};
    table.SetColorEntry(each.value, &entry);
  }
  return table;
}

class TilesDataset;

class TilesBand final : public GDALRasterBand {
 public:
  TilesBand(TilesDataset& dataset, int level);
  ~TilesBand() override;

  double GetNoDataValue(int* given) override;
  const char* GetUnitType() override;
  GDALColorTable* GetColorTable() override;
  GDALColorInterp GetColorInterpretation() override;
  int GetOverviewCount() override;
  GDALRasterBand* GetOverview(int index) override;

 protected:
  CPLErr IReadBlock(int column, int row, void* cells) override;

 private:
  TilesDataset& of_;
  int level_;
};

// One level of a raster; level 0 has the others as its overviews.
class TilesDataset final : public GDALDataset {
 public:
  TilesDataset(const RasterLayer& of_layer, const TileStore& of_tiles, int level)
      : layer(of_layer), tiles(of_tiles), colours(colours_of(of_layer)) {
    const LevelSize size = size_of_level(layer.geometry, level);
    nRasterXSize = size.columns;
    nRasterYSize = size.rows;
    if (!layer.crs_wkt.empty()) {
      crs.importFromWkt(layer.crs_wkt.c_str());
      crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    }
    SetBand(1, new TilesBand(*this, level));
    if (level > 0) return;
    for (const auto& [name, value] : layer.metadata) SetMetadataItem(name.c_str(), value.c_str());
    SetMetadataItem("AREA_OR_POINT", "Area");
    GDALRasterBand& band = *GetRasterBand(1);
    band.SetDescription(layer.description.c_str());
    for (const auto& [name, value] : layer.band_metadata) band.SetMetadataItem(name.c_str(), value.c_str());
    for (const RasterClass& each : layer.classes)
      band.SetMetadataItem(fmt::format("CLASS_{}", each.value).c_str(), each.name.c_str());
    for (int k = 1; k < levels_of(layer.geometry); ++k)
      overviews.push_back(std::make_unique<TilesDataset>(layer, tiles, k));
  }

  CPLErr GetGeoTransform(double* transform) override {
    const GridGeometry& g = layer.geometry;
    const std::array<double, 6> values{g.west_m, g.cell_x_m, 0.0, g.north_m, 0.0, -g.cell_y_m};
    std::copy(values.begin(), values.end(), transform);
    return CE_None;
  }
  const OGRSpatialReference* GetSpatialRef() const override { return layer.crs_wkt.empty() ? nullptr : &crs; }

  const RasterLayer& layer;
  const TileStore& tiles;
  GDALColorTable colours;
  OGRSpatialReference crs;
  std::vector<std::unique_ptr<TilesDataset>> overviews;
};

TilesBand::TilesBand(TilesDataset& dataset, int level) : of_(dataset), level_(level) {
  poDS = &dataset;
  nBand = 1;
  eDataType = dataset.layer.of_classes ? GDT_Byte : GDT_Float32;
  nBlockXSize = nBlockYSize = kTileSide;
}

TilesBand::~TilesBand() = default;

double TilesBand::GetNoDataValue(int* given) {
  if (given != nullptr) *given = TRUE;
  return of_.layer.nodata;
}

const char* TilesBand::GetUnitType() {
  return of_.layer.unit.c_str();
}

GDALColorTable* TilesBand::GetColorTable() {
  return of_.layer.of_classes ? &of_.colours : nullptr;
}

GDALColorInterp TilesBand::GetColorInterpretation() {
  return of_.layer.of_classes ? GCI_PaletteIndex : GCI_GrayIndex;
}

int TilesBand::GetOverviewCount() {
  return static_cast<int>(of_.overviews.size());
}

GDALRasterBand* TilesBand::GetOverview(int index) {
  if (index < 0 || index >= GetOverviewCount()) return nullptr;
  return of_.overviews[static_cast<std::size_t>(index)]->GetRasterBand(1);
}

CPLErr TilesBand::IReadBlock(int column, int row, void* cells) {
  const auto bytes = of_.tiles.read({level_, row, column});
  if (!bytes) {
    CPLError(CE_Failure, CPLE_FileIO, "%s", bytes.error().detail.c_str());
    return CE_Failure;
  }
  std::memcpy(cells, bytes->data(), bytes->size());
  return CE_None;
}

void register_cog() {
  static std::once_flag once;
  std::call_once(once, &GDALRegister_COG);
}

// Copies the tiles to a file of this name.
Result<void> copy_to(const std::string& name, const RasterLayer& layer, const TileStore& tiles,
                     std::size_t threads, const GdalSession& session, Progress& progress) {
  TilesDataset source(layer, tiles, 0);
  CPLStringList options;
  options.AddNameValue("BLOCKSIZE", std::to_string(kTileSide).c_str());
  options.AddNameValue("LEVEL", "6");
  options.AddNameValue("PREDICTOR", layer.of_classes ? "NO" : "YES");
  return copy_as_cog(name, source, std::move(options), threads, session, progress);
}

}  // namespace

Result<void> copy_as_cog(const std::string& name, GDALDataset& source, CPLStringList options,
                         std::size_t threads, const GdalSession& session, Progress& progress) {
  register_cog();
  options.AddNameValue("COMPRESS", "DEFLATE");
  options.AddNameValue("BIGTIFF", "IF_SAFER");
  options.AddNameValue("NUM_THREADS", threads == 0 ? "ALL_CPUS" : std::to_string(threads).c_str());
  StageProgress told{&progress, "writing the map"};
  CPLErrorReset();
  GDALDatasetUniquePtr made(GetGDALDriverManager()->GetDriverByName("COG")->CreateCopy(
      name.c_str(), &source, FALSE, options.List(), &report_stage, &told));
  const bool complete = made != nullptr;
  made.reset();
  if (progress.cancelled()) return fail(ErrorCode::kCancelled, "the map was given up");
  if (complete && CPLGetLastErrorType() < CE_Failure) return {};
  return fail(ErrorCode::kUnwritableFile, "The map could not be written: " + session.complaints());
}

void remove_unfinished_cog(const std::filesystem::path& file) {
  std::error_code ignored;
  for (const char* const ending : {"", ".ovr.tmp", ".msk.ovr.tmp"})
    std::filesystem::remove(file.string() + ending, ignored);
}

Result<void> write_cog(const std::filesystem::path& out, const RasterLayer& layer, const TileStore& tiles,
                       std::size_t threads, Progress& progress) {
  const std::filesystem::path whole = std::filesystem::absolute(out);
  const GdalSession session;
  const WritingAdmission writing(whole.parent_path());
  auto written = copy_to(whole.string(), layer, tiles, threads, session, progress);
  if (written) return {};
  remove_unfinished_cog(whole);
  return written;
}

Result<std::string> encode_cog(const RasterLayer& layer, const TileStore& tiles, std::size_t threads,
                               Progress& progress) {
  const GdalSession session;
  GdalMemoryFile memory(".tif");
  const auto written = copy_to(memory.name(), layer, tiles, threads, session, progress);
  auto bytes = memory.take();
  if (!written) return fail(written.error());
  if (!bytes) return fail(ErrorCode::kInternal, "The map could not be written: " + session.complaints());
  return *std::move(bytes);
}

}  // namespace slipway::dem
