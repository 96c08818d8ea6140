// A kind of job added as CONTRIBUTING says, one row and no other change, seen acting from HTTP down.
#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "api/job_kinds.h"
#include "api/jobs/open_job_store.h"
#include "api/json/faults.h"
#include "api/json/parse.h"
#include "api/json/strict_reader.h"
#include "api/json/writer.h"
#include "server/http/http_client.h"
#include "server/http/http_server.h"
#include "server/routes/responses.h"
#include "server/routes/routes.h"
#include "small_world.h"

namespace slipway::server {
namespace {

using api::testing::small_world;

// How many rovers of the catalogue are heavier than a mass.
struct HeavyRequest {
  double mass_kg = 0.0;
};
struct HeavyAnswer {
  double mass_kg = 0.0;
  std::vector<std::string> rovers;
};

Result<HeavyRequest> read_heavy(const api::Service& /*service*/, std::string_view body) {
  const auto document = api::json::parse(body);
  if (!document) return fail(document.error());
  HeavyRequest request;
  std::vector<Fault> faults;
  api::json::ObjectReader reader(*document, "", faults);
  reader.number("mass_kg", api::json::kRequired, {"kg", 0.0, 1e4}, request.mass_kg);
  reader.refuse_unknown();
  if (!faults.empty()) return fail(ErrorCode::kInvalidRequest, api::summary_of(faults), faults);
  return request;
}

Result<HeavyAnswer> run_heavy(const api::Service& service, const HeavyRequest& request, Progress& progress) {
  progress.report("weighing", 0.5);
  HeavyAnswer answer{request.mass_kg, {}};
  for (const auto& [name, rover] : service.catalogue()->rovers)
    if (rover->mass_kg > request.mass_kg) answer.rovers.push_back(name);
  return answer;
}

std::string write_heavy(const HeavyAnswer& answer) {
  api::json::Writer w;
  w.begin_object().text("format", "heavy/1").exact("mass_kg", answer.mass_kg).texts("rovers", answer.rovers);
  w.end_object();
  return w.take();
}

Result<std::string> draw_heavy(const api::Catalogue& /*catalogue*/, std::string_view document) {
  return "<svg><!--" + std::string(document) + "--></svg>";
}

std::string heavy_page(const HeavyAnswer& answer) {
  return "<!DOCTYPE html>\n<p>" + std::to_string(answer.rovers.size()) + " rovers</p>";
}

using HeavyRow = api::JobKindRow<HeavyRequest, HeavyAnswer>;

HeavyRow bare_row() {
  return {.name = "heavy",
          .path = "/v1/heavy-rovers",
          .read = &read_heavy,
          .run = &run_heavy,
          .write = &write_heavy};
}

// A service that does the kinds that ship and one more.
class WithDummyKind {
 public:
  explicit WithDummyKind(HeavyRow row) : kinds_(api::job_kinds()) {
    kinds_.push_back(api::job_kind(std::move(row)));
    runner_ = std::make_unique<api::JobRunner>(api::open_job_store("").value(),
                                               api::service_work(small_world(), kinds_),
                                               api::JobRunnerOptions{.workers = api::worker_kinds(kinds_)});
    HttpOptions options;
    options.problem = problem_response;
    server_ = std::make_unique<HttpServer>(options, api_routes(small_world(), *runner_, {}, kinds_));
    EXPECT_TRUE(runner_->start());
    port_ = server_->start().value_or(0);
  }

  HttpResponse ask(const std::string& method, const std::string& path, const std::string& body = "") const {
    const auto response =
        http_request({.method = method, .port = port_, .path = path, .headers = {}, .body = body});
    EXPECT_TRUE(response);
    return response.value_or(HttpResponse{});
  }

  // The address of the job once it has ended.
  std::string done(const std::string& body) const {
    const HttpResponse created = ask("POST", "/v1/heavy-rovers", body);
    EXPECT_EQ(created.status, 201) << created.body;
    const std::string location = created.header("Location").value_or("");
    for (int i = 0; i < 1000; ++i) {
      const auto job = api::json::parse(ask("GET", location).body);
      EXPECT_EQ(job->find("kind")->text, "heavy");
      if (job->find("state")->text == "successful") return location;
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    ADD_FAILURE() << "the job did not end";
    return location;
  }

 private:
  std::vector<api::JobKind> kinds_;
  std::unique_ptr<api::JobRunner> runner_;
  std::unique_ptr<HttpServer> server_;
  int port_ = 0;
};

TEST(DummyJobKind, OneRowIsServedFromThePostToTheResult) {
  const WithDummyKind service(bare_row());
  const std::string job = service.done(R"({"mass_kg":500})");
  const HttpResponse result = service.ask("GET", job + "/result");
  EXPECT_EQ(result.status, 200);
  EXPECT_EQ(result.body, R"({"format":"heavy/1","mass_kg":500,"rovers":["m2020-class","msl-class"]})");
  EXPECT_NE(service.ask("GET", "/v1/jobs").body.find("\"heavy\""), std::string::npos);
}

TEST(DummyJobKind, ItsReaderRefusesWithEveryFault) {
  const WithDummyKind service(bare_row());
  const HttpResponse refused = service.ask("POST", "/v1/heavy-rovers", R"({"mass_kg":-1,"colour":"red"})");
  EXPECT_EQ(refused.status, 422);
  EXPECT_EQ(api::json::parse(refused.body)->find("faults")->elements.size(), 2U) << refused.body;
  EXPECT_EQ(service.ask("GET", "/v1/jobs").body, R"({"jobs":[]})");
}

TEST(DummyJobKind, WithoutMapAndReportThereAreNone) {
  const WithDummyKind service(bare_row());
  const std::string job = service.done(R"({"mass_kg":500})");
  for (const char* part : {"/map", "/report"}) {
    const HttpResponse none = service.ask("GET", job + part);
    EXPECT_EQ(none.status, 404) << part;
    EXPECT_NE(none.body.find("jobs of kind heavy have no"), std::string::npos) << none.body;
  }
  EXPECT_EQ(service.ask("GET", "/v1/heavy-rovers/" + job.substr(job.rfind('/') + 1) + "/report").status, 404);
}

TEST(DummyJobKind, ItsMapAndReportAreServed) {
  HeavyRow row = bare_row();
  row.map = &draw_heavy;
  row.report = &heavy_page;
  const WithDummyKind service(row);
  const std::string job = service.done(R"({"mass_kg":500})");
  EXPECT_EQ(service.ask("GET", job + "/result").body,
            R"({"format":"heavy/1","mass_kg":500,"rovers":["m2020-class","msl-class"]})");
  const HttpResponse map = service.ask("GET", job + "/map");
  EXPECT_EQ(map.status, 200);
  EXPECT_EQ(map.content_type, "image/svg+xml");
  EXPECT_NE(map.body.find("heavy/1"), std::string::npos);
  const std::string id = job.substr(job.rfind('/') + 1);
  for (const std::string& path : {job + "/report", "/v1/heavy-rovers/" + id + "/report"}) {
    const HttpResponse page = service.ask("GET", path);
    EXPECT_EQ(page.status, 200) << path;
    EXPECT_EQ(page.body, "<!DOCTYPE html>\n<p>2 rovers</p>");
  }
}

TEST(DummyJobKind, ItsUsualWaitIsTheClients) {
  HeavyRow row = bare_row();
  row.usual_wait = std::chrono::seconds(10);
  row.lane = api::Lane::kShort;
  const WithDummyKind service(row);
  const HttpResponse answer = service.ask("POST", "/v1/heavy-rovers", R"({"mass_kg":500})");
  EXPECT_EQ(answer.status, 200);
  EXPECT_EQ(answer.header("Preference-Applied"), "wait=10");
}

TEST(JobKinds, NoneWaitsBehindLongerWork) {
  const auto workers = api::worker_kinds();
  ASSERT_EQ(workers.size(), 3U);
  EXPECT_EQ(workers[0], (std::vector<std::string>{"plan", "prediction", "check", "sol", "diagnosis",
                                                  "model_check", "watch", "soil_estimate", "drive_campaign",
                                                  "terrain", "map", "batch"}));
  EXPECT_EQ(workers[1],
            (std::vector<std::string>{"plan", "prediction", "check", "sol", "model_check", "watch",
                                      "soil_estimate", "drive_campaign", "terrain", "map", "batch"}));
  EXPECT_EQ(workers[2], (std::vector<std::string>{"prediction", "check", "model_check", "soil_estimate",
                                                  "drive_campaign"}));
}

}  // namespace
}  // namespace slipway::server
