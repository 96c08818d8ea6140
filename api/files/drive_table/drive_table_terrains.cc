#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <set>
#include <utility>

#include "api/files/drive_table/drive_table_file.h"
#include "api/json/faults.h"
#include "dem/elevation_source.h"
#include "dem/synthetic_terrain.h"

namespace slipway::api::json {
namespace {

constexpr double kMaxCells = 4'000'000.0;
constexpr std::size_t kMaxTerrains = 200;

void read_ripple(ObjectReader& terrain, dem::Relief& relief) {
  auto object = terrain.object("ripple", kOptional);
  if (!object) return;
  dem::Relief::Ripple& ripple = relief.ripple.emplace(dem::Relief::Ripple{});
  object->number("height_m", kRequired, {"m", 0.0, 10.0, true}, ripple.height_m);
  object->number("width_m", kRequired, {"m", 0.0, 100.0, true}, ripple.width_m);
  object->number("crest_x_m", kOptional, {"m", -1000.0, 1000.0}, ripple.crest_x_m);
  object->refuse_unknown();
}

void read_roughness(ObjectReader& terrain, dem::Relief& relief) {
  auto object = terrain.object("roughness", kOptional);
  if (!object) return;
  dem::Relief::Roughness& roughness = relief.roughness.emplace(dem::Relief::Roughness{});
  object->number("rms_m", kRequired, {"m", 0.0, 2.0, true}, roughness.rms_m);
  object->number("bump_m", kRequired, {"m", 0.01, 100.0}, roughness.lattice_m);
  object->whole("seed", kOptional, std::uint64_t{0}, std::uint64_t{1} << 53U, roughness.seed);
  object->refuse_unknown();
}

void read_rocks(ObjectReader& terrain, double cell_m, dem::Relief& relief) {
  auto object = terrain.object("rocks", kOptional);
  if (!object) return;
  dem::RockField& rocks = relief.rocks.emplace();
  object->number("cover_share", kRequired, {"1", 1e-6, 0.5}, rocks.cover_share);
  const bool smallest = object->number("smallest_m", kRequired, {"m", 0.01, 10.0}, rocks.smallest_m);
  const bool largest = object->number("largest_m", kRequired, {"m", 0.01, 10.0}, rocks.largest_m);
  object->number("height_share", kOptional, {"1", 0.0, 1.0, true}, rocks.height_share);
  object->whole("seed", kOptional, std::uint64_t{0}, std::uint64_t{1} << 53U, rocks.seed);
  object->refuse_unknown();
  if (!smallest || !largest) return;
  if (rocks.smallest_m < cell_m)
    object->fault("smallest_m", fmt::format("smallest_m = {:g} m, must be at least cell_m = {:g} m: what is "
                                            "smaller falls between the cells",
                                            rocks.smallest_m, cell_m));
  if (rocks.largest_m <= rocks.smallest_m)
    object->fault("largest_m", fmt::format("largest_m = {:g} m, must be above smallest_m = {:g} m",
                                           rocks.largest_m, rocks.smallest_m));
}

void make_synthetic(ObjectReader& reader, campaign::TableTerrain& terrain) {
  const std::size_t before = reader.faults().size();
  dem::Relief relief;
  dem::SyntheticGrid grid{.size_m = 20.0, .cell_m = 0.1};
  reader.angle_deg("tilt_deg", kOptional, {"deg", -60.0, 60.0}, relief.slope_rad);
  read_ripple(reader, relief);
  read_roughness(reader, relief);
  reader.number("size_m", kOptional, {"m", 1.0, 2000.0}, grid.size_m);
  reader.number("cell_m", kOptional, {"m", 0.01, 10.0}, grid.cell_m);
  read_rocks(reader, grid.cell_m, relief);
  if (const double cells = grid.size_m / grid.cell_m; cells * cells > kMaxCells)
    reader.fault("cell_m", fmt::format("size_m / cell_m = {:.0f} cells a side, must be at most {:.0f}", cells,
                                       std::sqrt(kMaxCells)));
  if (reader.faults().size() == before) terrain.ground = dem::make_relief(grid, relief);
}

// A plain name: it can't leave the table's folder.
bool is_plain(const std::string& file) {
  return file.front() != '.' && file.front() != '-' && std::all_of(file.begin(), file.end(), [](char c) {
           return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
                  c == '-' || c == '.';
         });
}

using SoilNames = std::map<std::string, sim::SoilDistribution, std::less<>>;

std::vector<dem::SoilClass> read_classes(ObjectReader& map, const SoilNames& soils) {
  std::vector<dem::SoilClass> legend;
  for (const Element& element : map.list("classes", kRequired, {1, 1000})) {
    ObjectReader reader(*element.value, element.pointer, map.faults());
    dem::SoilClass& row = legend.emplace_back();
    std::string soil;
    reader.whole("value", kRequired, -32768, 32767, row.value);
    if (reader.text("soil", kRequired, {.most = 64}, soil)) {
      if (!soils.contains(soil)) reader.fault("soil", unknown_name("soil", soil, names_of(soils)));
      row.soil = soil;
    }
    reader.refuse_unknown();
  }
  return legend;
}

// Classes beside an elevation file, in its system.
void read_soil_map(ObjectReader& terrain, const std::filesystem::path& folder,
                   const dem::ElevationInfo& elevation, campaign::TableTerrain& out, const SoilNames& soils) {
  auto map = terrain.object("soil_map", kOptional);
  if (!map) return;
  std::string file;
  const std::size_t before = terrain.faults().size();
  if (map->text("file", kRequired, {.most = 100}, file) && !is_plain(file))
    map->fault("file", "file = " + in_quotes(file) + ", must be a plain file name beside the table");
  std::vector<dem::SoilClass> legend = read_classes(*map, soils);
  map->refuse_unknown();
  if (terrain.faults().size() > before) return;
  const auto read =
      dem::read_soil_raster(folder / file, elevation, elevation.geometry.extent(), std::move(legend));
  if (read) {
    out.soil_map = *read;
    return;
  }
  map->fault("file", read.error().detail);
  for (const Fault& fault : read.error().faults) {
    // A legend's row is one of ours.
    std::string pointer = fault.pointer;
    if (pointer.starts_with("/legend")) pointer.replace(0, std::string_view("/legend").size(), "/classes");
    terrain.faults().push_back({map->pointer() + pointer, fault.message});
  }
}

void open_file(ObjectReader& reader, const std::string& file, const std::filesystem::path& folder,
               campaign::TableTerrain& terrain, const SoilNames& soils) {
  if (!is_plain(file)) {
    reader.fault("file", "file = " + in_quotes(file) + ", must be a plain file name beside the table");
    return;
  }
  const auto source = dem::open_elevation(folder / file);
  const auto ground = source ? (*source)->read((*source)->info().geometry.extent())
                             : Result<std::shared_ptr<const dem::Terrain>>(fail(source.error()));
  if (!ground) {
    reader.fault("file", ground.error().detail);
    return;
  }
  terrain.crs_wkt = (*source)->info().crs_wkt;
  terrain.ground = *ground;
  read_soil_map(reader, folder, (*source)->info(), terrain, soils);
}

}  // namespace

std::vector<campaign::TableTerrain> read_table_terrains(
    ObjectReader& table, const std::filesystem::path& folder,
    const std::map<std::string, sim::SoilDistribution, std::less<>>& soils) {
  std::vector<campaign::TableTerrain> terrains;
  std::set<std::string> names;
  for (const Element& element : table.list("terrains", kRequired, {1, kMaxTerrains})) {
    ObjectReader reader(*element.value, element.pointer, table.faults());
    campaign::TableTerrain& terrain = terrains.emplace_back();  // also when faulty: the indices must stay
    if (reader.text("name", kRequired, {.most = 64, .is_name = true}, terrain.name) &&
        !names.insert(terrain.name).second)
      reader.fault("name", "terrain " + terrain.name + " is given twice");
    if (reader.text("soil", kRequired, {.most = 64}, terrain.soil) && !soils.contains(terrain.soil))
      reader.fault("soil", unknown_name("soil", terrain.soil, names_of(soils)));
    if (std::string file; reader.text("file", kOptional, {.most = 100}, file)) {
      open_file(reader, file, folder, terrain, soils);
    } else {
      make_synthetic(reader, terrain);
    }
    reader.refuse_unknown();
  }
  return terrains;
}

}  // namespace slipway::api::json
