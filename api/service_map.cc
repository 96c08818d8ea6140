#include "api/service_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "api/documents/catalogue_documents.h"
#include "api/files/whole_file.h"
#include "api/json/faults.h"
#include "api/maps/map_documents.h"
#include "api/maps/map_layer.h"
#include "api/maps/map_tiles.h"
#include "api/service_setting.h"
#include "core/sha256.h"
#include "core/version.h"
#include "dem/tile_file.h"
#include "dem/write/cog.h"
#include "planner/maps/cell_map.h"
#include "planner/maps/way_map.h"
#include "planner/search/stage_progress.h"

namespace slipway::api {
namespace {

using planner::MapKind;

constexpr double kTilesComputed = 0.75;  // share of the work when all tiles are there

Result<MapSources> map_sources_of(const TerrainSite& site, const Progress& progress) {
  MapSources sources;
  const TerrainDescription& terrain = site.description();
  auto elevation = sha256_of_file(site.folder() / terrain.elevation_file, progress);
  if (!elevation) return fail(elevation.error());
  sources.elevation_sha256 = *std::move(elevation);
  if (terrain.soil_source == SoilSource::kNone) return sources;
  auto soil = sha256_of_file(site.folder() / terrain.soil_file, progress);
  if (!soil) return fail(soil.error());
  sources.soil_sha256 = *std::move(soil);
  return sources;
}

// All that the tiles of a map depend on.
std::string map_key_of(const MapRequest& request, const MapSources& sources, const Catalogue& catalogue) {
  Sha256 hash;
  for (const std::string& part :
       {build_id(), json::write_map_request(request), sources.elevation_sha256, sources.soil_sha256,
        json::write_rovers(catalogue), json::write_soils(catalogue)})
    hash.add(part + "\n");
  return hash.digest();
}

// The cells of the terrain that meet the extent; all where none is given. Errors: not_found, off_map.
Result<dem::GridGeometry> map_geometry_of(const MapRequest& request, const Catalogue& catalogue) {
  const auto found = catalogue.terrains.find(request.terrain);
  if (found == catalogue.terrains.end())
    return fail(ErrorCode::kNotFound, unknown_terrain(catalogue, request.terrain));
  const dem::GridGeometry& all = found->second->info().geometry;
  if (!request.extent) return all;
  if (const auto window = all.window(*request.extent)) return all.sub(*window);
  const dem::Extent map = all.extent();
  return fail(ErrorCode::kOffMap, "The extent does not meet the terrain.",
              {{"/extent", fmt::format("the terrain is west {} south {} east {} north {} m", map.west_m,
                                       map.south_m, map.east_m, map.north_m)}});
}

Result<void> check_cells(const dem::GridGeometry& geometry, long long max_cells) {
  const long long cells = static_cast<long long>(geometry.rows) * geometry.columns;
  if (max_cells == 0 || cells <= max_cells) return {};
  return fail(ErrorCode::kPayloadTooLarge, "The map has too many cells.",
              {{"/extent", fmt::format("takes {} cells of the terrain, must be at most {}; choose a smaller "
                                       "one, or make the map with the command slipway map",
                                       cells, max_cells)}});
}

// Effects in places make soils of their own there, which the map's pieces do not know of.
std::optional<Error> fault_of_places(const MapRequest& request, const planner::PlanProblem& problem) {
  if (sim::effect_regions(sim::in_force(problem.rover->effects, request.drive.effects)).empty())
    return std::nullopt;
  return Error{ErrorCode::kInvalidRequest,
               "A map is made without effects that hold in a place alone.",
               {{"/effects", "has effects with a place"}}};
}

Result<planner::WayMap> ways_of(const MapRequest& request, const planner::PlanProblem& problem,
                                Progress& progress) {
  if (request.kind == MapKind::kCostToGo)
    return planner::cost_to_go_map(problem, *request.place, "/to", progress);
  return planner::reachable_map(problem, *request.place,
                                {request.budget_j, request.budget_sols, request.driving_hours_per_sol},
                                "/from", progress);
}

std::vector<MapPieceIndex> pieces_of_map(const dem::GridGeometry& geometry) {
  const dem::LevelSize size = dem::size_of_level(geometry, 0);
  std::vector<MapPieceIndex> pieces;
  for (int row = 0; row < size.tile_rows(); row += kTilesOfPiece)
    for (int column = 0; column < size.tile_columns(); column += kTilesOfPiece)
      pieces.push_back({row, column});
  return pieces;
}

// The tiles of one piece, where all others count as made.
class PieceTiles final : public dem::TileStore {
 public:
  explicit PieceTiles(const MapPieceIndex& piece) : piece_(piece) {}

  bool has(const dem::TileIndex& tile) const override { return !is_mine(tile) || tiles_.has(tile); }
  Result<void> write(const dem::TileIndex& tile, const std::vector<std::uint8_t>& bytes) override {
    return tiles_.write(tile, bytes);
  }
  Result<std::vector<std::uint8_t>> read(const dem::TileIndex& tile) const override {
    return tiles_.read(tile);
  }

  Result<std::vector<std::string>> in_order() const {
    std::vector<std::string> all;
    for (int r = piece_.row; r < piece_.row + kTilesOfPiece; ++r)
      for (int c = piece_.column; c < piece_.column + kTilesOfPiece; ++c) {
        if (!tiles_.has({0, r, c})) continue;  // beyond the edge
        const auto bytes = tiles_.read({0, r, c});
        if (!bytes) return fail(bytes.error());
        all.emplace_back(bytes->begin(), bytes->end());
      }
    return all;
  }

 private:
  bool is_mine(const dem::TileIndex& tile) const {
    return tile.level == 0 && tile.row / kTilesOfPiece == piece_.row / kTilesOfPiece &&
           tile.column / kTilesOfPiece == piece_.column / kTilesOfPiece;
  }

  const MapPieceIndex piece_;
  dem::MemoryTiles tiles_;
};

// Coarser levels, figures and the file.
Result<void> finish_map(const MapTarget& target, dem::TileStore& store, std::size_t threads,
                        Progress& progress, MapAnswer& answer) {
  if (auto coarser = fill_coarser_levels(answer.layer, store, threads, progress); !coarser) return coarser;
  auto statistics = statistics_of(answer.layer, store, threads, progress);
  if (!statistics) return fail(statistics.error());
  answer.statistics = *std::move(statistics);
  add_statistics(answer.statistics, answer.layer);
  planner::StageProgress stage(progress, "writing the map", kTilesComputed, 1.0);
  if (!target.out.empty()) return dem::write_cog(target.out, answer.layer, store, threads, stage);
  auto bytes = dem::encode_cog(answer.layer, store, threads, stage);
  if (!bytes) return fail(bytes.error());
  answer.cog = *std::move(bytes);
  return {};
}

// A map before its cells are made.
struct MapWork {
  std::shared_ptr<const Catalogue> all;
  const TerrainSite* site = nullptr;
  DriveSetting setting;
  MapSources sources;
  MapAnswer answer;  // with its layer, but without cells; of maps of ways not even that
};

Result<MapWork> prepare_map(const Service& service, const MapRequest& request, const MapTarget& target,
                            Progress& progress) {
  progress.report("reading the terrain", 0.0);
  const std::shared_ptr<const Catalogue> all = service.catalogue();
  const auto geometry = map_geometry_of(request, *all);
  if (!geometry) return fail(geometry.error());
  if (const auto size = check_cells(*geometry, target.max_cells); !size) return fail(size.error());
  const TerrainSite& site = *all->terrains.find(request.terrain)->second;
  const bool by_search = planner::row_of(request.kind).by_search;
  // Cells by themselves are read piece by piece.
  const dem::GridGeometry first = by_search ? *geometry : geometry->sub({0, 0, 1, 1});
  auto setting = set_up(service, request.terrain, request.rover, {}, request.drive, progress, first.extent());
  if (!setting) return fail(setting.error());
  planner::PlanProblem& problem = setting->problem;
  problem.weights = request.weights;
  problem.keep_out = request.keep_out;
  problem.keep_in = request.keep_in;
  if (const auto fault = fault_of_places(request, problem)) return fail(*fault);
  auto sources = map_sources_of(site, progress);
  if (!sources) return fail(sources.error());
  MapAnswer answer{request, setting->provenance, {}, {}, 0, {}};
  if (!by_search)
    answer.layer = map_layer(request, answer.provenance, problem, *sources, *geometry, site.info().crs_wkt);
  return MapWork{all, &site, *std::move(setting), *std::move(sources), std::move(answer)};
}

// Computes the tiles that the store does not have.
Result<void> fill_map(const Service& service, const MapWork& work, dem::TileStore& store,
                      Progress& progress) {
  const MapRequest& request = work.answer.request;
  const planner::CellMap cells({.drive = work.setting.problem,
                                .kind = request.kind,
                                .heading_rad = request.heading_rad,
                                .distance_m = request.distance_m,
                                .price_unknown = request.price_unknown});
  const Legend& legend = *work.site->description().legend(request.drive.legend);
  return fill_tiles(cells, *work.site, legend, work.answer.layer, store, service.options().threads, progress);
}

}  // namespace

Result<MapRequest> read_map(const Service& service, std::string_view json) {
  return checked(service, json::read_map_request(json, service.options().costs),
                 [](const MapRequest& request, RequestCheck& check) {
                   if (request.place)
                     check.place(*request.place,
                                 request.kind == planner::MapKind::kCostToGo ? "/to" : "/from");
                   check.zones(request.keep_out, "/keep_out");
                   check.zones(request.keep_in, "/keep_in");
                 });
}

Result<void> check_map_size(const Service& service, const MapRequest& request, long long max_cells) {
  const auto geometry = map_geometry_of(request, *service.catalogue());
  if (!geometry) return fail(geometry.error());
  return check_cells(*geometry, max_cells);
}

Result<MapAnswer> run_map(const Service& service, const MapRequest& request, const MapTarget& target,
                          Progress& progress) {
  auto work = prepare_map(service, request, target, progress);
  if (!work) return fail(work.error());
  MapAnswer& answer = work->answer;
  dem::MemoryTiles in_memory;
  if (planner::row_of(request.kind).by_search) {
    const auto ways = ways_of(request, work->setting.problem, progress);
    if (!ways) return fail(ways.error());
    if (const auto damage = work->setting.problem.terrain->damage()) return fail(*damage);
    answer.layer = map_layer(request, answer.provenance, work->setting.problem, work->sources, ways->geometry,
                             work->site->info().crs_wkt);
    if (auto filled = fill_tiles(ways->values, answer.layer, in_memory); !filled) return fail(filled.error());
    if (auto done = finish_map(target, in_memory, service.options().threads, progress, answer); !done)
      return fail(done.error());
    return std::move(answer);
  }
  std::unique_ptr<dem::TileFile> file;
  if (!target.part.empty()) {
    const std::size_t bytes = answer.layer.cell_bytes() * dem::kTileSide * dem::kTileSide;
    auto opened =
        dem::TileFile::open(target.part, map_key_of(request, work->sources, *work->all), bytes, progress);
    if (!opened) return fail(opened.error());
    file = *std::move(opened);
    answer.tiles_kept = file->tiles();
  }
  dem::TileStore& store = file ? static_cast<dem::TileStore&>(*file) : in_memory;
  planner::StageProgress stage(progress, "computing tiles", 0.0, kTilesComputed);
  if (auto filled = fill_map(service, *work, store, stage); !filled) return fail(filled.error());
  if (auto done = finish_map(target, store, service.options().threads, progress, answer); !done)
    return fail(done.error());
  return std::move(answer);
}

Result<std::vector<MapPieceIndex>> map_pieces(const Service& service, const MapRequest& request) {
  if (planner::row_of(request.kind).by_search) return std::vector<MapPieceIndex>();
  const auto geometry = map_geometry_of(request, *service.catalogue());
  if (!geometry) return fail(geometry.error());
  return pieces_of_map(*geometry);
}

Result<std::vector<std::string>> map_piece(const Service& service, const MapRequest& request,
                                           const MapTarget& target, const MapPieceIndex& piece,
                                           Progress& progress) {
  const auto work = prepare_map(service, request, target, progress);
  if (!work) return fail(work.error());
  PieceTiles tiles(piece);
  if (auto filled = fill_map(service, *work, tiles, progress); !filled) return fail(filled.error());
  return tiles.in_order();
}

Result<MapAnswer> map_of_pieces(const Service& service, const MapRequest& request, const MapTarget& target,
                                const std::function<Result<std::vector<std::string>>(int)>& tiles_of,
                                Progress& progress) {
  auto work = prepare_map(service, request, target, progress);
  if (!work) return fail(work.error());
  MapAnswer& answer = work->answer;
  const dem::LevelSize size = dem::size_of_level(answer.layer.geometry, 0);
  dem::MemoryTiles store;
  int number = 0;
  for (const MapPieceIndex& piece : pieces_of_map(answer.layer.geometry)) {
    const auto tiles = tiles_of(number++);
    if (!tiles) return fail(tiles.error());
    std::size_t next = 0;
    for (int r = piece.row; r < std::min(piece.row + kTilesOfPiece, size.tile_rows()); ++r)
      for (int c = piece.column; c < std::min(piece.column + kTilesOfPiece, size.tile_columns()); ++c) {
        if (next == tiles->size())
          return fail(ErrorCode::kInternal, fmt::format("piece {} of the map lacks tiles", number - 1));
        const std::string& bytes = (*tiles)[next++];
        if (auto written = store.write({0, r, c}, {bytes.begin(), bytes.end()}); !written)
          return fail(written.error());
      }
  }
  if (auto done = finish_map(target, store, service.options().threads, progress, answer); !done)
    return fail(done.error());
  return std::move(answer);
}

Result<GroundAt> ground_at(const Service& service, std::string_view terrain, double x_m, double y_m) {
  const std::shared_ptr<const Catalogue> all = service.catalogue();
  const auto found = all->terrains.find(terrain);
  if (found == all->terrains.end()) return fail(ErrorCode::kNotFound, unknown_terrain(*all, terrain));
  const TerrainSite& site = *found->second;
  RequestCheck check(*all, {});
  check.names(std::string(terrain), names_of(all->rovers).front());
  check.place({x_m, y_m, std::nullopt}, "");
  if (!check.passed()) return fail(check.error());
  const dem::GridGeometry& geometry = site.info().geometry;
  GroundAt at;
  at.x_m = x_m;
  at.y_m = y_m;
  // A wheelbase, or what the raster can tell.
  at.roughness_radius_m = std::max(1.5, 1.5 * std::max(geometry.cell_x_m, geometry.cell_y_m));
  const double reach = at.roughness_radius_m + 2.0 * std::max(geometry.cell_x_m, geometry.cell_y_m);
  const auto ground = site.read({x_m - reach, y_m - reach, x_m + reach, y_m + reach});
  if (!ground) return fail(ground.error());
  const auto surface = ground->terrain->surface(x_m, y_m);
  if (!surface) return fail(ErrorCode::kNoData, "the terrain has no elevation there");
  at.height_m = surface->height_m;
  at.slope_rad = surface->slope_rad();
  at.aspect_rad = surface->aspect_rad();
  at.roughness_m = ground->terrain->roughness_m(x_m, y_m, at.roughness_radius_m);
  if (const auto mapped = ground->soil_map->class_at(x_m, y_m)) {
    for (const dem::SoilClass& entry : ground->soil_map->legend()) {
      if (entry.value == *mapped) at.label = entry.label;
    }
  }
  if (const auto soil = ground->soil_map->soil_at(x_m, y_m)) at.soil = ground->soil_map->soils()[*soil];
  return at;
}

}  // namespace slipway::api
