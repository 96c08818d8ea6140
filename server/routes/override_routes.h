#pragma once

#include <string_view>
#include <vector>

#include "api/jobs/job_store.h"
#include "server/http/http_routes.h"
#include "server/routes/routes.h"

namespace slipway::server {

inline constexpr std::string_view kOverrideKind = "override";  // of what no worker does, see below

// POST and GET of a check's override: who lets a drive go whose check says NO-GO or UNKNOWN, and why. It
// takes two requests, the second with what the first one's answer gave for it, and from another person where
// RouteOptions::override_persons is 2; what was asked with a token that is no longer known lapses. The check
// itself stays as it is. An override is kept in the store as a job of kind "override" and told to the audit
// log. The store must outlive the routes.
std::vector<Route> override_routes(api::JobStore& store, const RouteOptions& options);

}  // namespace slipway::server
