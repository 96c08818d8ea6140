// Floods that stop a plain cpp-httplib server or fill its memory. Each prints what it measured.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <thread>
#include <vector>

#include "raw_client.h"

namespace slipway::server {
namespace {

using std::chrono::milliseconds;
using Clock = std::chrono::steady_clock;

constexpr std::string_view kJsonHead = "POST /echo HTTP/1.1\r\nHost: t\r\nContent-Type: application/json\r\n";
constexpr std::size_t kGrowthKib = 20 * 1024;

HttpOptions roomy() {
  HttpOptions options;
  options.max_connections_per_address = 512;
  return options;
}

// Milliseconds for a /healthz on a connection of its own, the worst of `times`.
double worst_healthz_ms(int port, int times) {
  double worst = 0.0;
  for (int i = 0; i < times; ++i) {
    const auto before = Clock::now();
    if (ask_once(port, get("/healthz")).status != 200) return 1e9;
    worst = std::max(worst, std::chrono::duration<double, std::milli>(Clock::now() - before).count());
  }
  return worst;
}

// Looks at the process's memory while a flood runs, for one that is freed again has been there all the same.
class Growth {
 public:
  Growth() : before_(resident_kib()), watcher_([this] { watch(); }) {}
  ~Growth() { finish(); }
  Growth(const Growth&) = delete;
  Growth& operator=(const Growth&) = delete;

  std::size_t finish() {
    done_ = true;
    if (watcher_.joinable()) watcher_.join();
    return peak_ > before_ ? peak_ - before_ : 0;
  }

 private:
  void watch() {
    while (!done_) {
      peak_ = std::max(peak_, resident_kib());
      std::this_thread::sleep_for(milliseconds(2));
    }
    peak_ = std::max(peak_, resident_kib());
  }

  std::size_t before_;
  std::size_t peak_ = 0;
  std::atomic<bool> done_ = false;
  std::thread watcher_;
};

void expect_calm(std::string_view flood, double worst_ms, std::size_t growth_kib) {
  fmt::print("{}: /healthz at worst {:.2f} ms, memory grew by {} KiB\n", flood, worst_ms, growth_kib);
  EXPECT_LT(worst_ms, kMeasuring ? 500.0 : 2'000.0);
  if (kMeasuring) {
    EXPECT_LT(growth_kib, kGrowthKib);
  }
}

TEST(HttpFlood, SlowSendersOfHeadsDelayNobody) {
  const TestServer s(roomy());
  Growth growth;
  std::vector<RawClient> slow;
  for (int i = 0; i < 200; ++i) {
    slow.emplace_back(s.port);
    slow.back().send("GET /healthz HTTP/1.1\r\nX: ");
  }
  double worst = 0.0;
  for (int round = 0; round < 10; ++round) {
    for (RawClient& client : slow) client.send("x");
    worst = std::max(worst, worst_healthz_ms(s.port, 10));
  }
  EXPECT_GE(s.server.counters().open_connections, 200U) << "they are all still there";
  expect_calm("200 slow heads", worst, growth.finish());
}

TEST(HttpFlood, SlowSendersOfBodiesDelayNobody) {
  const TestServer s(roomy());
  Growth growth;
  std::vector<RawClient> slow;
  for (int i = 0; i < 200; ++i) {
    slow.emplace_back(s.port);
    slow.back().send(std::string(kJsonHead) + "Content-Length: 100000\r\n\r\n");
  }
  double worst = 0.0;
  for (int round = 0; round < 10; ++round) {
    for (RawClient& client : slow) client.send("x");
    worst = std::max(worst, worst_healthz_ms(s.port, 10));
  }
  EXPECT_GE(s.server.counters().open_connections, 200U);
  expect_calm("200 slow bodies", worst, growth.finish());
}

TEST(HttpFlood, IdleKeptConnectionsDelayNobody) {
  const TestServer s(roomy());
  Growth growth;
  std::vector<RawClient> idle;
  for (int i = 0; i < 200; ++i) {
    idle.emplace_back(s.port);
    ASSERT_EQ(idle.back().ask(get("/healthz")).status, 200);
  }
  const double worst = worst_healthz_ms(s.port, 100);
  expect_calm("200 idle connections", worst, growth.finish());
}

TEST(HttpFlood, ClientsThatTakeNothingDelayNobodyAndTheirAnswersAreBounded) {
  HttpOptions options = roomy();
  options.max_buffered_bytes = std::size_t{4} << 20;
  options.worker_threads = 4;  // each makes one answer of a megabyte at a time, whoever waits for it
  const TestServer s(options);
  Growth growth;
  std::vector<RawClient> deaf;
  for (int i = 0; i < 64; ++i) {
    deaf.emplace_back(s.port);
    std::string many;
    for (int k = 0; k < 8; ++k) many += get("/megabyte");
    deaf.back().send(many);
  }
  const double worst = worst_healthz_ms(s.port, 50);
  // What the kernel holds in socket buffers is not the process's.
  expect_calm("64 clients that ask for 8 MiB and read nothing", worst, growth.finish());
}

TEST(HttpFlood, AChunkedBodyWithoutEndIsCutOff) {
  const TestServer s;
  Growth growth;
  RawClient client(s.port);
  client.send(std::string(kJsonHead) + "Transfer-Encoding: chunked\r\n\r\n");
  const std::string chunk = "10000\r\n" + std::string(0x10000, 'x') + "\r\n";
  std::size_t sent = 0;
  while (sent < (std::size_t{256} << 20) && client.send(chunk)) sent += chunk.size();
  EXPECT_LT(sent, std::size_t{64} << 20) << "the server stopped reading long before";
  expect_calm(fmt::format("256 MiB in chunks, cut off after {} MiB", sent >> 20),
              worst_healthz_ms(s.port, 20), growth.finish());
}

TEST(HttpFlood, HeadersWithoutEndAreCutOff) {
  const TestServer s;
  Growth growth;
  RawClient client(s.port);
  client.send("GET /healthz HTTP/1.1\r\nHost: t\r\n");
  std::string header = "X-Header: " + std::string(7'000, 'x') + "\r\n";
  std::size_t sent = 0;
  while (sent < (std::size_t{191} << 20) && client.send(header)) sent += header.size();
  EXPECT_LT(sent, std::size_t{64} << 20);
  expect_calm(fmt::format("191 MiB of headers, cut off after {} MiB", sent >> 20),
              worst_healthz_ms(s.port, 20), growth.finish());
}

TEST(HttpFlood, ACompressedBodyIsRefusedUnread) {
  const TestServer s;
  Growth growth;
  // What is inside does not matter: 204 kB that would expand to 200 MiB never reach a decoder.
  const std::string body(204'000, '\x1f');
  for (const char* encoding : {"gzip", "br", "deflate", "identity"}) {
    const auto answer = ask_once(
        s.port, std::string(kJsonHead) +
                    fmt::format("Content-Encoding: {}\r\nContent-Length: {}\r\n\r\n", encoding, body.size()) +
                    body);
    EXPECT_EQ(answer.status, 415) << encoding;
  }
  expect_calm("gzip bombs", worst_healthz_ms(s.port, 20), growth.finish());
}

TEST(HttpFlood, RangesAreIgnoredHoweverMany) {
  const TestServer s;
  Growth growth;
  std::string ranges = "Range: bytes=0-";
  for (int i = 0; i < 1'000; ++i) ranges += ",0-";
  for (int i = 0; i < 5; ++i) {
    const auto answer = ask_once(s.port, get("/megabyte", ranges + "\r\nAccept-Encoding: gzip, br\r\n"));
    EXPECT_EQ(answer.status, 200);
    EXPECT_EQ(answer.body.size(), std::size_t{1} << 20);
    EXPECT_EQ(answer.header("Content-Encoding"), "");
  }
  expect_calm("1,000 ranges", worst_healthz_ms(s.port, 20), growth.finish());
}

TEST(HttpFlood, ConnectionsOpenedAndClosedByTheThousandLeaveNothingBehind) {
  const TestServer s(roomy());
  Growth growth;
  RawClient kept(s.port);
  double worst = 0.0;
  for (int i = 0; i < (kMeasuring ? 3'000 : 600); ++i) {
    RawClient client(s.port);
    ASSERT_TRUE(client.connected()) << i;
    if (i % 3 == 0) client.send(get("/megabyte"));
    if (i % 3 == 1) client.send("GET /heal");
    if (i % 100 != 0) continue;
    const auto before = Clock::now();
    ASSERT_EQ(kept.ask(get("/healthz")).status, 200) << i;
    worst = std::max(worst, std::chrono::duration<double, std::milli>(Clock::now() - before).count());
  }
  for (int i = 0; i < 200 && s.server.counters().open_connections > 1; ++i) {
    std::this_thread::sleep_for(milliseconds(20));
  }
  EXPECT_EQ(s.server.counters().open_connections, 1U) << "only the one that is kept";
  expect_calm("thousands of connections that go away", worst, growth.finish());
}

}  // namespace
}  // namespace slipway::server
