#pragma once

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "api/job_kinds.h"
#include "api/jobs/job_runner.h"
#include "api/service.h"
#include "server/http/http_routes.h"

namespace slipway::server {

struct RouteOptions {
  std::chrono::seconds longest_wait{30};  // a longer "Prefer: wait" is cut to this
  int most_waiting =
      4;  // clients hold one of HttpOptions::asking_threads each: some must stay free for others
  std::size_t most_listed = 500;
  // Where answers are drawn that are too large for the memory; as many as are kept take 256 MB.
  std::filesystem::path drawing_folder = std::filesystem::temp_directory_path();
  // See JobEventOptions.
  std::function<bool(std::string_view method, std::string_view path,
                     const std::optional<std::string>& authorization)>
      admits = {};
  int override_persons = 2;  // 2: who confirms an override is not who asked for it
  // Whether a token (HttpRequest::token) is still known; where there is no such function, it is.
  std::function<bool(const std::string& token)> knows_token = {};
};

// What is asked and answered under which address. The service, the runner and the kinds of jobs must outlive
// the routes.
std::vector<Route> api_routes(const api::Service& service, api::JobRunner& runner,
                              const RouteOptions& options = {},
                              const std::vector<api::JobKind>& kinds = api::job_kinds());

}  // namespace slipway::server
