#include "server/http/http_server.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <future>
#include <mutex>
#include <thread>
#include <vector>

#include "raw_client.h"

namespace slipway::server {
namespace {

using std::chrono::milliseconds;

TEST(HttpServer, ARouteAnswersWithItsBodyAndType) {
  const TestServer s;
  const auto answer = ask_once(s.port, get("/healthz"));
  EXPECT_EQ(answer.status, 200);
  EXPECT_EQ(answer.body, "well");
  EXPECT_EQ(answer.header("Content-Type"), "text/plain");
  EXPECT_EQ(answer.header("X-Content-Type-Options"), "nosniff");
  EXPECT_TRUE(answer.header("Date").ends_with(" GMT")) << answer.head;
}

TEST(HttpServer, ABodyComesBackAsItWasSent) {
  const TestServer s;
  const std::string body = std::string("{\"a\":1}\r\n\r\n\0x", 13);
  EXPECT_EQ(ask_once(s.port, post("/echo", body)).body, body);
}

TEST(HttpServer, AnUnknownAddressGetsA404ProblemWithItsInstance) {
  const TestServer s;
  const auto answer = ask_once(s.port, get("/nowhere?x=1"));
  EXPECT_EQ(answer.status, 404);
  EXPECT_EQ(answer.header("Content-Type"), "application/problem+json");
  EXPECT_NE(answer.body.find("\"type\":\"/errors#not_found\""), std::string::npos) << answer.body;
  EXPECT_NE(answer.body.find("\"instance\":\"/nowhere\""), std::string::npos) << answer.body;
}

TEST(HttpServer, AMethodThatIsNotAllowedGets405AndTheMethodsThatAre) {
  const TestServer s;
  RawClient client(s.port);
  const auto answer = client.ask(post("/jobs/7", "{}"));
  EXPECT_EQ(answer.status, 405);
  EXPECT_EQ(answer.header("Allow"), "DELETE, GET, HEAD, OPTIONS");
  EXPECT_EQ(client.ask(get("/healthz")).status, 200) << "the connection goes on: the request was whole";
}

TEST(HttpServer, OptionsIsAnsweredWithTheMethodsAllowedAndNoLength) {
  const TestServer s;
  RawClient client(s.port);
  client.send("OPTIONS /jobs/7 HTTP/1.1\r\nHost: t\r\n\r\n");
  const auto answer = client.read_answer();
  EXPECT_EQ(answer.status, 204);
  EXPECT_EQ(answer.header("Allow"), "DELETE, GET, HEAD, OPTIONS");
  EXPECT_EQ(answer.header("Content-Length"), "");
  EXPECT_EQ(ask_once(s.port, "OPTIONS * HTTP/1.1\r\nHost: t\r\n\r\n").header("Allow"),
            "DELETE, GET, HEAD, OPTIONS, POST");
}

// What /pieces/{count} sends.
std::string all_pieces(int count) {
  std::string all;
  for (int k = 0; k < count; ++k)
    all += std::string(k % 3 == 1 ? 0 : 100'000, static_cast<char>('a' + k % 26));
  return all;
}

TEST(HttpServer, ABodyInPiecesIsWholeAndTheConnectionGoesOn) {
  const TestServer s;
  RawClient client(s.port);
  for (const int count : {0, 1, 2, 60}) {
    const auto answer = client.ask(get("/pieces/" + std::to_string(count)));
    EXPECT_EQ(answer.status, 200) << count;
    EXPECT_EQ(answer.header("Transfer-Encoding"), "chunked");
    EXPECT_EQ(answer.header("Content-Length"), "");
    EXPECT_TRUE(answer.body == all_pieces(count)) << count;
  }
  const auto head = client.ask("HEAD /pieces/3 HTTP/1.1\r\nHost: t\r\n\r\n");
  EXPECT_EQ(head.status, 200);
  EXPECT_EQ(head.header("Content-Length"), "");
  EXPECT_EQ(client.ask(get("/healthz")).body, "well");
}

TEST(HttpServer, ABodyInPiecesOfKnownLengthNeedsNoChunks) {
  const TestServer s;
  RawClient client(s.port);
  for (const char* method : {"GET", "HEAD"}) {
    const auto answer = client.ask(std::string(method) + " /counted HTTP/1.1\r\nHost: t\r\n\r\n");
    EXPECT_EQ(answer.status, 200);
    EXPECT_EQ(answer.header("Transfer-Encoding"), "");
    EXPECT_EQ(answer.header("Content-Length"), "300000");
    EXPECT_EQ(answer.header("Accept-Ranges"), "bytes");
    EXPECT_EQ(answer.body.size(), std::string_view(method) == "GET" ? 300'000U : 0U);
  }
  EXPECT_EQ(client.ask("HEAD /megabyte HTTP/1.1\r\nHost: t\r\n\r\n").header("Accept-Ranges"), "");
}

TEST(HttpServer, AHandlerSeesTheRangeThatIsAskedFor) {
  const TestServer s;
  EXPECT_EQ(ask_once(s.port, get("/header/Range", "Range: bytes=1-2\r\n")).body, "bytes=1-2");
  EXPECT_EQ(ask_once(s.port, get("/header/If-Range", "If-Range: \"a\"\r\n")).body, "\"a\"");
}

TEST(HttpServer, AClientOfHttp10GetsThePiecesWithoutChunks) {
  const TestServer s;
  RawClient client(s.port);
  client.send("GET /pieces/3 HTTP/1.0\r\n\r\n");
  const auto answer = client.read_answer(true);
  EXPECT_EQ(answer.status, 200);
  EXPECT_EQ(answer.header("Transfer-Encoding"), "");
  EXPECT_TRUE(client.read_rest() == all_pieces(3));
}

TEST(HttpServer, ABodyThatBreaksOffIsNeverTakenForWhole) {
  const TestServer s;
  RawClient client(s.port);
  EXPECT_EQ(client.ask(get("/pieces/2000")).status, 0);
  EXPECT_TRUE(client.closed_within(milliseconds(1000)));
}

TEST(HttpServer, SlowReadersOfALongBodyHoldLittleMemoryAndNoThread) {
  const TestServer s;
  std::vector<RawClient> readers;
  const std::size_t before = resident_kib();
  for (int k = 0; k < 32; ++k) {
    readers.emplace_back(s.port);
    readers.back().send(get("/pieces/900"));  // 60 MB, of which nobody reads any
  }
  std::this_thread::sleep_for(milliseconds(300));
  EXPECT_TRUE(ask_once(s.port, get("/pieces/9")).body == all_pieces(9)) << "its threads are free for others";
  if (kMeasuring) {
    EXPECT_LT(resident_kib() - before, 40'000U);
  }
}

TEST(HttpServer, HeadHasTheLengthOfGetAndNoBody) {
  const TestServer s;
  RawClient client(s.port);
  const auto answer = client.ask("HEAD /healthz HTTP/1.1\r\nHost: t\r\n\r\n");
  EXPECT_EQ(answer.status, 200);
  EXPECT_EQ(answer.header("Content-Length"), "4");
  EXPECT_EQ(answer.header("Accept-Ranges"), "");
  EXPECT_EQ(client.ask(get("/healthz")).body, "well") << "a body would have stood before this answer";
}

TEST(HttpServer, AnExceptionBecomesA500WithoutItsText) {
  std::mutex mutex;
  std::string log;
  HttpOptions options;
  options.log = [&](std::string_view line) {
    const std::lock_guard lock(mutex);
    log += line;
  };
  const TestServer s(options);
  RawClient client(s.port);
  const auto answer = client.ask(get("/throws"));
  EXPECT_EQ(answer.status, 500);
  EXPECT_EQ((answer.head + answer.body).find("swordfish"), std::string::npos) << answer.head << answer.body;
  EXPECT_NE(answer.body.find("/errors#internal"), std::string::npos);
  EXPECT_EQ(client.ask(get("/throws_int")).status, 500);
  EXPECT_EQ(client.ask(get("/healthz")).status, 200);
  const std::lock_guard lock(mutex);
  EXPECT_NE(log.find("swordfish"), std::string::npos) << "the operator reads it in the log";
}

TEST(HttpServer, AProblemFunctionThatThrowsStillLeavesAProblemDocument) {
  HttpOptions options;
  options.problem = [](const Error&, const HttpRequest*) -> HttpResponse { throw std::runtime_error("no"); };
  const TestServer s(options);
  const auto answer = ask_once(s.port, get("/nowhere"));
  EXPECT_EQ(answer.status, 404);
  EXPECT_EQ(answer.body, R"({"type":"/errors#not_found","title":"not_found","status":404})");
  EXPECT_EQ(ask_once(s.port, "nonsense\r\n\r\n").status, 400);
}

TEST(HttpServer, AnErrorBodyOfAHandlerIsSentAsItIs) {
  const TestServer s;
  const auto answer = ask_once(s.port, get("/refuses"));
  EXPECT_EQ(answer.status, 422);
  EXPECT_NE(answer.body.find("off the map by 3 m"), std::string::npos) << answer.body;
}

TEST(HttpServer, AHandlersHeadersCanNeitherSplitTheAnswerNorChangeItsFraming) {
  const TestServer s;
  const auto answer = ask_once(s.port, get("/splits"));
  EXPECT_EQ(answer.body, "ok");
  EXPECT_EQ(answer.header("X-Injected"), "");
  EXPECT_EQ(answer.header("X-Good"), "1");
  EXPECT_EQ(answer.header("Content-Length"), "2");
}

TEST(HttpServer, QueriesKeepOrderAndRepetitionAndAreDecoded) {
  const TestServer s;
  EXPECT_EQ(ask_once(s.port, get("/query?b=1&a=x+y&b=1&c&d=%C3%A9&e=f=g&&h=?i?")).body,
            "b=1;a=x y;b=1;c=;d=\xc3\xa9;e=f=g;h=?i?;");
}

TEST(HttpServer, AnEncodedSlashIsPartOfASegment) {
  const TestServer s;
  EXPECT_EQ(ask_once(s.port, get("/jobs/a%2Fb")).body, "job a/b");
  EXPECT_EQ(ask_once(s.port, get("/jobs/a/b")).status, 404);
}

TEST(HttpServer, ThePeersAddressCannotBeSpoofedByAHeader) {
  const TestServer s;
  EXPECT_EQ(ask_once(s.port, get("/peer", "REMOTE_ADDR: 1.2.3.4\r\nRemote_Addr: 5.6.7.8\r\n")).body,
            "127.0.0.1|none");
}

TEST(HttpServer, HeadersReachTheHandlerWithoutRegardToCase) {
  const TestServer s;
  EXPECT_EQ(ask_once(s.port, get("/header/x-one", "X-ONE:  a b \r\n")).body, "a b");
}

TEST(HttpServer, AConnectionIsKeptUntilTheClientWantsItClosed) {
  const TestServer s;
  RawClient client(s.port);
  for (int i = 0; i < 20; ++i) ASSERT_EQ(client.ask(get("/healthz")).status, 200) << i;
  const auto last = client.ask(get("/healthz", "Connection: keep-alive, Close\r\n"));
  EXPECT_EQ(last.header("Connection"), "close");
  EXPECT_TRUE(client.closed_within(milliseconds(500)));
}

TEST(HttpServer, AConnectionEndsAfterItsLastRequestAllowed) {
  HttpOptions options;
  options.max_requests_per_connection = 3;
  const TestServer s(options);
  RawClient client(s.port);
  EXPECT_EQ(client.ask(get("/healthz")).header("Connection"), "");
  EXPECT_EQ(client.ask(get("/healthz")).header("Connection"), "");
  EXPECT_EQ(client.ask(get("/healthz")).header("Connection"), "close");
  EXPECT_TRUE(client.closed_within(milliseconds(500)));
}

TEST(HttpServer, PipelinedRequestsAreAnsweredInOrder) {
  const TestServer s;
  RawClient client(s.port);
  std::string all;
  for (int i = 0; i < 300; ++i)
    all += i % 3 == 0 ? post("/echo", std::to_string(i)) : get("/jobs/" + std::to_string(i));
  auto sending = std::async(std::launch::async, [&] { return client.send(all); });
  for (int i = 0; i < 300; ++i) {
    const auto answer = client.read_answer();
    ASSERT_EQ(answer.status, 200) << i;
    ASSERT_EQ(answer.body, (i % 3 == 0 ? "" : "job ") + std::to_string(i));
  }
  EXPECT_TRUE(sending.get());
}

TEST(HttpServer, Http10IsAnsweredAndClosed) {
  const TestServer s;
  RawClient client(s.port);
  const auto answer = client.ask("GET /healthz HTTP/1.0\r\nConnection: keep-alive\r\n\r\n");
  EXPECT_EQ(answer.body, "well");
  EXPECT_EQ(answer.header("Connection"), "close");
  EXPECT_TRUE(client.closed_within(milliseconds(500)));
}

TEST(HttpServer, AClientThatHasFinishedSendingStillGetsItsAnswer) {
  const TestServer s;
  RawClient client(s.port);
  client.send(get("/slow"));
  client.finish_sending();
  EXPECT_EQ(client.read_answer().body, "at last");
  EXPECT_TRUE(client.closed_within(milliseconds(500)));
}

TEST(HttpServer, AChunkedBodyArrivesWhole) {
  const TestServer s;
  RawClient client(s.port);
  client.send(
      "POST /echo HTTP/1.1\r\nHost: t\r\nContent-Type: application/json\r\nTransfer-Encoding: "
      "chunked\r\n\r\n");
  client.send("3\r\nabc\r\n");
  client.send("A;ext=1\r\n0123456789\r\n0\r\nTrailer: x\r\n\r\n");
  EXPECT_EQ(client.read_answer().body, "abc0123456789");
  EXPECT_EQ(client.ask(get("/healthz")).body, "well");
}

TEST(HttpServer, ALargeAnswerArrivesWholeAtASlowReader) {
  const TestServer s;
  RawClient client(s.port);
  client.send(get("/large"));
  std::this_thread::sleep_for(milliseconds(200));
  const auto answer = client.read_answer();
  EXPECT_EQ(answer.body.size(), std::size_t{8} << 20);
  EXPECT_EQ(client.ask(get("/healthz")).body, "well");
}

TEST(HttpServer, APortThatIsTakenIsAnErrorThatSaysSo) {
  const TestServer s;
  HttpOptions options;
  options.port = s.port;
  HttpServer second(options, {});
  const auto started = second.start();
  ASSERT_FALSE(started);
  EXPECT_NE(started.error().detail.find("Address already in use"), std::string::npos)
      << started.error().detail;
  EXPECT_NE(started.error().detail.find(std::to_string(s.port)), std::string::npos) << started.error().detail;
}

TEST(HttpServer, AnAddressOfAnotherMachineIsAnError) {
  HttpOptions options;
  options.address = "192.0.2.1";
  EXPECT_FALSE(HttpServer(options, {}).start());
  options.address = "127.0.0.1";
  options.port = 70'000;
  EXPECT_FALSE(HttpServer(options, {}).start());
}

TEST(HttpServer, StoppingLetsARequestFinishAndFreesThePort) {
  HttpOptions options;
  auto s = std::make_unique<TestServer>(options);
  RawClient busy(s->port);
  const RawClient idle(s->port);
  busy.send(get("/slow"));
  std::this_thread::sleep_for(milliseconds(100));
  const auto before = std::chrono::steady_clock::now();
  s->server.stop();
  const auto took = std::chrono::steady_clock::now() - before;
  EXPECT_LT(took, milliseconds(2'000)) << "the idle connection does not hold it up";
  EXPECT_EQ(busy.read_answer().body, "at last");
  EXPECT_TRUE(busy.closed_within(milliseconds(500)));
  EXPECT_EQ(s->server.counters().open_connections, 0U);
  options.port = s->port;
  s.reset();
  const TestServer again(options);
  EXPECT_EQ(ask_once(again.port, get("/healthz")).status, 200);
}

TEST(HttpServer, AStoppedServerCanBeStartedAgain) {
  TestServer s;
  EXPECT_FALSE(s.server.start()) << "it is running";
  s.server.stop();
  s.server.stop();
  const auto port = s.server.start();
  ASSERT_TRUE(port);
  EXPECT_EQ(ask_once(*port, get("/healthz")).status, 200);
}

TEST(HttpServer, CountersCountWhatHappened) {
  const TestServer s;
  RawClient client(s.port);
  client.ask(get("/healthz"));
  client.ask(get("/nowhere"));
  ask_once(s.port, "nonsense\r\n\r\n");
  const HttpCounters counters = s.server.counters();
  EXPECT_EQ(counters.requests_served, 2U);
  EXPECT_EQ(counters.requests_refused, 1U);
  EXPECT_GE(counters.open_connections, 1U);
}

// Eight requests for a slow route are under way `at_once`, and nobody on a route of `others` waits behind
// them.
void expect_at_once(int at_once, Threads slow, Threads others) {
  std::atomic<int> now{0}, most{0};
  std::atomic<bool> held{true};
  const HttpResponse none{204, "", "", {}};
  HttpOptions options;
  options.worker_threads = 2;
  options.heavy_threads = 2;
  HttpServer server(options, {{"GET", "/other", [&](const HttpRequest&) { return none; }, others},
                              {"GET", "/slow/{k}",
                               [&](const HttpRequest&) {
                                 most = std::max(most.load(), ++now);
                                 while (held) std::this_thread::sleep_for(milliseconds(1));
                                 --now;
                                 return none;
                               },
                               slow}});
  const auto port = server.start();
  ASSERT_TRUE(port);
  std::vector<std::unique_ptr<RawClient>> clients;
  for (int k = 0; k < 8; ++k) {
    clients.push_back(std::make_unique<RawClient>(*port));
    clients.back()->send(get("/slow/1?k=2"));
  }
  while (now < at_once) std::this_thread::sleep_for(milliseconds(1));
  for (int k = 0; k < 20; ++k) EXPECT_EQ(ask_once(*port, get("/other")).status, 204);
  held = false;
  for (const auto& client : clients) EXPECT_EQ(client->read_answer().status, 204);
  EXPECT_EQ(most, at_once);
}

TEST(HttpServer, HeavyRoutesAreAnsweredAFewAtATimeAndNobodyWaitsBehindThem) {
  expect_at_once(2, Threads::kHeavy, Threads::kLight);
}

TEST(HttpServer, DrawnAnswersAreMadeOneAtATimeAndNoPictureWaitsBehindThem) {
  expect_at_once(1, Threads::kDrawn, Threads::kHeavy);
}

// One client leaves more requests than there are threads and goes; another one waits for a single request.
TEST(HttpServer, ForThoseWhoHaveLeftNothingIsDoneAndTurnsAreTakenOneAfterTheOther) {
  std::mutex mutex;
  std::vector<std::string> done;
  std::atomic<bool> held{true}, begun{false};
  const HttpResponse none{204, "", "", {}};
  HttpOptions options;
  options.name_of = [](std::string_view, std::string_view, const std::optional<std::string>& authorization) {
    return authorization.value_or("");
  };
  const auto handle = [&](const HttpRequest& request) {
    begun = true;
    while (held) std::this_thread::sleep_for(milliseconds(1));
    const std::lock_guard lock(mutex);
    done.emplace_back(request.parameter("k"));
    return none;
  };
  HttpServer server(options,
                    {{"GET", "/shadow/{k}", handle, Threads::kShadow},
                     {"DELETE", "/shadow/{k}", handle, Threads::kShadow},
                     {"GET", "/picture", [&](const HttpRequest&) { return none; }, Threads::kPicture},
                     {"GET", "/document", [&](const HttpRequest&) { return none; }, Threads::kHeavy}});
  const auto port = server.start();
  ASSERT_TRUE(port);
  std::vector<std::unique_ptr<RawClient>> clients;
  const auto ask = [&](const std::string& request) {
    clients.push_back(std::make_unique<RawClient>(*port));
    clients.back()->send(request);
    // Each request waits before the next one comes: what is sent later is not read earlier.
    EXPECT_EQ(ask_once(*port, get("/picture")).status, 204);
  };
  for (const char* const k : {"0", "1", "2", "3"})
    ask(get(std::string("/shadow/") + k, "Authorization: many\r\n"));
  ask(get("/shadow/other", "Authorization: one\r\n"));
  while (!begun) std::this_thread::sleep_for(milliseconds(1));
  for (int k = 0; k < 4; ++k) {
    ask(get("/shadow/left"));
    clients.pop_back();
  }
  ask("DELETE /shadow/told HTTP/1.1\r\nHost: a\r\n\r\n");
  clients.pop_back();
  EXPECT_EQ(ask_once(*port, get("/picture")).status, 204);
  EXPECT_EQ(ask_once(*port, get("/document")).status, 204);
  std::this_thread::sleep_for(milliseconds(1100));
  held = false;
  for (const auto& client : clients) EXPECT_EQ(client->read_answer().status, 204);
  server.stop();
  EXPECT_EQ(done, (std::vector<std::string>{"0", "1", "other", "2", "3", "told"}));
  EXPECT_EQ(server.counters().requests_abandoned, 4U);
}

TEST(HttpServer, APromptRouteWaitsForNoOther) {
  std::atomic<int> waiting{0};
  std::atomic<bool> held{true};
  HttpOptions options;
  options.worker_threads = 2;
  const auto none = HttpResponse{204, "", "", {}};
  HttpServer server(options, {{.method = "GET",
                               .pattern = "/healthz",
                               .handle = [none](const HttpRequest&) { return none; },
                               .threads = Threads::kPrompt},
                              {"GET", "/poll", [&, none](const HttpRequest&) {
                                 ++waiting;
                                 while (held) std::this_thread::sleep_for(milliseconds(1));
                                 return none;
                               }}});
  const auto port = server.start();
  ASSERT_TRUE(port);
  std::vector<std::unique_ptr<RawClient>> clients;
  for (int k = 0; k < 32; ++k) {
    clients.push_back(std::make_unique<RawClient>(*port));
    clients.back()->send(get("/poll"));
  }
  while (waiting < 2) std::this_thread::sleep_for(milliseconds(1));
  for (int k = 0; k < 20; ++k) EXPECT_EQ(ask_once(*port, get("/healthz")).status, 204);
  EXPECT_EQ(waiting, 2) << "all threads of the others are taken";
  held = false;
  for (const auto& client : clients) EXPECT_EQ(client->read_answer().status, 204);
}

TEST(HttpServer, RoutesThatCannotBeToldApartAreRefusedAtOnce) {
  const auto handle = [](const HttpRequest&) { return HttpResponse{}; };
  EXPECT_THROW(HttpServer({}, {{"GET", "/a/{x}", handle}, {"GET", "/a/{y}", handle}}), std::invalid_argument);
}

}  // namespace
}  // namespace slipway::server
