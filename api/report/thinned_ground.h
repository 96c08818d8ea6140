#pragma once

#include "api/files/terrain_site.h"

namespace slipway::api {

// Ground for a picture: as it is up to kMaxPictureCells, else every so manieth cell of it, so that a picture
// of many kilometres stays one that a browser shows.
Result<GroundWindow> thinned_for_picture(const GroundWindow& ground);

constexpr long long kMaxPictureCells = 4'000'000;

}  // namespace slipway::api
