#include "server/http/http_client.h"

#include <gtest/gtest.h>

#include <optional>
#include <stdexcept>

#include "raw_client.h"

namespace slipway::server {
namespace {

using std::chrono::milliseconds;

HttpCall call_to(int port, std::string method, std::string path, std::string body = "") {
  HttpCall call;
  call.method = std::move(method);
  call.port = port;
  call.path = std::move(path);
  call.body = std::move(body);
  return call;
}

TEST(HttpClient, AnAnswerHasItsStatusTypeHeadersAndBody) {
  const TestServer s;
  const auto answer = http_request(call_to(s.port, "POST", "/echo", "{\"a\":1}"));
  ASSERT_TRUE(answer) << answer.error().detail;
  EXPECT_EQ(answer->status, 200);
  EXPECT_EQ(answer->body, "{\"a\":1}");
  EXPECT_EQ(answer->content_type, "text/plain");
  EXPECT_EQ(answer->header("x-content-type-options"), "nosniff");
}

TEST(HttpClient, AProblemIsAnAnswerToo) {
  const TestServer s;
  const auto answer = http_request(call_to(s.port, "DELETE", "/healthz"));
  ASSERT_TRUE(answer) << answer.error().detail;
  EXPECT_EQ(answer->status, 405);
  EXPECT_EQ(answer->content_type, "application/problem+json");
  EXPECT_NE(answer->body.find("/errors#method_not_allowed"), std::string::npos);
}

TEST(HttpClient, HeadersOfTheCallAreSent) {
  const TestServer s;
  HttpCall call = call_to(s.port, "GET", "/header/x-name");
  call.headers = {{"X-Name", "value"}};
  EXPECT_EQ(http_request(call)->body, "value");
}

TEST(HttpClient, AServerIsAskedOverIpv6) {
  HttpOptions options;
  options.address = "::1";
  std::optional<TestServer> s;
  try {
    s.emplace(options);
  } catch (const std::runtime_error& failed) {
    GTEST_SKIP() << "this machine has no ::1: " << failed.what();
  }
  HttpCall call = call_to(s->port, "GET", "/header/host");
  call.host = "::1";
  const auto answer = http_request(call);
  ASSERT_TRUE(answer) << answer.error().detail;
  EXPECT_EQ(answer->body, "[::1]:" + std::to_string(s->port));
}

TEST(HttpClient, NoServerIsAnErrorThatNamesThePlace) {
  int port = 0;
  {
    const TestServer s;
    port = s.port;
  }
  const auto answer = http_request(call_to(port, "GET", "/"));
  ASSERT_FALSE(answer);
  EXPECT_EQ(answer.error().code, ErrorCode::kNotFound);
  EXPECT_NE(answer.error().detail.find(std::to_string(port)), std::string::npos) << answer.error().detail;
}

TEST(HttpClient, AServerThatTakesTooLongIsATimeout) {
  const TestServer s;
  HttpCall call = call_to(s.port, "GET", "/slow");
  call.timeout = milliseconds(100);
  const auto answer = http_request(call);
  ASSERT_FALSE(answer);
  EXPECT_EQ(answer.error().code, ErrorCode::kRequestTimeout);
}

TEST(HttpClient, AnAnswerAboveTheClientsLimitIsNotReadToItsEnd) {
  const TestServer s;
  HttpCall call = call_to(s.port, "GET", "/large");
  call.max_answer_bytes = 1'000'000;
  const auto answer = http_request(call);
  ASSERT_FALSE(answer);
  EXPECT_EQ(answer.error().code, ErrorCode::kPayloadTooLarge);
}

}  // namespace
}  // namespace slipway::server
