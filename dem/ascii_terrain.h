#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "core/pose.h"
#include "core/result.h"
#include "dem/soil_map.h"
#include "dem/terrain.h"

namespace slipway::dem {

// A terrain drawn in text, so that a planning test is a picture and one expectation:
//
//   a a 1 1 .        one cell per drawn character pair; rows from north to south; cells apart by single
//   blanks a S 1 # . a a G 1 .
//
// A digit d is a height of d * height_step_m with the default soil; '.' is height 0 with the default soil; a
// lower-case letter is height 0 with the soil that `soils` gives for it ('?' is height 0 on unknown ground);
// '#' is a cell without elevation; 'S' and 'G' mark start and goal on height 0 with the default soil. A token
// of two characters ("3b") is a height and a soil. The south-west outer corner is the map's origin.
struct AsciiOptions {
  double cell_m = 1.0;
  double height_step_m = 0.1;
  std::string default_soil{};           // empty for unknown ground
  std::map<char, std::string> soils{};  // letter -> soil name
};

struct AsciiTerrain {
  std::shared_ptr<const Terrain> terrain;
  std::shared_ptr<const SoilMap> soil_map;
  std::optional<Pose2> start;  // at the cell's centre, yaw 0
  std::optional<Pose2> goal;
};

// Faults name row and column: "/3/5".
Result<AsciiTerrain> parse_ascii_terrain(std::string_view drawing, const AsciiOptions& options);

}  // namespace slipway::dem
