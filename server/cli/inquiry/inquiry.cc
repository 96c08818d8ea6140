#include "server/cli/inquiry/inquiry.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <charconv>
#include <chrono>
#include <cstdlib>
#include <iostream>
#include <thread>

#include "api/documents/catalogue_documents.h"
#include "api/documents/soil/wheel_sweep_answer.h"
#include "api/export/station_csv.h"
#include "api/job_kinds.h"
#include "api/json/parse.h"
#include "api/json/problem_document.h"
#include "api/report/check_report.h"
#include "api/report/route_map.h"
#include "api/service.h"
#include "api/service_map.h"
#include "api/wheel_sweep.h"
#include "server/cli/inquiry/data_folder.h"
#include "server/http/http_client.h"

namespace slipway::server {
namespace {

using api::json::JsonValue;

class LocalInquiry final : public Inquiry {
 public:
  explicit LocalInquiry(std::unique_ptr<api::Service> service)
      : service_(std::move(service)), work_(api::service_work(*service_)) {}

  Result<std::string> plan(const std::string& request, Progress& progress) override {
    return ask(api::kPlanKind, request, progress);
  }
  Result<std::string> predict(const std::string& request, Progress& progress) override {
    return ask(api::kPredictionKind, request, progress);
  }
  Result<std::string> check(const std::string& request, Progress& progress) override {
    return ask(api::kCheckKind, request, progress);
  }
  Result<std::string> sol(const std::string& request, Progress& progress) override {
    return ask(api::kSolKind, request, progress);
  }

  Result<std::string> wheel_sweep(const std::string& request) override {
    const auto answer = api::run_wheel_sweep(*service_->catalogue(), request);
    if (!answer) return fail(answer.error());
    return api::json::write_wheel_sweep_answer(*answer);
  }

  Result<std::string> catalogue(std::string_view kind) override {
    const std::shared_ptr<const api::Catalogue> catalogue = service_->catalogue();
    const api::Catalogue& all = *catalogue;
    if (kind == "terrains") return api::json::write_terrains(all);
    if (kind == "rovers") return api::json::write_rovers(all);
    if (kind == "soils") return api::json::write_soils(all);
    if (kind == "effects") return api::json::write_effects();
    return api::json::write_planners(service_->options().planners, service_->options().costs);
  }

  Result<std::string> ground_at(std::string_view terrain, double x_m, double y_m) override {
    const auto at = api::ground_at(*service_, terrain, x_m, y_m);
    if (!at) return fail(at.error());
    return api::json::write_ground_at(*at);
  }

  Result<std::string> map() override { return api::draw_route_map(*service_->catalogue(), last_); }

  Result<std::string> stations() override {
    if (series_.empty()) return api::json::station_csv(last_);
    return fmt::format("{}", fmt::join(series_, ""));
  }

  Result<std::string> report() override {
    return api::find_kind(api::job_kinds(), kind_)->page(*service_->catalogue(), last_);
  }

  Result<std::string> health() override { return api::json::write_health(); }

 private:
  Result<std::string> ask(std::string_view kind, const std::string& request, Progress& progress) {
    auto answer = work_(std::string(kind), request, progress);
    if (!answer) return fail(answer.error());
    kind_ = kind;
    last_ = std::move(answer->bytes);
    series_ = std::move(answer->series);
    return last_;
  }

  std::unique_ptr<api::Service> service_;
  api::JobWork work_;
  std::string kind_, last_;
  std::vector<std::string> series_;  // of it
};

// The token that a service may ask for, from the environment: a command line is seen by everybody.
NamedValues with_token(NamedValues headers) {
  const char* const token = std::getenv("SLIPWAY_TOKEN");
  if (token != nullptr && *token != '\0')
    headers.emplace_back("Authorization", fmt::format("Bearer {}", token));
  return headers;
}

class RemoteInquiry final : public Inquiry {
 public:
  RemoteInquiry(std::string host, int port) : host_(std::move(host)), port_(port) {}

  Result<std::string> plan(const std::string& request, Progress& progress) override {
    return job(api::find_kind(api::job_kinds(), api::kPlanKind)->path, request, progress);
  }
  Result<std::string> predict(const std::string& request, Progress& progress) override {
    return job(api::find_kind(api::job_kinds(), api::kPredictionKind)->path, request, progress);
  }
  Result<std::string> check(const std::string& request, Progress& progress) override {
    return job(api::find_kind(api::job_kinds(), api::kCheckKind)->path, request, progress);
  }
  Result<std::string> sol(const std::string& request, Progress& progress) override {
    return job(api::find_kind(api::job_kinds(), api::kSolKind)->path, request, progress);
  }
  Result<std::string> wheel_sweep(const std::string& request) override {
    return call("POST", "/v1/wheel-sweeps", request, {});
  }
  Result<std::string> catalogue(std::string_view kind) override { return get(fmt::format("/v1/{}", kind)); }
  Result<std::string> ground_at(std::string_view terrain, double x_m, double y_m) override {
    return get(fmt::format("/v1/terrains/{}/point?x_m={}&y_m={}", terrain, x_m, y_m));
  }
  Result<std::string> map() override { return get(location_ + "/map"); }
  Result<std::string> stations() override {
    std::string all;
    for (int page = 1;; ++page) {
      auto next = get(fmt::format("{}/stations?page={}", location_, page));
      if (!next && next.error().code == ErrorCode::kNotFound && page > 1) return all;
      if (!next) return next;
      all += *next;
    }
  }
  Result<std::string> report() override { return get(location_ + "/report"); }
  Result<std::string> health() override { return get("/healthz"); }

 private:
  Result<std::string> call(const std::string& method, const std::string& path, const std::string& body,
                           NamedValues headers) {
    const auto response = http_request({.method = method,
                                        .host = host_,
                                        .port = port_,
                                        .path = path,
                                        .headers = with_token(std::move(headers)),
                                        .body = body});
    if (!response) return fail(response.error());
    if (response->status >= 400) return fail(api::json::read_problem(response->body));
    if (const auto location = response->header("Location")) location_ = *location;
    return response->body;
  }
  Result<std::string> get(const std::string& path) { return call("GET", path, "", {}); }

  // Records the job, then polls it; a question that is given up is taken back.
  Result<std::string> job(const std::string& path, const std::string& request, Progress& progress) {
    if (auto created = call("POST", path, request, {{"Prefer", "respond-async"}}); !created) return created;
    for (;;) {
      auto document = get(location_);
      if (!document) return document;
      const auto parsed =
          api::json::parse(*document, {.bytes = document->size(), .values = document->size()});
      if (!parsed) return fail(parsed.error());
      const JsonValue* state = parsed->find("state");
      const JsonValue* stage = parsed->find("stage");
      const JsonValue* share = parsed->find("progress");
      if (!state || (state->text != "accepted" && state->text != "running"))
        return get(location_ + "/result");
      progress.report(stage ? stage->text : "", share ? share->number : 0.0);
      if (progress.cancelled()) {
        if (auto dismissed = call("DELETE", location_, "", {}); !dismissed) return dismissed;
        return fail(ErrorCode::kCancelled, "the question was given up and its job dismissed");
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
  }

  std::string host_;
  int port_;
  std::string location_;
};

}  // namespace

Result<std::unique_ptr<Inquiry>> local_inquiry(api::ServiceOptions options) {
  auto service = api::Service::open(std::move(options));
  if (!service) return fail(service.error());
  std::cerr << left_out_text(*(*service)->catalogue());
  return std::make_unique<LocalInquiry>(std::move(*service));
}

Result<std::unique_ptr<Inquiry>> remote_inquiry(const std::string& url) {
  constexpr std::string_view kScheme = "http://";
  const std::size_t colon = url.rfind(':');
  int port = 0;
  if (url.starts_with(kScheme) && colon != std::string::npos && colon > kScheme.size()) {
    std::string_view digits = std::string_view(url).substr(colon + 1);
    if (digits.ends_with('/')) digits.remove_suffix(1);
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), port);
    if (error != std::errc() || end != digits.data() + digits.size()) port = 0;
  }
  std::string host = port > 0 ? url.substr(kScheme.size(), colon - kScheme.size()) : "";
  const bool bracketed = host.starts_with('[') && host.ends_with(']');
  if (bracketed) host = host.substr(1, host.size() - 2);
  if (!bracketed && host.find(':') != std::string::npos) port = 0;
  if (port < 1 || port > 65535)
    return fail(ErrorCode::kInvalidRequest,
                "--url must be http://HOST:PORT, with an IPv6 address in brackets",
                {{"/url", fmt::format("url = \"{}\"", url)}});
  return std::make_unique<RemoteInquiry>(std::move(host), port);
}

}  // namespace slipway::server
