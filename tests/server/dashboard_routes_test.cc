#include "server/routes/dashboard_routes.h"

#include <gtest/gtest.h>

#include <string>

#include "server/routes/responses.h"

namespace slipway::server {
namespace {

TEST(DashboardRoutes, ThePageIsServedWithAStrictPolicyPackedWhereThatIsTaken) {
  const RouteTable table(dashboard_routes());
  const auto get = [&](const std::string& path, NamedValues headers = {}) {
    HttpRequest request;
    request.method = "GET";
    request.path = request.raw_path = path;
    request.headers = std::move(headers);
    return table.answer(request, problem_response);
  };
  const auto page = get("/dashboard/");
  ASSERT_EQ(page.status, 200);
  EXPECT_EQ(page.content_type, "text/html; charset=utf-8");
  EXPECT_EQ(page.header("Content-Security-Policy")->find("unsafe"), std::string::npos);
  EXPECT_EQ(page.header("Cache-Control"), "no-cache");
  EXPECT_EQ(page.body.find("=\"/"), std::string::npos) << "an address that is not relative";
  EXPECT_EQ(page.body.find("http"), std::string::npos) << "an address of another host";
  const auto packed = get("/dashboard/", {{"Accept-Encoding", "br, gzip"}});
  EXPECT_EQ(packed.header("Content-Encoding"), "gzip");
  EXPECT_EQ(packed.body.substr(0, 2), "\x1f\x8b");
  EXPECT_NE(packed.header("ETag"), page.header("ETag"));
  EXPECT_EQ(get("/dashboard/", {{"Accept-Encoding", "gzip;q=0"}}).header("Content-Encoding"), std::nullopt);
  EXPECT_EQ(get("/dashboard/", {{"If-None-Match", *page.header("ETag")}}).status, 304);
  const std::size_t script = page.body.find("assets/");
  ASSERT_NE(script, std::string::npos);
  const std::string asset = page.body.substr(script, page.body.find('"', script) - script);
  EXPECT_NE(get("/dashboard/" + asset).header("Cache-Control")->find("immutable"), std::string::npos)
      << asset;
  EXPECT_EQ(get("/dashboard").header("Location"), "dashboard/");
  EXPECT_EQ(get("/").header("Location"), "dashboard/");
  EXPECT_EQ(get("/dashboard/sources.sha256").status, 404);
}

}  // namespace
}  // namespace slipway::server
