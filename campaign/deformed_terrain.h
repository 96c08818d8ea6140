#pragma once

#include <memory>

#include "dem/terrain.h"
#include "sim/dynamic/rut_map.h"

namespace slipway::campaign {

// The ground around the ruts, with them: on cells of the ruts' size, or a whole multiple of it where those
// would be more than kMaxDeformedCells. Each cell takes the deepest rut in it. Nothing without ruts.
std::shared_ptr<const dem::Terrain> deformed_terrain(const dem::Terrain& ground, const sim::RutMap& ruts);

constexpr long long kMaxDeformedCells = 4'000'000;
constexpr double kDeformedMargin_m = 1.0;  // of undisturbed ground on each side

}  // namespace slipway::campaign
