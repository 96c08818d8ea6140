#pragma once

#include <string>
#include <string_view>

#include "api/files/catalogue.h"
#include "core/result.h"

namespace slipway::api {

// The page of a "sol/1" document for a meeting. Errors: as draw_route_map().
Result<std::string> sol_report(const Catalogue& catalogue, std::string_view document);

}  // namespace slipway::api
