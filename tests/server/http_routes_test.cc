#include "server/http/http_routes.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "raw_client.h"

namespace slipway::server {
namespace {

Route named(std::string method, std::string pattern) {
  const std::string name = method + " " + pattern;
  return {std::move(method), std::move(pattern), [name](const HttpRequest& r) {
            std::string body = name;
            for (const auto& [key, value] : r.parameters) body += " " + key + "=" + value;
            return HttpResponse{200, "text/plain", body, {}};
          }};
}

HttpResponse ask(const RouteTable& table, std::string method, std::string path) {
  HttpRequest request;
  request.method = std::move(method);
  request.raw_path = path;
  request.path = std::move(path);
  return table.answer(request, test_problem);
}

TEST(RouteTable, ALiteralSegmentWinsOverAParameterInWhicheverOrderTheyAreGiven) {
  const RouteTable table(
      {named("GET", "/jobs/{id}"), named("GET", "/jobs/schema"), named("GET", "/{kind}/schema")});
  EXPECT_EQ(ask(table, "GET", "/jobs/schema").body, "GET /jobs/schema");
  EXPECT_EQ(ask(table, "GET", "/jobs/9").body, "GET /jobs/{id} id=9");
  EXPECT_EQ(ask(table, "GET", "/soils/schema").body, "GET /{kind}/schema kind=soils");
}

TEST(RouteTable, SeveralParametersAreFoundByName) {
  const RouteTable table({named("GET", "/v1/jobs/{id}/routes/{rank}")});
  EXPECT_EQ(ask(table, "GET", "/v1/jobs/a%20b/routes/%32").body,
            "GET /v1/jobs/{id}/routes/{rank} id=a b rank=2");
}

TEST(RouteTable, OnlyTheWholeAddressMatches) {
  const RouteTable table({named("GET", "/jobs/{id}"), named("GET", "/")});
  for (const char* path :
       {"/jobs", "/jobs/", "/jobs/1/", "/jobs/1/x", "//jobs/1", "/jobs//", "/Jobs/1", "//"}) {
    EXPECT_EQ(ask(table, "GET", path).status, 404) << path;
  }
  EXPECT_EQ(ask(table, "GET", "/").status, 200);
  EXPECT_EQ(ask(table, "GET", "/%6aobs/1").status, 200) << "an encoded letter is that letter";
}

TEST(RouteTable, AHeadRouteOfItsOwnIsPreferredToTheGetRoute) {
  const RouteTable table({named("GET", "/a"), named("HEAD", "/a"), named("GET", "/b")});
  EXPECT_EQ(ask(table, "HEAD", "/a").body, "HEAD /a");
  EXPECT_EQ(ask(table, "HEAD", "/b").body, "GET /b");
}

TEST(RouteTable, AMethodNotAllowedNamesThoseThatAre) {
  const RouteTable table({named("POST", "/jobs")});
  const HttpResponse response = ask(table, "GET", "/jobs");
  EXPECT_EQ(response.status, 405);
  EXPECT_EQ(response.header("allow"), "OPTIONS, POST");
}

TEST(RouteTable, MalformedPatternsAreRefusedWhenTheTableIsMade) {
  for (const char* pattern : {"", "jobs", "/a{id}", "/{}", "/{a}b", "/a?b", "/a%20b"}) {
    EXPECT_THROW(RouteTable({named("GET", pattern)}), std::invalid_argument) << pattern;
  }
  EXPECT_THROW(RouteTable({{"GET", "/a", nullptr}}), std::invalid_argument);
  EXPECT_THROW(RouteTable({named("GET", "/a"), named("GET", "/a")}), std::invalid_argument);
  EXPECT_NO_THROW(RouteTable({named("GET", "/a"), named("POST", "/a")}));
}

TEST(RouteTable, APathOfManySegmentsIsMatchedAtOnce) {
  // Nested quantifiers in std::regex take forever, or the stack, on such a path.
  const RouteTable table({named("GET", "/{a}/{b}/{c}/{d}/end")});
  std::string path;
  for (int i = 0; i < 4'000; ++i) path += "/a";
  EXPECT_EQ(ask(table, "GET", path).status, 404);
}

}  // namespace
}  // namespace slipway::server
