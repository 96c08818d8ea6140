#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "api/service.h"
#include "core/progress.h"
#include "core/result.h"

namespace slipway::server {

// Where the command line's questions go: to the service in this process, or over HTTP to one that runs
// elsewhere. Both answer with the same documents.
class Inquiry {
 public:
  virtual ~Inquiry() = default;
  virtual Result<std::string> plan(const std::string& request, Progress& progress) = 0;
  virtual Result<std::string> predict(const std::string& request, Progress& progress) = 0;
  virtual Result<std::string> check(const std::string& request, Progress& progress) = 0;
  virtual Result<std::string> sol(const std::string& request, Progress& progress) = 0;
  virtual Result<std::string> wheel_sweep(const std::string& request) = 0;
  // "terrains", "rovers", "soils", "effects", "planners".
  virtual Result<std::string> catalogue(std::string_view kind) = 0;
  virtual Result<std::string> ground_at(std::string_view terrain, double x_m, double y_m) = 0;
  // The picture of the last plan or prediction that was answered, as SVG.
  virtual Result<std::string> map() = 0;
  // All stations of the last answer as CSV, those too that its document leaves out.
  virtual Result<std::string> stations() = 0;
  // The report of the last check or sol that was answered, as an HTML page.
  virtual Result<std::string> report() = 0;
  // Whether there is anybody.
  virtual Result<std::string> health() = 0;
};

// Errors: unreadable_data with the faults of all files under the folders; those of api::with_model().
Result<std::unique_ptr<Inquiry>> local_inquiry(api::ServiceOptions options);
// url: "http://HOST:PORT", "http://[::1]:PORT".
Result<std::unique_ptr<Inquiry>> remote_inquiry(const std::string& url);

}  // namespace slipway::server
