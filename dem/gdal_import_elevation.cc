#include <cpl_string.h>
#include <fmt/format.h>
#include <ogr_spatialref.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <utility>

#include "dem/gdal_crs.h"
#include "dem/gdal_heights.h"
#include "dem/gdal_import.h"
#include "dem/gdal_impossible_heights.h"
#include "dem/terrain_import.h"

namespace slipway::dem {
namespace {

namespace fs = std::filesystem;
using GeoTransform = std::array<double, 6>;

constexpr float kNoHeight = std::numeric_limits<float>::lowest();  // as planetary maps have it
constexpr int kRowsAtOnce = 256;                                   // a row of tiles

// A raster whose cells are turned north-up and whose coordinates are metres, as far as that needs no new
// cells.
struct Arrangement {
  std::unique_ptr<OGRSpatialReference> crs;
  GeoTransform grid{};
  bool flips_rows = false, flips_columns = false;
  double metres_per_height = 1.0;
  bool reprojects = false;
  std::vector<std::string> changes;
};

struct Scan {
  double lowest_m = std::numeric_limits<double>::infinity(), highest_m = -lowest_m;
  long long heights = 0;
  ImpossibleHeights impossible;
};

std::unique_ptr<OGRSpatialReference> named_system(const std::string& name) {
  auto crs = std::make_unique<OGRSpatialReference>();
  const CPLStringList limits(
      CSLAddString(CSLAddString(nullptr, "ALLOW_NETWORK_ACCESS=NO"), "ALLOW_FILE_ACCESS=NO"), TRUE);
  if (crs->SetFromUserInput(name.c_str(), limits.List()) != OGRERR_NONE) return nullptr;
  return crs;
}

// Degrees that count to the west become degrees that count to the east.
void count_eastwards(Arrangement& a) {
  auto east = std::make_unique<OGRSpatialReference>();
  east->SetGeogCS("longitude to the east", "the map's own datum", "its ellipsoid", a.crs->GetSemiMajor(),
                  a.crs->GetInvFlattening());
  east->SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  a.crs = std::move(east);
  for (int i : {0, 1, 2}) a.grid[static_cast<std::size_t>(i)] = -a.grid[static_cast<std::size_t>(i)];
  a.changes.emplace_back("longitudes that counted to the west now count to the east");
}

// The same of map coordinates.
void count_eastings(Arrangement& a) {
  a.crs = eastward_projection(*a.crs);
  for (int i : {0, 1, 2}) a.grid[static_cast<std::size_t>(i)] = -a.grid[static_cast<std::size_t>(i)];
  a.changes.emplace_back("map coordinates that counted to the west now count to the east");
}

void turn_north_up(Arrangement& a, int rows, int columns) {
  if (a.grid[2] != 0.0 || a.grid[4] != 0.0) {
    a.reprojects = true;
    return;
  }
  if (a.grid[5] > 0.0) {
    a.flips_rows = true;
    a.grid[3] += rows * a.grid[5];
    a.grid[5] = -a.grid[5];
    a.changes.emplace_back("the first row was in the south; the rows were turned round");
  }
  if (a.grid[1] < 0.0) {
    a.flips_columns = true;
    a.grid[0] += columns * a.grid[1];
    a.grid[1] = -a.grid[1];
    a.changes.emplace_back("the first column was in the east; the columns were turned round");
  }
}

void measure_in_metres(Arrangement& a) {
  const double metres = a.crs->GetLinearUnits();
  if (a.crs->IsProjected() == 0 || std::abs(metres - 1.0) <= 1e-9) return;
  a.crs->SetLinearUnitsAndUpdateParameters(SRS_UL_METER, 1.0);
  for (double& coefficient : a.grid) coefficient *= metres;
  a.changes.push_back(fmt::format("map coordinates were multiplied by {} to be metres", metres));
}

// How cells and coordinates come to be in metres, north-up; nothing where that can't be.
Arrangement arrange(GDALDataset& dataset, const OGRSpatialReference& crs) {
  Arrangement a;
  a.crs.reset(crs.Clone());
  a.crs->SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  dataset.GetGeoTransform(a.grid.data());
  if (is_west_positive(*a.crs)) a.crs->IsGeographic() != 0 ? count_eastwards(a) : count_eastings(a);
  measure_in_metres(a);
  turn_north_up(a, dataset.GetRasterYSize(), dataset.GetRasterXSize());
  a.reprojects = a.reprojects || a.crs->IsGeographic() != 0;
  return a;
}

Extent extent_of(const Arrangement& a, int rows, int columns) {
  Extent extent{a.grid[0], a.grid[3], a.grid[0], a.grid[3]};
  for (const int row : {0, rows}) {
    for (const int column : {0, columns}) {
      const double x = a.grid[0] + column * a.grid[1] + row * a.grid[2];
      const double y = a.grid[3] + column * a.grid[4] + row * a.grid[5];
      extent = {std::min(extent.west_m, x), std::min(extent.south_m, y), std::max(extent.east_m, x),
                std::max(extent.north_m, y)};
    }
  }
  return extent;
}

// A conformal projection's scale leaves kMaxScaleError at an arc of about 16 degrees from its centre.
std::optional<std::string> fault_of_size(const Arrangement& a, const Extent& extent) {
  constexpr double kMaxArc_rad = 0.27, kRadPerDeg = std::numbers::pi / 180.0;
  double width = extent.east_m - extent.west_m, height = extent.north_m - extent.south_m;
  if (a.crs->IsGeographic() != 0) {
    width *= kRadPerDeg * std::cos(0.5 * (extent.north_m + extent.south_m) * kRadPerDeg);
    height *= kRadPerDeg;
  } else {
    width /= a.crs->GetSemiMajor();
    height /= a.crs->GetSemiMajor();
  }
  const double arc = 0.5 * std::hypot(width, height);
  if (arc <= kMaxArc_rad) return std::nullopt;
  return fmt::format(
      "reaches {:.0f} deg from its middle, where no map in metres has true lengths (at most {:.0f} deg). Cut "
      "a site out with: gdal_translate -projwin WEST NORTH EAST SOUTH, in the map's own coordinates",
      arc / kRadPerDeg, kMaxArc_rad / kRadPerDeg);
}

// All that is wrong with the raster but its cells. `a` is empty where the system is none.
std::vector<RasterFault> examine(GDALDataset& dataset, const OGRSpatialReference* crs,
                                 const std::string& file, Arrangement& a) {
  std::vector<RasterFault> faults = faults_of(dataset, crs, file, PlacelessRaster::kRefused);
  if (dataset.GetRasterCount() > 1) a.changes.emplace_back("the first of several bands was taken");
  if (dataset.GetRasterCount() > 0) {
    GDALRasterBand& band = *dataset.GetRasterBand(1);
    const HeightEncoding encoding = encoding_of(band);
    const auto metres = metres_of_unit(band.GetUnitType());
    if (const auto unit = check_height_unit(band, encoding, file); !unit)
      faults.push_back({unit.error().code, unit.error().detail, metres.has_value() && *metres != 1.0});
  }
  GeoTransform grid{};
  if (!can_be_reprojected(crs) || dataset.GetGeoTransform(grid.data()) != CE_None) return faults;
  Arrangement arranged = arrange(dataset, *crs);
  arranged.changes.insert(arranged.changes.begin(), a.changes.begin(), a.changes.end());
  a = std::move(arranged);
  if (a.crs->IsProjected() != 0 && crs->GetLinearUnits() != 1.0 && dataset.GetRasterCount() > 0 &&
      *dataset.GetRasterBand(1)->GetUnitType() == '\0')
    a.changes.push_back(fmt::format(
        "heights carry no unit and were taken as metres, though coordinates were not in metres; if heights "
        "are in feet too, say so and import again: gdal_edit.py -units ft {}",
        file));
  const Extent extent = extent_of(a, dataset.GetRasterYSize(), dataset.GetRasterXSize());
  if (a.crs->IsProjected() != 0) {
    const auto lengths = check_true_lengths(*a.crs, extent, file);
    if (!lengths) {
      a.reprojects = true;
      faults.push_back({lengths.error().code, lengths.error().detail, true});
    }
  }
  if (a.reprojects) {
    if (const auto size = fault_of_size(a, extent))
      faults.push_back({ErrorCode::kUnsupportedCrs, fmt::format("{} {}.", file, *size), false});
  }
  return faults;
}

// The heights row of tiles by row of tiles, in the arrangement's order.
class ArrangedHeights {
 public:
  ArrangedHeights(GDALRasterBand& band, const Arrangement& a)
      : band_(band), encoding_(encoding_of(band)), a_(a) {}

  int rows() const { return band_.GetYSize(); }
  int columns() const { return band_.GetXSize(); }

  // Rows [row, row + count); cells without a height are kNoHeight. The window where the file is damaged.
  std::optional<CellWindow> read(int row, int count, std::vector<float>& heights, Scan& scan) {
    const auto width = static_cast<std::size_t>(columns());
    const std::size_t cells = static_cast<std::size_t>(count) * width;
    heights.resize(cells);
    valid_.resize(cells);
    const CellWindow window{a_.flips_rows ? rows() - row - count : row, 0, count, columns()};
    if (!read_heights(band_, encoding_, window, heights.data(), valid_.data())) return window;
    for (std::size_t i = 0; i < cells; ++i) {
      if (valid_[i] == 0) {
        heights[i] = kNoHeight;
        continue;
      }
      scan.impossible.look_at(heights[i] * a_.metres_per_height, stored(heights[i]), is_scaled());
      heights[i] = static_cast<float>(heights[i] * a_.metres_per_height);
      scan.lowest_m = std::min<double>(scan.lowest_m, heights[i]);
      scan.highest_m = std::max<double>(scan.highest_m, heights[i]);
      ++scan.heights;
    }
    turn(heights, count);
    return std::nullopt;
  }

 private:
  // What the file has for a height; bands that are scaled hold whole numbers.
  double stored(float height_m) const {
    return is_scaled() ? std::round((height_m - encoding_.offset_m) / encoding_.scale) : height_m;
  }
  bool is_scaled() const { return encoding_.scale != 1.0 || encoding_.offset_m != 0.0; }

  void turn(std::vector<float>& heights, int count) const {
    const auto width = static_cast<std::ptrdiff_t>(columns());
    const auto row = [&](int r) { return heights.begin() + r * width; };
    if (a_.flips_rows)
      for (int r = 0; r < count / 2; ++r) std::swap_ranges(row(r), row(r + 1), row(count - 1 - r));
    if (a_.flips_columns)
      for (int r = 0; r < count; ++r) std::reverse(row(r), row(r + 1));
  }

  GDALRasterBand& band_;
  HeightEncoding encoding_;
  const Arrangement& a_;
  std::vector<std::uint8_t> valid_;
};

// Creates the file that the heights go to.
GDALDatasetUniquePtr create(const fs::path& out, const Arrangement& a, int rows, int columns) {
  CPLStringList creation;
  for (const std::string& option : tiled_creation(true)) creation.AddString(option.c_str());
  GDALDatasetUniquePtr made(GetGDALDriverManager()->GetDriverByName("GTiff")->Create(
      out.c_str(), columns, rows, 1, GDT_Float32, creation.List()));
  if (!made) return made;
  GeoTransform grid = a.grid;
  GDALRasterBand& band = *made->GetRasterBand(1);
  if (made->SetGeoTransform(grid.data()) != CE_None || made->SetSpatialRef(a.crs.get()) != CE_None ||
      band.SetNoDataValue(kNoHeight) != CE_None || band.SetUnitType("m") != CE_None)
    made.reset();
  return made;
}

// Reads every cell, and writes it where there is a file. Errors: unreadable_raster of the source,
// unwritable_file.
Result<Scan> pass_through(GDALRasterBand& band, const Arrangement& a, const std::string& file,
                          GDALDataset* made, const GdalSession& session, Progress& progress) {
  ArrangedHeights source(band, a);
  Scan scan;
  std::vector<float> heights;
  for (int row = 0; row < source.rows(); row += kRowsAtOnce) {
    progress.report(made != nullptr ? "copying heights" : "reading heights",
                    static_cast<double>(row) / source.rows());
    const int count = std::min(kRowsAtOnce, source.rows() - row);
    if (const auto lost = source.read(row, count, heights, scan)) {
      return fail(ErrorCode::kUnreadableRaster,
                  fmt::format("{} is damaged: {} could not be read ({}). Copy or fetch it again.", file,
                              describe(*lost), session.complaints()));
    }
    if (made != nullptr &&
        made->GetRasterBand(1)->RasterIO(GF_Write, 0, row, source.columns(), count, heights.data(),
                                         source.columns(), count, GDT_Float32, 0, 0, nullptr) != CE_None) {
      return fail(ErrorCode::kUnwritableFile, "The heights could not be written: " + session.complaints());
    }
  }
  if (scan.heights == 0)
    return fail(ErrorCode::kUnreadableRaster, file + " has no cell with a height: nothing can drive there.");
  if (scan.impossible.cells > 0) return fail(ErrorCode::kUnreadableRaster, scan.impossible.fault(file));
  return scan;
}

Result<Scan> write_heights(GDALRasterBand& band, const Arrangement& a, const std::string& file,
                           const fs::path& out, const GdalSession& session, Progress& progress) {
  CPLErrorReset();
  GDALDatasetUniquePtr made = create(out, a, band.GetYSize(), band.GetXSize());
  if (!made) return fail(ErrorCode::kUnwritableFile, "The map can't be created: " + session.complaints());
  auto scan = pass_through(band, a, file, made.get(), session, progress);
  CPLErrorReset();
  made.reset();  // closing writes what is left
  if (scan && CPLGetLastErrorType() >= CE_Failure)
    return fail(ErrorCode::kUnwritableFile, "The map could not be closed: " + session.complaints());
  return scan;
}

// From the arranged file to a conformal system around the middle.
Result<void> reproject(const fs::path& arranged, const fs::path& out, Arrangement& a, int rows, int columns,
                       const GdalSession& session, Progress& progress) {
  const Extent extent = extent_of(a, rows, columns);
  RasterCentre centre{0.5 * (extent.west_m + extent.east_m), 0.5 * (extent.south_m + extent.north_m)};
  if (a.crs->IsGeographic() == 0) {
    const auto degrees = degrees_at(*a.crs, centre);
    if (!degrees)
      return fail(ErrorCode::kUnsupportedCrs, "The middle of the map has no longitude and latitude.");
    centre = *degrees;
  }
  const std::string system = conformal_projection(*a.crs, centre.x, centre.y);
  a.changes.push_back(fmt::format("reprojected (bilinear) from \"{}\" to {}", a.crs->GetName(), system));
  const GDALDatasetUniquePtr source(GDALDataset::Open(arranged.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY,
                                                      allowed_raster_drivers(), nullptr, nullptr));
  if (!source) return fail(ErrorCode::kUnwritableFile, "The arranged map is lost: " + session.complaints());
  std::vector<std::string> options{"-of",      "GTiff", "-t_srs", system, "-r",
                                   "bilinear", "-wm",   "128",    "-et",  "0.01"};
  for (const std::string& option : tiled_creation(true)) {
    options.emplace_back("-co");
    options.push_back(option);
  }
  return warp_raster(*source, out, options, session, progress, "reprojecting");
}

// What one cell-reading pass finds, where other faults stand in the way already.
void add_cell_faults(GDALDataset& dataset, const Arrangement& a, const std::string& file,
                     const GdalSession& session, Progress& progress, std::vector<RasterFault>& faults) {
  if (dataset.GetRasterCount() < 1) return;
  for (const RasterFault& fault : faults)
    if (fault.sentence.find("stored in blocks") != std::string::npos) return;  // too large to be read
  const auto scan = pass_through(*dataset.GetRasterBand(1), a, file, nullptr, session, progress);
  if (!scan) faults.push_back({scan.error().code, scan.error().detail, false});
}

}  // namespace

Result<ImportedElevation> import_elevation(const ElevationImport& order, const fs::path& out,
                                           Progress& progress) {
  const std::string file = order.source.filename().string();
  ImportedElevation imported;
  Scan scan;
  {
    const GdalSession session(order.source);
    const WritingAdmission writing(out.parent_path());
    const auto dataset = open_raster(order.source, session);
    if (!dataset) return fail(dataset.error());
    std::unique_ptr<OGRSpatialReference> stated;
    if (!order.crs.empty() && !(stated = named_system(order.crs)))
      return fail(ErrorCode::kInvalidRequest,
                  "--crs is not a system that PROJ knows: " + session.complaints(), {{"--crs", order.crs}});
    const OGRSpatialReference* const crs = stated ? stated.get() : (*dataset)->GetSpatialRef();
    Arrangement a;
    std::vector<RasterFault> faults = examine(**dataset, crs, file, a);
    const bool stuck = std::any_of(faults.begin(), faults.end(),
                                   [&](const RasterFault& fault) { return !(order.fix && fault.mendable); });
    if (stuck) {
      add_cell_faults(**dataset, a, file, session, progress, faults);
      return fail(import_error(faults, "elevation"));
    }
    if (stated) a.changes.insert(a.changes.begin(), "the system was stated by --crs: " + order.crs);
    imported.source_format = (*dataset)->GetDriverName();
    imported.source_crs = crs->GetName();
    GDALRasterBand& band = *(*dataset)->GetRasterBand(1);
    a.metres_per_height = metres_of_unit(band.GetUnitType()).value_or(1.0);
    if (a.metres_per_height != 1.0)
      a.changes.push_back(
          fmt::format("heights in \"{}\" were multiplied by {}", band.GetUnitType(), a.metres_per_height));
    const fs::path arranged = a.reprojects ? fs::path(out.string() + ".arranged.tif") : out;
    if (const auto written = write_heights(band, a, file, arranged, session, progress); !written)
      return fail(written.error());
    if (a.reprojects) {
      const auto done = reproject(arranged, out, a, band.GetYSize(), band.GetXSize(), session, progress);
      std::error_code ignored;
      fs::remove(arranged, ignored);
      if (!done) return fail(done.error());
    }
    imported.changes = std::move(a.changes);
    if (const auto done = add_overviews(out, "AVERAGE", session, progress); !done) return fail(done.error());
    // What was written is what counts, and that it can be read.
    const auto made = open_raster(out, session);
    if (!made) return fail(made.error());
    const auto read_back = pass_through(*(*made)->GetRasterBand(1), Arrangement{}, out.filename().string(),
                                        nullptr, session, progress);
    if (!read_back) return fail(read_back.error());
    scan = *read_back;
  }
  const auto opened = open_elevation(out);
  if (!opened) return fail(opened.error());
  imported.info = (*opened)->info();
  imported.lowest_m = scan.lowest_m;
  imported.highest_m = scan.highest_m;
  const double cells = static_cast<double>(imported.info.geometry.rows) * imported.info.geometry.columns;
  imported.unknown_share = std::clamp(1.0 - static_cast<double>(scan.heights) / cells, 0.0, 1.0);
  return imported;
}

}  // namespace slipway::dem
