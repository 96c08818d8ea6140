#pragma once

#include "core/progress.h"
#include "core/result.h"
#include "dem/terrain.h"
#include "dem/vector_file.h"

namespace slipway::dem {

inline constexpr long long kMaxContourPoints = 20'000'000;

// Lines of equal height every `every_m` metres from `base_m`, as GDAL draws them between the cells' centres:
// the layer "contours" with the field height_m. Lines end where elevation is missing. Errors: invalid_request
// above kMaxContourPoints; cancelled.
Result<VectorLayer> contours_of(const Terrain& terrain, double every_m, double base_m, Progress& progress);

}  // namespace slipway::dem
