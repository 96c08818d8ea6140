#include "server/routes/upload_routes.h"

#include <fmt/format.h>

#include <optional>
#include <string>
#include <utility>

#include "api/documents/catalogue_documents.h"
#include "api/uploads/upload_documents.h"
#include "core/utc.h"
#include "server/routes/query.h"
#include "server/routes/responses.h"

namespace slipway::server {
namespace {

constexpr Threads kHeavy = Threads::kHeavy;

HttpResponse current(std::string body, const HttpRequest& request) {
  HttpResponse response = document(std::move(body));
  const std::string tag = tag_of(response.body);
  return tagged(std::move(response), tag, request);
}

class UploadRoutes {
 public:
  explicit UploadRoutes(const api::Service& service) : service_(service) {}

  HttpResponse keep(const HttpRequest& request) const {
    if (service_.uploads() == nullptr) return nothing_taken(request);
    Query query(request, {"name"});
    const std::string name = query.required_text("name");
    if (const auto error = query.error()) return problem_response(*error, &request);
    if (!request.body_file)
      return problem(ErrorCode::kInvalidRequest, "the request has no body: send the file's bytes", request);
    const auto upload = service_.uploads()->keep(request.body_file->fd(), name,
                                                 {.owner = request.principal, .at_ms = now_ms()});
    if (!upload) return problem_response(upload.error(), &request);
    HttpResponse response = document(api::json::write_upload(*upload), 201);
    response.headers.emplace_back("Location", fmt::format("{}/{}", kUploadsPath, upload->id));
    return response;
  }

  HttpResponse list(const HttpRequest& request) const {
    if (const auto error = Query(request, {}).error()) return problem_response(*error, &request);
    return current(
        api::json::write_uploads(service_.uploads() == nullptr ? std::vector<api::Upload>{}
                                                               : service_.uploads()->list(asker(request))),
        request);
  }

  HttpResponse get(const HttpRequest& request) const {
    const auto upload = find(request);
    if (!upload) return problem(ErrorCode::kNotFound, "there is no upload of this id", request);
    return current(api::json::write_upload(*upload), request);
  }

  HttpResponse remove(const HttpRequest& request) const {
    const auto upload = find(request);
    if (!upload) return problem(ErrorCode::kNotFound, "there is no upload of this id", request);
    if (const auto refused = not_allowed(upload->origin, request)) return *refused;
    return removed(service_.uploads()->remove(*upload), "upload", request);
  }

  HttpResponse campaigns(const HttpRequest& request) const {
    if (const auto error = Query(request, {}).error()) return problem_response(*error, &request);
    return current(api::json::write_drive_campaigns(service_.campaigns(), sent_campaigns()), request);
  }

  HttpResponse remove_campaign(const HttpRequest& request) const {
    const std::string name(request.parameter("name"));
    for (const api::ShippedCampaign& campaign : service_.campaigns())
      if (campaign.name == name) return shipped("campaign", request);
    const auto folder =
        service_.uploads() == nullptr ? std::nullopt : api::uploaded_campaign(*service_.uploads(), name);
    if (!folder) return problem(ErrorCode::kNotFound, "there is no campaign of this name", request);
    return remove_folder(folder->parent_path(), "campaign", request);
  }

  HttpResponse terrains(const HttpRequest& request) const {
    if (const auto error = Query(request, {}).error()) return problem_response(*error, &request);
    return current(api::json::write_terrains(*service_.catalogue()), request);
  }

  HttpResponse remove_terrain(const HttpRequest& request) const {
    const std::string name(request.parameter("name"));
    if (!service_.catalogue()->terrains.contains(name))
      return problem(ErrorCode::kNotFound, "there is no terrain of this name", request);
    if (service_.uploads() == nullptr || service_.ships(name)) return shipped("terrain", request);
    return remove_folder(service_.uploads()->terrains() / name, "terrain", request);
  }

 private:
  static HttpResponse nothing_taken(const HttpRequest& request) {
    return problem(ErrorCode::kNotFound,
                   "this service takes no uploads: its operator starts it with --uploads", request);
  }
  static HttpResponse shipped(std::string_view what, const HttpRequest& request) {
    return problem(ErrorCode::kForbidden,
                   fmt::format("the {} ships with the service: it can't be removed", what), request);
  }

  static api::Asker asker(const HttpRequest& request) { return {request.principal, request.is_admin}; }
  std::optional<api::Upload> find(const HttpRequest& request) const {
    return service_.uploads() == nullptr ? std::nullopt
                                         : service_.uploads()->find(request.parameter("id"), asker(request));
  }
  std::vector<api::UploadedCampaign> sent_campaigns() const {
    if (service_.uploads() == nullptr) return {};
    return api::uploaded_campaigns(*service_.uploads(), *service_.catalogue());
  }

  // What somebody else sent.
  static std::optional<HttpResponse> not_allowed(const std::optional<api::UploadOrigin>& origin,
                                                 const HttpRequest& request) {
    if (api::may_change(origin, asker(request))) return std::nullopt;
    return problem(ErrorCode::kForbidden, "it was sent by somebody else", request);
  }

  static HttpResponse remove_folder(const std::filesystem::path& folder, std::string_view what,
                                    const HttpRequest& request) {
    if (const auto refused = not_allowed(api::read_origin(folder), request)) return *refused;
    return removed(api::take_away(folder), what, request);
  }

  static HttpResponse removed(const Result<bool>& done, std::string_view what, const HttpRequest& request) {
    if (!done) return problem_response(done.error(), &request);
    if (!*done) return problem(ErrorCode::kNotFound, fmt::format("the {} is gone already", what), request);
    HttpResponse response;
    response.status = 204;
    return response;
  }

  const api::Service& service_;
};

}  // namespace

std::vector<Route> upload_routes(const api::Service& service) {
  const UploadRoutes uploads(service);
  const std::string of_one = std::string(kUploadsPath) + "/{id}";
  return {
      {"POST", std::string(kUploadsPath), [uploads](const HttpRequest& r) { return uploads.keep(r); },
       kHeavy},
      {"GET", std::string(kUploadsPath), [uploads](const HttpRequest& r) { return uploads.list(r); }},
      {"GET", of_one, [uploads](const HttpRequest& r) { return uploads.get(r); }},
      {"DELETE", of_one, [uploads](const HttpRequest& r) { return uploads.remove(r); }},
      {"GET", "/v1/drive-campaigns", [uploads](const HttpRequest& r) { return uploads.campaigns(r); }},
      {"DELETE", "/v1/drive-campaigns/{name}",
       [uploads](const HttpRequest& r) { return uploads.remove_campaign(r); }},
      {"GET", "/v1/terrains", [uploads](const HttpRequest& r) { return uploads.terrains(r); }},
      {"DELETE", "/v1/terrains/{name}",
       [uploads](const HttpRequest& r) { return uploads.remove_terrain(r); }},
  };
}

}  // namespace slipway::server
