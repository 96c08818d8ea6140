// What the server refuses, and how: over real sockets.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <chrono>
#include <thread>
#include <vector>

#include "raw_client.h"

namespace slipway::server {
namespace {

using std::chrono::milliseconds;
using Clock = std::chrono::steady_clock;

constexpr std::string_view kJsonHead = "POST /echo HTTP/1.1\r\nHost: t\r\nContent-Type: application/json\r\n";

HttpOptions quick() {
  HttpOptions options;
  options.header_deadline = milliseconds(200);
  options.body_deadline = milliseconds(300);
  options.idle_deadline = milliseconds(400);
  options.write_deadline = milliseconds(400);
  options.linger_deadline = milliseconds(200);
  return options;
}

TEST(HttpLimits, EveryRefusalIsAProblemDocumentAndEndsTheConnection) {
  struct Case {
    std::string request;
    int status;
  };
  const std::vector<Case> cases{
      {"nonsense\r\n\r\n", 400},
      {std::string("\x16\x03\x01\x02\x00\x01", 6), 400},
      {"GET /healthz HTTP/1.1\n\n", 400},
      {std::string(kJsonHead) + "Content-Length: 2\r\nTransfer-Encoding: chunked\r\n\r\n{}", 400},
      {std::string(kJsonHead) + "Content-Length: 2\r\nContent-Length: 2\r\n\r\n{}", 400},
      {std::string(kJsonHead) + "Content-Length: two\r\n\r\n{}", 400},
      {std::string(kJsonHead) + "Transfer-Encoding: chunked\r\n\r\nxyz\r\n", 400},
      {std::string(kJsonHead) + "Content-Length: 5000000\r\n\r\n", 413},
      {std::string(kJsonHead) + "Transfer-Encoding: chunked\r\n\r\n5000000\r\n", 413},
      {std::string(kJsonHead) + "Content-Encoding: gzip\r\nContent-Length: 2\r\n\r\n{}", 415},
      {"POST /echo HTTP/1.1\r\nHost: t\r\nContent-Type: application/x-www-form-urlencoded\r\n"
       "Content-Length: 3\r\n\r\na=b",
       415},
      {"POST /echo HTTP/1.1\r\nHost: t\r\nContent-Length: 2\r\n\r\n{}", 415},
      {get("/" + std::string(9'000, 'x')), 431},
      {get("/healthz", "X: " + std::string(20'000, 'x') + "\r\n"), 431},
      {"BREW /pot HTTP/1.1\r\nHost: t\r\n\r\n", 405},
  };
  const TestServer s(quick());
  for (const Case& c : cases) {
    RawClient client(s.port);
    const auto answer = client.ask(c.request);
    const std::string shown = c.request.substr(0, 120);
    EXPECT_EQ(answer.status, c.status) << shown;
    EXPECT_EQ(answer.header("Content-Type"), "application/problem+json") << shown;
    EXPECT_EQ(answer.header("Connection"), "close") << shown;
    EXPECT_NE(answer.body.find(fmt::format("\"status\":{}", c.status)), std::string::npos) << answer.body;
    EXPECT_TRUE(client.closed_within(milliseconds(1'000))) << shown;
  }
  EXPECT_EQ(s.server.counters().requests_refused, cases.size());
}

TEST(HttpLimits, ARequestHiddenBehindARefusedOneIsNeverAnswered) {
  const TestServer s(quick());
  RawClient client(s.port);
  client.send(std::string(kJsonHead) + "Content-Length: 2\r\nTransfer-Encoding: chunked\r\n\r\n0\r\n\r\n" +
              get("/jobs/smuggled"));
  EXPECT_EQ(client.read_answer().status, 400);
  EXPECT_EQ(client.read_answer(false, milliseconds(500)).status, 0);
}

TEST(HttpLimits, ContinueIsSentBeforeTheBodyAndNotWhenTheBodyIsRefused) {
  const TestServer s(quick());
  RawClient client(s.port);
  client.send(std::string(kJsonHead) + "Content-Length: 2\r\nExpect: 100-continue\r\n\r\n");
  EXPECT_EQ(client.read_answer().status, 100);
  client.send("{}");
  EXPECT_EQ(client.read_answer().body, "{}");
  client.send(std::string(kJsonHead) + "Content-Length: 9000000\r\nExpect: 100-continue\r\n\r\n");
  EXPECT_EQ(client.read_answer().status, 413);
}

TEST(HttpLimits, ABodyThatNobodyWantsIsNotWaitedFor) {
  HttpOptions options;
  options.wants_body = [](std::string_view method, std::string_view path,
                          const std::optional<std::string>& authorization) {
    return method != "POST" || path != "/echo" || authorization == "Bearer good";
  };
  options.admit = [](HttpRequest& request) -> std::optional<HttpResponse> {
    if (request.header("Authorization") == "Bearer good") return std::nullopt;
    return test_problem({ErrorCode::kUnauthorized, "a token is needed", {}}, &request);
  };
  const TestServer s(options);
  const std::string head =
      "POST /echo HTTP/1.1\r\nHost: t\r\nContent-Type: application/json\r\nContent-Length: 1000000\r\n";
  for (const std::string& rest :
       {std::string("\r\n"), std::string("\r\nGET /healthz HTTP/1.1\r\nHost: t\r\n\r\n"),
        std::string("Expect: 100-continue\r\n\r\n"), std::string("Authorization: Bearer bad\r\n\r\n{")}) {
    RawClient client(s.port);
    client.send(head + rest);
    EXPECT_EQ(client.read_answer().status, 401) << rest;
    EXPECT_EQ(client.read_answer().status, 0) << "the body is no request";
  }
  EXPECT_EQ(ask_once(s.port, post("/echo", "{}", "Authorization: Bearer good\r\n")).body, "{}");
}

TEST(HttpLimits, AHeadThatIsNotThereInTimeGets408) {
  const TestServer s(quick());
  RawClient client(s.port);
  const auto before = Clock::now();
  bool open = true;
  for (int i = 0; i < 100 && open && Clock::now() - before < milliseconds(190); ++i) {
    open = client.send(i == 0 ? "GET /healthz HTTP/1.1\r\nX: " : "x");
    std::this_thread::sleep_for(milliseconds(20));
  }
  const auto answer = client.read_answer();
  EXPECT_EQ(answer.status, 408) << "bytes that drip in do not extend the deadline";
  EXPECT_NE(answer.body.find("/errors#request_timeout"), std::string::npos);
  EXPECT_LT(Clock::now() - before, milliseconds(1'500));
}

TEST(HttpLimits, ABodyThatIsNotThereInTimeGets408) {
  const TestServer s(quick());
  RawClient client(s.port);
  client.send(std::string(kJsonHead) + "Content-Length: 10\r\n\r\n{");
  EXPECT_EQ(client.read_answer().status, 408);
  EXPECT_TRUE(client.closed_within(milliseconds(1'000)));
}

TEST(HttpLimits, ABodyThatComesSteadilyIsWaitedForAndOneThatDripsIsNot) {
  HttpOptions options = quick();
  options.min_bytes_per_s = 10'000;
  const TestServer s(options);
  RawClient steady(s.port);
  const std::string body = '"' + std::string(9'998, 'x') + '"';
  steady.send(std::string(kJsonHead) + "Content-Length: 10000\r\n\r\n");
  for (std::size_t sent = 0; sent < body.size(); sent += 1'000) {
    steady.send(body.substr(sent, 1'000));
    std::this_thread::sleep_for(milliseconds(50));  // 0.5 s in all
  }
  EXPECT_EQ(steady.read_answer().status, 200);
  RawClient dripping(s.port);
  dripping.send(std::string(kJsonHead) + "Content-Length: 10000\r\n\r\n");
  const auto begun = Clock::now();
  bool open = true;
  while (open && Clock::now() - begun < milliseconds(5'000)) {
    dripping.send("x");
    open = dripping.read_answer(false, milliseconds(20)).status != 408;
  }
  EXPECT_FALSE(open);
  EXPECT_LT(Clock::now() - begun, milliseconds(1'000));
}

TEST(HttpLimits, ConnectionsThatSayNothingAreClosedWithoutAWord) {
  const TestServer s(quick());
  RawClient silent(s.port);
  RawClient kept(s.port);
  EXPECT_EQ(kept.ask(get("/healthz")).status, 200);
  EXPECT_EQ(silent.read_answer(false, milliseconds(1'500)).status, 0);
  EXPECT_TRUE(silent.closed_within(milliseconds(500)));
  EXPECT_TRUE(kept.closed_within(milliseconds(1'500)));
}

TEST(HttpLimits, AnIdleConnectionOutlivesTheDeadlineOfAHead) {
  HttpOptions options = quick();
  options.idle_deadline = milliseconds(5'000);
  const TestServer s(options);
  RawClient client(s.port);
  EXPECT_EQ(client.ask(get("/healthz")).status, 200);
  std::this_thread::sleep_for(milliseconds(400));
  EXPECT_EQ(client.ask(get("/healthz")).status, 200);
}

TEST(HttpLimits, AHandlerMayTakeLongerThanAnyDeadlineOfTheClient) {
  const TestServer s(quick());
  EXPECT_EQ(ask_once(s.port, get("/slow")).body, "at last");
}

TEST(HttpLimits, AClientThatDoesNotTakeItsAnswerIsClosed) {
  const TestServer s(quick());
  RawClient client(s.port);
  client.send(get("/large"));
  std::this_thread::sleep_for(milliseconds(900));
  EXPECT_EQ(s.server.counters().open_connections, 0U);
}

TEST(HttpLimits, AnAnswerThatIsTakenSteadilyIsSentToItsEnd) {
  const TestServer s(quick());  // its deadline is 400 ms
  RawClient client(s.port);
  client.send(get("/large"));
  std::size_t taken = 0;
  const auto begun = Clock::now();
  for (std::string some = client.read_some(); !some.empty(); some = client.read_some(milliseconds(200))) {
    taken += some.size();
    std::this_thread::sleep_for(milliseconds(8));
  }
  EXPECT_GT(taken, std::size_t{8} << 20);
  EXPECT_GT(Clock::now() - begun, milliseconds(1'000)) << "it must take longer than the deadline";
}

TEST(HttpLimits, AnAnswerForWhichThereIsNoRoomIsRefusedBeforeItsHead) {
  HttpOptions options;
  options.max_buffered_bytes = std::size_t{10} << 20;
  const TestServer s(options);
  RawClient slow(s.port);
  slow.send(get("/large"));
  std::this_thread::sleep_for(milliseconds(300));
  EXPECT_EQ(ask_once(s.port, get("/large")).status, 503);
  EXPECT_EQ(ask_once(s.port, get("/pieces/100")).status, 200) << "there is room for a piece";
  EXPECT_EQ(ask_once(s.port, get("/healthz")).status, 200);
}

TEST(HttpLimits, ConnectionsOverTheCapOfTheirAddressGet503AndTheOthersGoOn) {
  HttpOptions options = quick();
  options.idle_deadline = milliseconds(5'000);
  options.max_connections_per_address = 4;
  const TestServer s(options);
  std::vector<RawClient> kept;
  for (int i = 0; i < 4; ++i) {
    kept.emplace_back(s.port);
    ASSERT_EQ(kept.back().ask(get("/healthz")).status, 200);
  }
  RawClient fifth(s.port);
  const auto answer = fifth.ask(get("/healthz"));
  EXPECT_EQ(answer.status, 503);
  EXPECT_EQ(answer.header("Retry-After"), "1");
  EXPECT_EQ(answer.header("Content-Type"), "application/problem+json");
  EXPECT_EQ(s.server.counters().connections_refused, 1U);
  for (RawClient& client : kept) EXPECT_EQ(client.ask(get("/healthz")).status, 200);
  kept.clear();
  std::this_thread::sleep_for(milliseconds(100));
  EXPECT_EQ(ask_once(s.port, get("/healthz")).status, 200) << "room is made when connections end";
}

TEST(HttpLimits, TheCapOverAllHoldsAgainstABurst) {
  HttpOptions options = quick();
  options.max_connections = 10;
  const TestServer s(options);
  std::vector<RawClient> burst;
  for (int i = 0; i < 200; ++i) burst.emplace_back(s.port);
  std::this_thread::sleep_for(milliseconds(100));
  EXPECT_LE(s.server.counters().open_connections, 10U);
  EXPECT_EQ(s.server.counters().connections_refused, 190U);
}

TEST(HttpLimits, LargeBodiesTogetherAreLimitedAndSmallOnesStillPass) {
  HttpOptions options;
  options.max_buffered_bytes = std::size_t{1} << 20;
  const TestServer s(options);
  std::vector<RawClient> greedy;
  for (int i = 0; i < 8; ++i) {
    greedy.emplace_back(s.port);
    greedy.back().send(std::string(kJsonHead) + "Content-Length: 400000\r\n\r\n" + std::string(300'000, ' '));
  }
  std::this_thread::sleep_for(milliseconds(300));
  EXPECT_EQ(ask_once(s.port, post("/echo", "{}")).body, "{}");
  int refused = 0;
  for (RawClient& client : greedy)
    refused += client.read_answer(false, milliseconds(50)).status == 503 ? 1 : 0;
  EXPECT_EQ(refused, 5) << "three times 300 kB are below 1 MiB";
}

}  // namespace
}  // namespace slipway::server
