#include <fmt/format.h>
#include <ogr_spatialref.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "core/fault_words.h"
#include "dem/crs/crs_text.h"
#include "dem/crs/gdal_named_crs.h"
#include "dem/gdal_crs.h"
#include "dem/gdal_crs_parts.h"
#include "dem/gdal_import.h"
#include "dem/gdal_raster_meaning.h"
#include "dem/import/gdal_import_heights.h"
#include "dem/terrain_import.h"

namespace slipway::dem {
namespace {

namespace fs = std::filesystem;

// A map that is being imported.
struct Opened {
  std::string file;  // its name
  GDALDatasetUniquePtr dataset;
  std::unique_ptr<OGRSpatialReference> crs;  // the horizontal part of the stated or its own; nullptr: none
  BandChoice band;
  RasterMeaning meaning;
  Arrangement arrangement;
  std::vector<RasterFault> faults;

  GDALRasterBand& heights() const { return *dataset->GetRasterBand(band.number); }
  HeightSource source() const { return {heights(), meaning.encoding, arrangement, file}; }
  void add(const Error& error, bool mendable) { faults.push_back({error.code, error.detail, mendable}); }
};

bool cells_are_open(const Opened& map) {
  return std::none_of(map.faults.begin(), map.faults.end(),
                      [](const RasterFault& fault) { return fault.cells_are_closed; });
}

// Where heights are distances from the middle of the map's sphere, its radius is taken off them.
void measure_from_sphere(Opened& map) {
  if (!map.crs || map.crs->GetSemiMajor() != map.crs->GetSemiMinor()) return;
  constexpr int kSide = 64;
  constexpr double kMostAbove_m = 40'000.0;
  GDALRasterBand& band = map.heights();
  const int columns = std::min(kSide, band.GetXSize()), rows = std::min(kSide, band.GetYSize());
  std::vector<double> cells(static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns));
  if (band.RasterIO(GF_Read, 0, 0, band.GetXSize(), band.GetYSize(), cells.data(), columns, rows, GDT_Float64,
                    0, 0, nullptr) != CE_None)
    return;
  HeightEncoding& encoding = map.meaning.encoding;
  const auto first =
      std::find_if(cells.begin(), cells.end(), [&](double cell) { return encoding.is_height(cell); });
  if (first == cells.end()) return;
  const double radius_m = map.crs->GetSemiMajor(), metres = map.meaning.metres_per_unit.value_or(1.0);
  const double height_m = (encoding.scale * *first + encoding.offset_m) * metres;
  if (height_m < kLeastRadius_m || std::abs(height_m - radius_m) > kMostAbove_m) return;
  std::string sum =
      fmt::format("A.astype(float)*{}+{}", encoding.scale * metres, encoding.offset_m * metres - radius_m);
  map.faults.push_back(
      {ErrorCode::kUnreadableRaster,
       fmt::format("{} has distances from the body's centre for heights, the first {:.1f} m. Take the radius "
                   "of the map's sphere off with: gdal_calc.py -A {} --A_band={} --calc={} --type=Float32 "
                   "--outfile={}",
                   map.file, height_m, shell_word(map.file), map.band.number, shell_word(sum),
                   shell_word(converted_name(map.file))),
       true});
  encoding.offset_m -= radius_m / metres;
  map.arrangement.changes.push_back(fmt::format(
      "heights were distances from the body's centre; the radius of the map's sphere, {} m, was taken off",
      radius_m));
}

// What is wrong with the band and with its meaning.
void examine_band(Opened& map, const ElevationImport& order, const OGRSpatialReference* stated) {
  const auto band = choose_band(*map.dataset, map.file, order.band);
  if (!band) {
    map.add(band.error(), false);
  } else {
    map.band = *band;
  }
  if (map.dataset->GetRasterCount() < 1) return;
  map.meaning = meaning_of(*map.dataset, map.band, {order.unit, stated});
  if (order.nodata) map.meaning.encoding.other_nodata = *order.nodata;
  if (const auto sidecar = fault_of_sidecar(*map.dataset))
    map.faults.push_back({ErrorCode::kUnreadableRaster, *sidecar, false});
  if (!band) return;
  if (const auto picture = fault_of_picture(*map.dataset, map.band, map.file, !map.meaning.unit.empty()))
    map.faults.push_back({ErrorCode::kUnreadableRaster, *picture, false});
  const auto metres = map.meaning.metres_per_unit;
  if (const auto unit = check_metres(map.meaning, map.file); !unit)
    map.add(unit.error(), metres.has_value() && *metres != 1.0);
  if (!map.band.why.empty())
    map.arrangement.changes.push_back(
        fmt::format("band {} was taken of several, {}", map.band.number, map.band.why));
  if (cells_are_open(map)) measure_from_sphere(map);
}

// What is wrong with the system and the grid, and how they are brought into metres.
void examine_place(Opened& map) {
  std::array<double, 6> grid{};
  if (!can_be_reprojected(map.crs.get()) || map.dataset->GetGeoTransform(grid.data()) != CE_None) return;
  Arrangement arranged = arrange(*map.dataset, *map.crs);
  arranged.changes.insert(arranged.changes.begin(), map.arrangement.changes.begin(),
                          map.arrangement.changes.end());
  map.arrangement = std::move(arranged);
  Arrangement& a = map.arrangement;
  if (a.crs->IsProjected() != 0 && map.crs->GetLinearUnits() != 1.0 && map.meaning.unit.empty())
    map.meaning.warnings.push_back(fmt::format(
        "heights carry no unit and were taken as metres, though coordinates were not in metres; state their "
        "unit with --unit, or in the file with: gdal_edit.py -units ft {}",
        shell_word(map.file)));
  const Extent extent = extent_of(a, map.dataset->GetRasterYSize(), map.dataset->GetRasterXSize());
  if (const auto reach = check_reach(*a.crs, extent, map.file); !reach) return map.add(reach.error(), false);
  if (a.crs->IsProjected() != 0) {
    if (const auto lengths = check_true_lengths(*a.crs, extent, map.file); !lengths) {
      a.reprojects = true;
      map.add(lengths.error(), true);
    }
  }
  if (!a.reprojects) return;
  if (const auto size = fault_of_size(a, extent))
    map.faults.push_back({ErrorCode::kUnsupportedCrs, fmt::format("{} {}.", map.file, *size), false});
}

// Opens the map and finds all that is wrong with it but its cells.
Result<Opened> open_map(const ElevationImport& order, const GdalSession& session) {
  Opened map;
  map.file = order.source.filename().string();
  auto dataset = open_raster(order.source, session);
  if (!dataset) return fail(dataset.error());
  map.dataset = *std::move(dataset);
  std::unique_ptr<OGRSpatialReference> stated;
  if (!order.crs.empty() && !(stated = named_crs(order.crs))) {
    const std::string why = "--crs is not a system that PROJ knows: " +
                            fault_of_crs_text(order.crs).value_or(session.complaints());
    return fail(ErrorCode::kInvalidRequest, why,
                {{"--crs", fmt::format("{}: {}", in_quotes(order.crs), why)}});
  }
  if (stated) map.arrangement.changes.push_back("the system was stated by --crs: " + order.crs);
  map.crs = stated ? horizontal_part(stated.get()) : system_of(*map.dataset);
  const int chosen = choose_band(*map.dataset, map.file, order.band).value_or(BandChoice{}).number;
  map.faults = faults_of(*map.dataset, map.crs.get(), map.file, PlacelessRaster::kRefused, chosen);
  examine_band(map, order, stated.get());
  examine_place(map);
  map.arrangement.metres_per_height = map.meaning.metres_per_unit.value_or(1.0);
  if (map.arrangement.metres_per_height != 1.0)
    map.arrangement.changes.push_back(fmt::format("heights in \"{}\" were multiplied by {}", map.meaning.unit,
                                                  map.arrangement.metres_per_height));
  return map;
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
void add_cell_faults(Opened& map, const GdalSession& session, Progress& progress) {
  if (map.dataset->GetRasterCount() < 1) return;
  if (!cells_are_open(map)) return;
  if (const auto scan = scan_heights(map.source(), session, progress); !scan) map.add(scan.error(), false);
}

// What the file has for a height: to be given to --nodata.
double stored(float height_m, const Opened& map) {
  const HeightEncoding& encoding = map.meaning.encoding;
  const double metres = map.arrangement.metres_per_height;
  if (metres == 1.0 && encoding.scale == 1.0 && encoding.offset_m == 0.0) return height_m;
  const double value = (height_m / metres - encoding.offset_m) / encoding.scale, whole = std::round(value);
  return std::abs(value - whole) < 1e-6 * std::max(1.0, std::abs(height_m / encoding.scale)) ? whole : value;
}

// A fill or a collar, with its place in the source's coordinates.
std::string warning_of(const ConstantHeight& constant, const Scan& scan, const Opened& map) {
  const Arrangement& a = map.arrangement;
  const double column = constant.column + 0.5, row = constant.row + 0.5;
  const double share = static_cast<double>(constant.cells) / static_cast<double>(scan.heights);
  std::string text = fmt::format("{} cells, {:.1f} % of all with a height, have the one height {:.7g} m",
                                 constant.cells, 100.0 * share, constant.height_m);
  if (constant.is_cliff)
    text += fmt::format(", with a cliff of up to {:.1f} m along their edge", constant.step_m);
  return text + fmt::format(
                    ", as at ({:.9g}, {:.9g}), row {}, column {}: where they have no height in truth, import "
                    "the map with --nodata {:.9g}",
                    a.grid[0] + column * a.grid[1] + row * a.grid[2],
                    a.grid[3] + column * a.grid[4] + row * a.grid[5],
                    a.flips_rows ? map.heights().GetYSize() - 1 - constant.row : constant.row,
                    a.flips_columns ? map.heights().GetXSize() - 1 - constant.column : constant.column,
                    stored(constant.height_m, map));
}

// Writes the heights, in a system in which they are true.
Result<void> write_map(Opened& map, const fs::path& out, ImportedElevation& imported,
                       const GdalSession& session, Progress& progress) {
  Arrangement& a = map.arrangement;
  const fs::path arranged = a.reprojects ? fs::path(out.string() + ".arranged.tif") : out;
  const auto written = write_heights(map.source(), arranged, session, progress);
  if (!written) return fail(written.error());
  imported.warnings = map.meaning.warnings;
  for (const ConstantHeight& constant : written->constant)
    imported.warnings.push_back(warning_of(constant, *written, map));
  if (a.reprojects) {
    const auto done =
        reproject(arranged, out, a, map.heights().GetYSize(), map.heights().GetXSize(), session, progress);
    std::error_code ignored;
    fs::remove(arranged, ignored);
    if (!done) return done;
  }
  return add_overviews(out, "AVERAGE", session, progress);
}

// What was written is what counts, and that it can be read.
Result<Scan> read_back(const fs::path& out, const GdalSession& session, Progress& progress) {
  const auto made = open_raster(out, session);
  if (!made) return fail(made.error());
  GDALRasterBand& band = *(*made)->GetRasterBand(1);
  return scan_heights({band, encoding_of(band), Arrangement{}, out.filename().string()}, session, progress);
}

// Heights that this body has nowhere, though another one may.
void warn_of_body(ImportedElevation& imported) {
  struct Relief {
    const char* body;
    double lowest_m, highest_m;
  };
  for (const Relief& relief : {Relief{"Mars", -9'000.0, 22'500.0}, Relief{"Moon", -10'500.0, 11'500.0},
                               Relief{"Earth", -11'500.0, 9'000.0}})
    if (imported.info.body == relief.body &&
        (imported.lowest_m < relief.lowest_m || imported.highest_m > relief.highest_m))
      imported.warnings.push_back(
          fmt::format("heights of {:.1f} to {:.1f} m are more than {} has anywhere ({:.0f} to {:.0f} m)",
                      imported.lowest_m, imported.highest_m, relief.body, relief.lowest_m, relief.highest_m));
}

}  // namespace

Result<ImportedElevation> import_elevation(const ElevationImport& order, const fs::path& out,
                                           Progress& progress) {
  ImportedElevation imported;
  Scan scan;
  {
    const GdalSession session(order.source);
    const WritingAdmission writing(out.parent_path());
    auto map = open_map(order, session);
    if (!map) return fail(map.error());
    const bool stuck = std::any_of(map->faults.begin(), map->faults.end(),
                                   [&](const RasterFault& fault) { return !(order.fix && fault.mendable); });
    if (stuck) {
      add_cell_faults(*map, session, progress);
      return fail(import_error(map->faults, "elevation"));
    }
    imported.source_format = map->dataset->GetDriverName();
    imported.source_crs = map->crs->GetName();
    imported.reading = map->meaning.told;
    imported.on_trust = map->meaning.on_trust;
    if (const auto written = write_map(*map, out, imported, session, progress); !written)
      return fail(written.error());
    imported.changes = std::move(map->arrangement.changes);
    const auto read = read_back(out, session, progress);
    if (!read) return fail(read.error());
    scan = *read;
  }
  const auto opened = open_elevation(out);
  if (!opened) return fail(opened.error());
  imported.info = (*opened)->info();
  imported.lowest_m = scan.lowest_m;
  imported.highest_m = scan.highest_m;
  const double cells = static_cast<double>(imported.info.geometry.rows) * imported.info.geometry.columns;
  imported.unknown_share = std::clamp(1.0 - static_cast<double>(scan.heights) / cells, 0.0, 1.0);
  warn_of_body(imported);
  return imported;
}

}  // namespace slipway::dem
