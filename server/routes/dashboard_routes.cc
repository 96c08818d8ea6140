#include "server/routes/dashboard_routes.h"

#include <fmt/format.h>

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "server/routes/dashboard_files.h"
#include "server/routes/gzip.h"
#include "server/routes/request_headers.h"
#include "server/routes/responses.h"

namespace slipway::server {
namespace {

// No script, style or address of anybody else's, and no page of anybody else's around it.
constexpr std::string_view kPolicy =
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob: data:; connect-src "
    "'self'; "
    "base-uri 'none'; form-action 'none'; frame-ancestors 'none'";
constexpr std::string_view kIndex = "index.html";

std::string_view type_of(std::string_view name) {
  constexpr std::pair<std::string_view, std::string_view> kTypes[] = {
      {".html", "text/html; charset=utf-8"}, {".js", "text/javascript; charset=utf-8"},
      {".css", "text/css; charset=utf-8"},   {".svg", "image/svg+xml"},
      {".json", "application/json"},         {".txt", "text/plain; charset=utf-8"}};
  for (const auto& [ending, type] : kTypes)
    if (name.ends_with(ending)) return type;
  return "application/octet-stream";
}

// A file of the dashboard; its compressed form is made when it is first wanted.
class ServedFile {
 public:
  explicit ServedFile(const DashboardFile& file) : file_(file), tag_(tag_of(file.bytes)) {}

  HttpResponse answer(const HttpRequest& request) {
    HttpResponse response;
    response.content_type = type_of(file_.name);
    // The names of all others hold a hash of what is in them.
    response.headers = {
        {"Cache-Control", file_.name == kIndex ? "no-cache" : "public, max-age=31536000, immutable"},
        {"Content-Security-Policy", std::string(kPolicy)},
        {"Referrer-Policy", "no-referrer"},
        {"Vary", "Accept-Encoding"}};
    if (accepts_encoding(request, "gzip")) {
      std::call_once(packed_once_, [this] { packed_ = gzipped(file_.bytes); });
      response.body = packed_;
      response.headers.emplace_back("Content-Encoding", "gzip");
      return tagged(std::move(response), fmt::format("{}-gzip\"", tag_.substr(0, tag_.size() - 1)), request);
    }
    response.body = file_.bytes;
    return tagged(std::move(response), tag_, request);
  }

 private:
  DashboardFile file_;
  std::string tag_;
  std::once_flag packed_once_;
  std::string packed_;
};

// Relative, for a service behind a path of a proxy's.
Route moved(std::string pattern, std::string to) {
  return {"GET", std::move(pattern), [to = std::move(to)](const HttpRequest&) {
            constexpr int kSeeOther = 303;
            HttpResponse response;
            response.status = kSeeOther;
            response.headers = {{"Location", to}};
            return response;
          }};
}

}  // namespace

std::vector<Route> dashboard_routes() {
  std::vector<Route> routes;
  for (const DashboardFile& file : dashboard_files()) {
    const auto served = std::make_shared<ServedFile>(file);
    const std::string name(file.name == kIndex ? "" : file.name);
    routes.push_back({"GET", "/dashboard/" + name,
                      [served](const HttpRequest& request) { return served->answer(request); }});
  }
  routes.push_back(moved("/dashboard", "dashboard/"));
  routes.push_back(moved("/", "dashboard/"));
  return routes;
}

}  // namespace slipway::server
