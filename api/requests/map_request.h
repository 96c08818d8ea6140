#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "api/requests/answers.h"
#include "api/requests/plan_request.h"
#include "dem/grid_geometry.h"
#include "dem/raster_tiles.h"
#include "planner/maps/map_kind.h"

namespace slipway::api {

// POST /v1/maps, and `slipway map`, ask for a raster of a terrain.
struct MapRequest {
  std::string terrain;
  std::string rover;
  planner::MapKind kind = planner::MapKind::kSlipWorst;
  std::optional<double> heading_rad;       // of travel, counter-clockwise from east
  double distance_m = 10.0;                // of the drive that risks and verdicts are of
  std::optional<dem::Extent> extent;       // where it is empty, the whole terrain
  bool price_unknown = false;              // unknown ground by its belief; otherwise it has no value
  std::optional<planner::Waypoint> place;  // where ways lead to (cost_to_go) or begin (reachable)
  std::optional<double> budget_j, budget_sols;
  double driving_hours_per_sol = 4.0;
  planner::Weights weights;                         // of the cost of ways
  std::vector<planner::Polygon> keep_out, keep_in;  // of ways
  DriveAssumptions drive;
};

// The most cells of a map that a service makes, and of one that is of ways, whose ground is in memory whole.
inline constexpr long long kMaxServedMapCells = 4'194'304;

// A square of a map's tiles: the row and column of its first tile.
struct MapPieceIndex {
  int row = 0, column = 0;
};

// Where a map is written.
struct MapTarget {
  std::filesystem::path out;   // the GeoTIFF; empty: its bytes are in the answer
  std::filesystem::path part;  // keeps finished tiles whatever ends the work; empty: nothing is kept
  long long max_cells = 0;     // 0: as many as the terrain has
};

// What the cells of a map say as a whole.
struct MapStatistics {
  long long cells = 0, nodata = 0;
  double lowest = 0.0, highest = 0.0, mean = 0.0;          // of values
  std::vector<std::pair<std::string, long long>> classes;  // cells of each class
};

struct MapAnswer {
  MapRequest request;
  Provenance provenance;
  dem::RasterLayer layer;
  MapStatistics statistics;
  std::size_t tiles_kept = 0;  // of all levels, done before and not computed again
  std::string cog;             // its bytes, where no file was asked for
};

}  // namespace slipway::api
