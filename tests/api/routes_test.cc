#include "server/routes/routes.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cctype>
#include <functional>
#include <set>
#include <thread>

#include "api/jobs/open_job_store.h"
#include "api/json/parse.h"
#include "api/openapi.h"
#include "core/version.h"
#include "server/routes/operator_routes.h"
#include "server/routes/responses.h"
#include "small_world.h"

namespace slipway::server {
namespace {

using api::json::JsonValue;
using api::testing::example;
using api::testing::small_world;
using std::chrono::milliseconds;
using std::chrono::seconds;

// The routes over a runner whose work a test decides; requests go through the table as they do in the server.
class Routes : public ::testing::Test {
 protected:
  void run(api::JobWork work, RouteOptions options = {}, const api::JobRunnerOptions& runner_options = {}) {
    runner_ =
        std::make_unique<api::JobRunner>(api::open_job_store("").value(), std::move(work), runner_options);
    table_ = std::make_unique<RouteTable>(api_routes(small_world(), *runner_, options));
    ASSERT_TRUE(runner_->start());
  }
  void SetUp() override {
    run([](const std::string&, const std::string&, Progress&) { return Result<std::string>(kAnswer); });
  }

  HttpResponse ask(const std::string& method, const std::string& path, NamedValues headers = {},
                   const std::string& body = "", NamedValues query = {}) {
    HttpRequest request;
    request.method = method;
    request.path = path;
    request.raw_path = path;
    request.headers = std::move(headers);
    request.body = body;
    request.query = std::move(query);
    return table_->answer(request, problem_response);
  }
  std::string submit() {
    return ask("POST", "/v1/plans", {}, example("plan_shortest.json")).header("Location").value();
  }

  static JsonValue read(const HttpResponse& response) {
    auto document = api::json::parse(response.body);
    EXPECT_TRUE(document) << response.body;
    return document.value_or(JsonValue{});
  }
  static std::string text(const HttpResponse& response, std::string_view key) {
    const JsonValue document = read(response);
    const JsonValue* const value = document.find(key);
    return value == nullptr ? "" : value->text;
  }
  static void until(const std::function<bool()>& condition) {
    for (int i = 0; i < 1000 && !condition(); ++i) std::this_thread::sleep_for(milliseconds(5));
    ASSERT_TRUE(condition());
  }

  static constexpr const char* kAnswer =
      R"({"format":"plan/1","routes":{"type":"FeatureCollection","features":[]}})";
  std::unique_ptr<api::JobRunner> runner_;
  std::unique_ptr<RouteTable> table_;
};

// Ends when nobody wants it any more.
Result<std::string> endless(const std::string& /*kind*/, const std::string& /*request*/, Progress& progress) {
  while (!progress.cancelled()) std::this_thread::sleep_for(milliseconds(10));
  return fail(ErrorCode::kCancelled, "");
}

// A runner of a diagnosis that was asked for without a look at its request.
class DiagnosisRoutes : public Routes {
 protected:
  std::string begin() { return runner_->submit("diagnosis", "{}").value().id; }
};

TEST_F(DiagnosisRoutes, AFinishedDiagnosisHasADocumentAndAPage) {
  run([](const std::string&, const std::string&, Progress&) {
    return Result<std::string>("{\"format\":\"diagnosis/1\"}\n<!DOCTYPE html>\n<p>seen</p>");
  });
  const std::string id = begin();
  ASSERT_EQ(runner_->wait(id, milliseconds(5000)).value()->state, api::JobState::kSuccessful);
  const HttpResponse result = ask("GET", "/v1/jobs/" + id + "/result");
  EXPECT_EQ(result.body, "{\"format\":\"diagnosis/1\"}");
  for (const std::string kind : {"jobs", "diagnoses"}) {
    const HttpResponse page = ask("GET", "/v1/" + kind + "/" + id + "/report");
    EXPECT_EQ(page.status, 200);
    EXPECT_EQ(page.content_type, "text/html; charset=utf-8");
    EXPECT_EQ(page.body, "<!DOCTYPE html>\n<p>seen</p>");
    EXPECT_TRUE(page.header("Content-Security-Policy").value_or("").starts_with("default-src 'none'"));
    EXPECT_EQ(
        ask("GET", "/v1/" + kind + "/" + id + "/report", {{"If-None-Match", *page.header("ETag")}}).status,
        304);
  }
}

TEST_F(DiagnosisRoutes, AReportThatThereIsNotIsAProblem) {
  run(endless);
  const std::string id = begin();
  EXPECT_EQ(ask("GET", "/v1/jobs/" + id + "/report").status, 409);
  EXPECT_EQ(ask("GET", "/v1/jobs/" + id + "/report").content_type, "application/problem+json");
  EXPECT_EQ(ask("GET", "/v1/diagnoses/" + std::string(32, '0') + "/report").status, 404);
  EXPECT_EQ(ask("DELETE", "/v1/jobs/" + id).status, 200);
  EXPECT_EQ(ask("GET", "/v1/jobs/" + id + "/report").status, 409);
  run([](const std::string&, const std::string&, Progress&) { return Result<std::string>(kAnswer); });
  const std::string plan = submit();
  const std::string old = begin();  // of a version that kept no page
  runner_->wait(old, milliseconds(5000));
  EXPECT_EQ(ask("GET", plan + "/report").status, 404);
  EXPECT_EQ(ask("GET", "/v1/jobs/" + old + "/report").status, 404);
}

TEST_F(Routes, HealthSaysOkAndTheVersion) {
  const HttpResponse response = ask("GET", "/healthz");
  EXPECT_EQ(response.status, 200);
  EXPECT_EQ(response.body, R"({"status":"ok","version":")" + std::string(version()) + "\"}");
}

TEST_F(Routes, CataloguesAreServedAndRevalidated) {
  for (const char* path :
       {"/v1/terrains", "/v1/rovers", "/v1/soils", "/v1/effects", "/v1/planners", "/errors"}) {
    const HttpResponse response = ask("GET", path);
    EXPECT_EQ(response.status, 200) << path;
    EXPECT_EQ(response.content_type, "application/json");
    const JsonValue document = read(response);
    const std::string key = std::string(path).substr(std::string(path).rfind('/') + 1);
    ASSERT_NE(document.find(key), nullptr) << path;
    EXPECT_FALSE(document.find(key)->elements.empty()) << path;
    const auto tag = response.header("ETag");
    ASSERT_TRUE(tag);
    const HttpResponse again = ask("GET", path, {{"If-None-Match", "\"x\", W/" + *tag}});
    EXPECT_EQ(again.status, 304);
    EXPECT_TRUE(again.body.empty());
  }
}

TEST_F(Routes, ATerrainShowsItsExtentLegendAssumptionAndStops) {
  const JsonValue document = read(ask("GET", "/v1/terrains"));
  const JsonValue& yard = document.find("terrains")->elements.front();
  EXPECT_EQ(yard.find("extent")->find("east_m")->number, 120.0);
  EXPECT_EQ(yard.find("cell_x_m")->number, 1.0);
  EXPECT_EQ(yard.find("body")->text, "Mars");
  EXPECT_EQ(yard.find("soil")->find("assumption")->text, "Made up for tests");
  EXPECT_TRUE(yard.find("soil")->find("legend")->elements[2].find("soil")->is(JsonValue::Kind::kNull));
  EXPECT_EQ(yard.find("stops")->elements[0].find("columns")->find("sol")->number, 3.0);
  EXPECT_EQ(yard.find("stops")->elements[0].find("columns")->find("drive_type")->text, "final");
}

TEST_F(Routes, APlanIsRecordedWithItsLocation) {
  const HttpResponse response = ask("POST", "/v1/plans", {}, example("plan_every_key.json"));
  EXPECT_EQ(response.status, 201) << response.body;
  const std::string location = response.header("Location").value();
  EXPECT_EQ(location, "/v1/jobs/" + text(response, "id"));
  EXPECT_EQ(text(response, "state"), "accepted");
  until([&] { return text(ask("GET", location), "state") == "successful"; });
  const HttpResponse result = ask("GET", location + "/result");
  EXPECT_EQ(result.status, 200);
  EXPECT_EQ(result.body, kAnswer);
  const HttpResponse routes = ask("GET", location + "/result", {{"Accept", "application/geo+json;q=0.9"}});
  EXPECT_EQ(routes.content_type, "application/geo+json");
  EXPECT_EQ(routes.body, R"({"type":"FeatureCollection","features":[]})");
}

TEST_F(Routes, AWheelSweepIsAnsweredAtOnceAsJsonOrCsv) {
  const std::string body = example("wheel_sweep_every_key.json");
  const HttpResponse json = ask("POST", "/v1/wheel-sweeps", {}, body);
  EXPECT_EQ(json.status, 200) << json.body;
  EXPECT_EQ(text(json, "format"), "wheel_sweep/1");
  EXPECT_EQ(json.header("Vary"), "Accept");
  const HttpResponse csv = ask("POST", "/v1/wheel-sweeps", {{"Accept", "text/csv"}}, body);
  EXPECT_EQ(csv.content_type, "text/csv");
  EXPECT_TRUE(csv.body.starts_with("effects.slip_sinkage.n1,slip,")) << csv.body;
  const HttpResponse refused = ask("POST", "/v1/wheel-sweeps", {{"Accept", "text/csv"}}, R"({"slip":2})");
  EXPECT_EQ(refused.status, 422);
  EXPECT_EQ(refused.content_type, "application/problem+json");
  EXPECT_EQ(read(refused).find("faults")->elements.size(), 3U);
}

TEST_F(Routes, PreferWaitGivesTheAnswerAtOnce) {
  for (const char* prefer : {"wait=5", "respond-async, wait=5", "return=minimal; x=1,WAIT=\"5\" ; y"}) {
    const HttpResponse response =
        ask("POST", "/v1/plans", {{"Prefer", prefer}}, example("plan_shortest.json"));
    EXPECT_EQ(response.status, 200) << prefer;
    EXPECT_EQ(response.body, kAnswer);
    EXPECT_EQ(response.header("Preference-Applied"), "wait=5");
  }
  for (const char* prefer : {"wait=-5", "wait=soon", "wait=", "wait=5x", "wait=99999999999999999999"}) {
    const HttpResponse response =
        ask("POST", "/v1/plans", {{"Prefer", prefer}}, example("plan_shortest.json"));
    EXPECT_EQ(response.status, 201) << prefer;
    EXPECT_EQ(response.header("Preference-Applied"), std::nullopt);
  }
}

TEST_F(Routes, APredictionIsWaitedForUnlessAskedOtherwise) {
  EXPECT_EQ(ask("POST", "/v1/predictions", {}, example("prediction_path.json")).status, 200);
  const HttpResponse later =
      ask("POST", "/v1/predictions", {{"Prefer", "respond-async"}}, example("prediction_path.json"));
  EXPECT_EQ(later.status, 201);
  EXPECT_EQ(later.header("Preference-Applied"), "respond-async");
}

TEST_F(Routes, WhatTakesLongerThanTheWaitIsAnsweredWithItsLocation) {
  run(endless, {.longest_wait = seconds(1)});
  const auto begin = std::chrono::steady_clock::now();
  const HttpResponse response =
      ask("POST", "/v1/plans", {{"Prefer", "wait=3600"}}, example("plan_shortest.json"));
  EXPECT_LT(std::chrono::steady_clock::now() - begin, seconds(3)) << "the cap is the server's";
  EXPECT_EQ(response.status, 201);
  EXPECT_EQ(response.header("Preference-Applied"), "wait=1");
  EXPECT_TRUE(response.header("Location"));
}

TEST_F(Routes, WaitingClientsNeverTakeAllHandlers) {
  run(endless, {.most_waiting = 0});
  const HttpResponse response =
      ask("POST", "/v1/plans", {{"Prefer", "wait=20"}}, example("plan_shortest.json"));
  EXPECT_EQ(response.status, 201);
  EXPECT_EQ(response.header("Preference-Applied"), std::nullopt);
}

TEST_F(Routes, ATableOfAThinnedAnswerHasAllItsRows) {
  run(api::service_work(small_world()));
  std::string path;  // to and fro over the yard, some kilometres
  for (int k = 0; k < 160; ++k)
    path +=
        fmt::format(R"({}{{"x_m":{},"y_m":{}}})", k == 0 ? "" : ",", k % 2 == 0 ? 20 : 40, 20.0 + 0.1 * k);
  const HttpResponse asked = ask("POST", "/v1/predictions", {{"Prefer", "respond-async"}},
                                 R"({"terrain":"yard","rover":"mer-class","draws":2,"path":[)" + path + "]}");
  ASSERT_EQ(asked.status, 201) << asked.body;
  const std::string location = *asked.header("Location");
  ASSERT_EQ(runner_->wait(location.substr(location.rfind('/') + 1), seconds(100)).value()->state,
            api::JobState::kSuccessful);
  const HttpResponse shown = ask("GET", location + "/result");
  ASSERT_NE(shown.body.find("thinned_from"), std::string::npos);
  const HttpResponse table = ask("GET", location + "/result", {{"Accept", "text/csv"}});
  EXPECT_EQ(table.content_type, "text/csv");
  ASSERT_TRUE(table.pieces);
  std::string all, pages;
  while (const auto piece = table.pieces().value()) all += *piece;
  for (int page = 1;; ++page) {
    const HttpResponse one = ask("GET", location + "/stations", {}, "", {{"page", std::to_string(page)}});
    pages += one.body;
    if (!one.header("Link")) break;
  }
  EXPECT_EQ(all, pages);
  EXPECT_EQ(
      ask("GET", location + "/result", {{"Accept", "text/csv"}, {"If-None-Match", *table.header("ETag")}})
          .status,
      304);
  EXPECT_NE(table.header("ETag"), shown.header("ETag"));
}

TEST_F(Routes, APollerHears304UntilSomethingChanges) {
  run(endless);
  const std::string location = submit();
  until([&] { return text(ask("GET", location), "state") == "running"; });
  until([&] { return text(ask("GET", location), "stage") == "starting"; });
  const std::string tag = ask("GET", location).header("ETag").value();
  EXPECT_EQ(ask("GET", location, {{"If-None-Match", tag}}).status, 304);
  EXPECT_EQ(ask("DELETE", location).status, 200);
  const HttpResponse changed = ask("GET", location, {{"If-None-Match", tag}});
  EXPECT_EQ(changed.status, 200);
  EXPECT_EQ(text(changed, "state"), "dismissed");
}

TEST_F(Routes, DeleteStopsTheWorkAndShowsNoResult) {
  run(endless);
  const std::string location = submit();
  EXPECT_EQ(ask("GET", location + "/result").status, 409);
  until([&] { return runner_->running() == 1; });
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_EQ(text(ask("DELETE", location), "state"), "dismissed");
  until([&] { return runner_->running() == 0; });
  EXPECT_LT(std::chrono::steady_clock::now() - begin, seconds(2));
  EXPECT_EQ(ask("DELETE", location).status, 200) << "again is no error";
  const HttpResponse result = ask("GET", location + "/result");
  EXPECT_EQ(result.status, 409);
  EXPECT_EQ(text(result, "type"), "/errors#cancelled");
}

TEST_F(Routes, WhatHasEndedIsNotDeleted) {
  const std::string location = submit();
  until([&] { return text(ask("GET", location), "state") == "successful"; });
  EXPECT_EQ(text(ask("DELETE", location), "type"), "/errors#conflict");
  EXPECT_EQ(ask("GET", location + "/result").status, 200);
}

TEST_F(Routes, AFailedJobShowsItsProblemEverywhere) {
  run([](const std::string&, const std::string&, Progress&) {
    return Result<std::string>(fail(ErrorCode::kNoData, "a hole", {{"/start", "no elevation"}}));
  });
  const HttpResponse waited = ask("POST", "/v1/plans", {{"Prefer", "wait=5"}}, example("plan_shortest.json"));
  EXPECT_EQ(waited.status, 422);
  EXPECT_EQ(waited.content_type, "application/problem+json");
  const std::string location = submit();
  until([&] { return text(ask("GET", location), "state") == "failed"; });
  const JsonValue job = read(ask("GET", location));
  EXPECT_EQ(job.find("problem")->find("faults")->elements[0].find("pointer")->text, "/start");
  EXPECT_EQ(ask("GET", location + "/result").body, waited.body);
}

TEST_F(Routes, ARefusalIsAProblemWithAllFaultsAndNothingIsRecorded) {
  const HttpResponse response = ask("POST", "/v1/plans", {}, example("plan_refused.json"));
  EXPECT_EQ(response.status, 422);
  EXPECT_EQ(response.content_type, "application/problem+json");
  const JsonValue problem = read(response);
  EXPECT_EQ(problem.find("type")->text, "/errors#invalid_request");
  EXPECT_EQ(problem.find("faults")->elements.size(), 6U);
  EXPECT_EQ(ask("POST", "/v1/plans", {}, "{\"a\":NaN}").status, 400);
  EXPECT_EQ(ask("POST", "/v1/plans", {}, std::string((std::size_t{1} << 20U) + 1, ' ')).status, 413);
  EXPECT_EQ(ask("POST", "/v1/predictions", {}, std::string(100'000, '[')).status, 400);
  EXPECT_EQ(ask("GET", "/v1/jobs").body, R"({"jobs":[]})");
}

TEST_F(Routes, AFullQueueSaysWhenToComeBack) {
  api::JobRunnerOptions options;
  options.admission.most_unfinished = 1;
  run(endless, {}, options);
  submit();
  const HttpResponse refused = ask("POST", "/v1/plans", {}, example("plan_shortest.json"));
  EXPECT_EQ(refused.status, 503);
  EXPECT_TRUE(refused.header("Retry-After"));
}

TEST_F(Routes, JobsAreListedNewestFirst) {
  const std::string first = submit();
  const std::string second = submit();
  const JsonValue jobs = read(ask("GET", "/v1/jobs"));
  EXPECT_EQ("/v1/jobs/" + jobs.find("jobs")->elements[0].find("id")->text, second);
  EXPECT_EQ("/v1/jobs/" + jobs.find("jobs")->elements[1].find("id")->text, first);
  EXPECT_EQ(read(ask("GET", "/v1/jobs", {}, "", {{"limit", "1"}})).find("jobs")->elements.size(), 1U);
  for (const char* bad : {"0", "x", "501", "1.5", "-1", ""}) {
    EXPECT_EQ(ask("GET", "/v1/jobs", {}, "", {{"limit", bad}}).status, 422) << bad;
  }
}

TEST_F(Routes, UnknownJobsAreNotFoundWhateverTheIdLooksLike) {
  for (const char* path : {"/v1/jobs/x", "/v1/jobs/..%2f..", "/v1/jobs/00000000000000000000000000000000",
                           "/v1/jobs/x/result", "/v1/nothing"}) {
    EXPECT_EQ(ask("GET", path).status, 404) << path;
  }
  EXPECT_EQ(ask("DELETE", "/v1/jobs/x").status, 404);
}

TEST_F(Routes, AQueryOfAPointNamesItsFaults) {
  const std::string path = "/v1/terrains/yard/point";
  EXPECT_EQ(ask("GET", path, {}, "", {{"x_m", "20"}, {"y_m", "20"}}).status, 200);
  const HttpResponse refused =
      ask("GET", path, {}, "", {{"x_m", "nan"}, {"y", "2"}, {"y_m", "1"}, {"y_m", "2"}});
  EXPECT_EQ(refused.status, 422);
  EXPECT_EQ(read(refused).find("faults")->elements.size(), 3U) << "each once: " << refused.body;
  for (const char* const list : {"/v1/terrains", "/v1/uploads", "/v1/drive-campaigns"}) {
    EXPECT_EQ(ask("GET", list).status, 200) << list;
    EXPECT_EQ(ask("GET", list, {}, "", {{"limit", "2"}}).status, 422) << list;
  }
  EXPECT_EQ(ask("GET", "/v1/terrains/mars/point", {}, "", {{"x_m", "20"}, {"y_m", "20"}}).status, 404);
}

TEST_F(Routes, TheDescriptionHasEveryRouteAndNoOther) {
  const auto document = api::json::parse(api::openapi_document());
  ASSERT_TRUE(document) << document.error().detail;
  std::set<std::string> described;
  const JsonValue& paths = *document->find("paths");
  for (std::size_t i = 0; i < paths.keys.size(); ++i) {
    for (const std::string& method : paths.elements[i].keys) described.insert(method + " " + paths.keys[i]);
  }
  std::set<std::string> served;
  ServiceMetrics metrics;
  std::vector<Route> routes = operator_routes({.metrics = metrics, .store = runner_->store()});
  for (Route& route : api_routes(small_world(), *runner_)) routes.push_back(std::move(route));
  for (const Route& route : routes) {
    std::string method = route.method;
    for (char& c : method) c = static_cast<char>(std::tolower(c));
    served.insert(method + " " + route.pattern);
  }
  EXPECT_EQ(served, described);
  EXPECT_EQ(document->find("info")->find("version")->text, version());
}

}  // namespace
}  // namespace slipway::server
