#include "server/http/http_cross_origin.h"

#include <gtest/gtest.h>

#include "raw_client.h"

namespace slipway::server {
namespace {

constexpr const char* kPage = "https://ops.example.org:8443";

HttpOptions sharing_with(std::vector<std::string> origins) {
  HttpOptions options;
  options.cross_origin = {.origins = std::move(origins),
                          .request_headers = {"Content-Type", "Prefer"},
                          .response_headers = {"Location", "ETag"}};
  return options;
}

std::string from(const std::string& origin, const std::string& line, const std::string& more = "") {
  return line + " HTTP/1.1\r\nHost: t\r\nOrigin: " + origin + "\r\n" + more + "\r\n";
}

TEST(CrossOrigin, WithoutAListNoAnswerSaysAnythingOfOrigins) {
  const TestServer s;
  const auto answer = ask_once(s.port, from(kPage, "GET /healthz"));
  EXPECT_EQ(answer.status, 200);
  EXPECT_EQ(answer.header("Access-Control-Allow-Origin"), "");
  EXPECT_EQ(answer.header("Vary"), "");
}

TEST(CrossOrigin, APageOfAnOriginInTheListMayReadAnswersAndRefusals) {
  const TestServer s(sharing_with({"http://localhost:5173", kPage}));
  RawClient client(s.port);
  for (const char* path : {"/healthz", "/nowhere", "/throws"}) {
    const auto answer = client.ask(from(kPage, std::string("GET ") + path));
    EXPECT_EQ(answer.header("Access-Control-Allow-Origin"), kPage) << path;
    EXPECT_EQ(answer.header("Vary"), "Origin") << path;
  }
  EXPECT_EQ(client.ask(from(kPage, "GET /healthz")).header("Access-Control-Expose-Headers"),
            "Location, ETag");
}

TEST(CrossOrigin, AnotherOriginIsAnsweredWithoutLeaveToRead) {
  const TestServer s(sharing_with({kPage}));
  RawClient client(s.port);
  for (const char* origin : {"https://ops.example.org", "https://ops.example.org:8443.evil.org", "null",
                             "HTTPS://OPS.EXAMPLE.ORG:8443", "*"}) {
    const auto answer = client.ask(from(origin, "GET /healthz"));
    EXPECT_EQ(answer.status, 200);
    EXPECT_EQ(answer.header("Access-Control-Allow-Origin"), "") << origin;
    EXPECT_EQ(answer.header("Vary"), "Origin") << "a cache must not give this answer to the page in the list";
  }
  EXPECT_EQ(client.ask(get("/healthz")).header("Vary"), "Origin");
}

TEST(CrossOrigin, APreflightNamesMethodsAndHeaders) {
  const TestServer s(sharing_with({kPage}));
  RawClient client(s.port);
  const std::string wish =
      "Access-Control-Request-Method: DELETE\r\nAccess-Control-Request-Headers: prefer\r\n";
  client.send(from(kPage, "OPTIONS /jobs/7", wish));
  const auto answer = client.read_answer();
  EXPECT_EQ(answer.status, 204);
  EXPECT_EQ(answer.header("Access-Control-Allow-Origin"), kPage);
  EXPECT_EQ(answer.header("Access-Control-Allow-Methods"), "DELETE, GET, HEAD, OPTIONS");
  EXPECT_EQ(answer.header("Access-Control-Allow-Headers"), "Content-Type, Prefer");
  EXPECT_EQ(answer.header("Access-Control-Max-Age"), "600");
  EXPECT_EQ(answer.header("Vary"), "Origin, Access-Control-Request-Method, Access-Control-Request-Headers");
  client.send(from("https://elsewhere.org", "OPTIONS /jobs/7", wish));
  EXPECT_EQ(client.read_answer().header("Access-Control-Allow-Methods"), "");
}

TEST(CrossOrigin, AnOriginIsASchemeAHostAndAPort) {
  for (const char* good : {"http://localhost:5173", "https://ops.example.org", "http://127.0.0.1:8080",
                           "http://[::1]:8080", "https://[2001:db8::1]"})
    EXPECT_EQ(fault_of_origin(good), std::nullopt) << good;
  for (const char* bad : {"", "*", "null", "localhost:5173", "ftp://host", "http://", "http://host/",
                          "http://host/path", "http://Host", "http://user@host", "http://host:",
                          "http://host:0", "http://host:65536", "http://host:x", "http://host:80",
                          "https://host:443", "http://host:08080", "http://[::1", "http://a b"})
    EXPECT_TRUE(fault_of_origin(bad)) << bad;
}

}  // namespace
}  // namespace slipway::server
