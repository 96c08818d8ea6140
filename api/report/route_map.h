#pragma once

#include <string>
#include <string_view>

#include "api/files/catalogue.h"
#include "api/json/json_value.h"
#include "core/result.h"

namespace slipway::api {

// The routes of a "plan/1" or "prediction/1" document on the hillshade of their terrain, as one SVG document:
// mapped soils tinted, unknown ground left grey and driven over in dashes, routes coloured by slip and
// numbered by rank, the largest slip of each marked, with scale bar and legend. Errors: those of terrain_at()
// and of reading the terrain; no_data where there is no route.
Result<std::string> draw_route_map(const Catalogue& catalogue, std::string_view answer);

// The path of a "check/1" document on the same ground, coloured by the stops and embeddings that are expected
// on each stretch of it, with a sign where a check of the slip belongs. Errors as above.
Result<std::string> draw_outcome_map(const Catalogue& catalogue, const json::JsonValue& check);

}  // namespace slipway::api
