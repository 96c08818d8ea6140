#pragma once

#include <vector>

#include "server/http/http_routes.h"

namespace slipway::server {

// The dashboard under /dashboard/: a page that is a client of the API like any other. All its addresses are
// relative, so that a proxy may put the service under any path.
std::vector<Route> dashboard_routes();

}  // namespace slipway::server
