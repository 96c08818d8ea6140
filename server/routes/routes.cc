#include "server/routes/routes.h"

#include <iterator>
#include <string>
#include <string_view>
#include <utility>

#include "api/documents/catalogue_documents.h"
#include "api/documents/soil/wheel_sweep_answer.h"
#include "api/openapi.h"
#include "api/service_map.h"
#include "api/wheel_sweep.h"
#include "server/routes/comparison_routes.h"
#include "server/routes/job_routes.h"
#include "server/routes/override_routes.h"
#include "server/routes/query.h"
#include "server/routes/request_headers.h"
#include "server/routes/responses.h"
#include "server/routes/terrain_routes.h"
#include "server/routes/upload_routes.h"

namespace slipway::server {
namespace {

constexpr std::string_view kCsv = "text/csv";

// Answered at once: the rows are few enough.
HttpResponse wheel_sweep(const api::Service& service, const HttpRequest& request) {
  const auto answer = api::run_wheel_sweep(*service.catalogue(), request.body);
  if (!answer) return problem_response(answer.error(), &request);
  HttpResponse response = document(api::json::write_wheel_sweep_answer(*answer));
  if (accepts(request, kCsv)) {
    auto csv = api::json::wheel_sweep_csv(response.body);
    if (!csv) return problem_response(csv.error(), &request);
    response.body = std::move(*csv);
    response.content_type = kCsv;
  }
  response.headers.emplace_back("Vary", "Accept");
  return response;
}

HttpResponse ground_at(const api::Service& service, const HttpRequest& request) {
  Query query(request, {"x_m", "y_m"});
  const double x_m = query.required_number("x_m");
  const double y_m = query.required_number("y_m");
  if (const auto error = query.error()) return problem_response(*error, &request);
  const auto at = api::ground_at(service, request.parameter("name"), x_m, y_m);
  return at ? document(api::json::write_ground_at(*at)) : problem_response(at.error(), &request);
}

}  // namespace

std::vector<Route> api_routes(const api::Service& service, api::JobRunner& runner,
                              const RouteOptions& options, const std::vector<api::JobKind>& kinds) {
  const std::shared_ptr<const api::Catalogue> shipped = service.catalogue();
  const api::Catalogue& catalogue = *shipped;  // of what nobody sends
  std::vector<Route> routes{
      fixed("/openapi.json", std::string(api::openapi_document())),
      fixed("/errors", api::json::write_errors()),
      fixed("/v1/rovers", api::json::write_rovers(catalogue)),
      fixed("/v1/soils", api::json::write_soils(catalogue)),
      fixed("/v1/rules", api::json::write_rules(catalogue)),
      fixed("/v1/effects", api::json::write_effects()),
      fixed("/v1/planners", api::json::write_planners(service.options().planners, service.options().costs)),
      {"GET", "/v1/terrains/{name}/point",
       [&service](const HttpRequest& r) { return ground_at(service, r); }},
      {"POST", "/v1/wheel-sweeps", [&service](const HttpRequest& r) { return wheel_sweep(service, r); },
       Threads::kHeavy},
  };
  routes.push_back(fixed("/healthz", api::json::write_health()));
  routes.back().threads = Threads::kPrompt;
  for (std::vector<Route> more :
       {job_routes(service, runner, options, kinds), comparison_routes(runner.store()),
        override_routes(runner.store(), options), upload_routes(service), terrain_routes(service)})
    std::move(more.begin(), more.end(), std::back_inserter(routes));
  return routes;
}

}  // namespace slipway::server
