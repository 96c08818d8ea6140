#pragma once

#include <string_view>
#include <vector>

#include "api/service.h"
#include "server/http/http_routes.h"

namespace slipway::server {

inline constexpr std::string_view kUploadsPath = "/v1/uploads";

// What can change while the service runs since clients send it: files, drive campaigns, terrains. The service
// must outlive the routes.
std::vector<Route> upload_routes(const api::Service& service);

}  // namespace slipway::server
