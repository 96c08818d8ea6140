#pragma once

#include <vector>

#include "api/service.h"
#include "server/http/http_routes.h"

namespace slipway::server {

// GET of one terrain: its document, pictures and tiles of its layers, the ground along a line. The service
// must outlive the routes.
std::vector<Route> terrain_routes(const api::Service& service);

}  // namespace slipway::server
