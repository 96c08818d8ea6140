#pragma once

#include <string>
#include <string_view>

#include "api/files/catalogue.h"
#include "core/result.h"

namespace slipway::api {

// The routes of a "plan/1" or "prediction/1" document on the hillshade of their terrain, as one SVG document:
// mapped soils tinted, unknown ground left grey and driven over in dashes, routes coloured by slip and
// numbered by rank, the largest slip of each marked, with scale bar and legend. Errors: those of reading the
// terrain; internal where the document is no answer.
Result<std::string> draw_route_map(const Catalogue& catalogue, std::string_view answer);

}  // namespace slipway::api
