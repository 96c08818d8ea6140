// Thousands of requests that are nearly right, over real sockets: whatever comes, the server answers or
// closes, and goes on.

#include <gtest/gtest.h>

#include <array>
#include <string>

#include "core/random.h"
#include "raw_client.h"

namespace slipway::server {
namespace {

using std::chrono::milliseconds;

const std::array<std::string, 8> kSeeds{
    get("/healthz"),
    get("/jobs/7?a=b&c=%20"),
    post("/echo", "{\"a\": [1, 2]}"),
    "POST /echo HTTP/1.1\r\nHost: t\r\nContent-Type: application/json\r\nTransfer-Encoding: chunked\r\n\r\n"
    "3\r\nabc\r\n0\r\n\r\n",
    "OPTIONS * HTTP/1.1\r\nHost: t\r\n\r\n",
    "HEAD /healthz HTTP/1.0\r\n\r\n",
    "POST /echo HTTP/1.1\r\nHost: t\r\nExpect: 100-continue\r\nContent-Type: application/json\r\n"
    "Content-Length: 2\r\n\r\n{}",
    "GET http://t/healthz HTTP/1.1\r\nHost: t\r\nRange: bytes=0-1,1-2\r\nConnection: close\r\n\r\n",
};

std::string mutated(std::uint64_t round) {
  std::uint64_t counter = 0;
  const auto draw = [&](std::size_t below) {
    return static_cast<std::size_t>(random_bits(round, counter++) % below);
  };
  std::string bytes = kSeeds[draw(kSeeds.size())];
  const std::size_t mutations = draw(6);
  for (std::size_t m = 0; m < mutations && !bytes.empty(); ++m) {
    const std::size_t at = draw(bytes.size());
    switch (draw(6)) {
      case 0:
        bytes[at] = static_cast<char>(draw(256));
        break;
      case 1:
        bytes.insert(at, 1, static_cast<char>(draw(256)));
        break;
      case 2:
        bytes.erase(at, 1 + draw(8));
        break;
      case 3:
        bytes.insert(at, bytes.substr(draw(bytes.size()), draw(40)));
        break;
      case 4: {
        const std::string& other = kSeeds[draw(kSeeds.size())];
        bytes.insert(at, other.substr(draw(other.size())));
        break;
      }
      default:
        bytes.insert(at, draw(2) == 0 ? "\r\n" : "%");
    }
  }
  return bytes;
}

TEST(HttpFuzz, TheServerSurvivesMutatedRequestsAndStillAnswers) {
  HttpOptions options;
  options.header_deadline = milliseconds(500);
  options.body_deadline = milliseconds(500);
  const TestServer s(options);
  const std::uint64_t rounds = kMeasuring ? 6'000 : 1'500;
  std::size_t answered = 0;
  for (std::uint64_t round = 0; round < rounds; ++round) {
    RawClient client(s.port);
    ASSERT_TRUE(client.connected()) << round;
    client.send(mutated(round));
    client.finish_sending();
    const auto answer = client.read_answer(false, milliseconds(2'000));
    if (answer.status != 0) {
      ++answered;
      ASSERT_TRUE(answer.status < 500 || answer.status == 503)
          << mutated(round) << answer.head << answer.body;
    }
    ASSERT_TRUE(client.closed_within(milliseconds(3'000))) << round;
    if (round % 500 == 0) {
      ASSERT_EQ(ask_once(s.port, get("/healthz")).body, "well") << round;
    }
  }
  EXPECT_GT(answered, rounds / 2);
  EXPECT_EQ(ask_once(s.port, get("/healthz")).body, "well");
}

TEST(HttpFuzz, BytesWithoutAnySenseAreRefused) {
  HttpOptions options;
  options.header_deadline = milliseconds(500);
  const TestServer s(options);
  for (std::uint64_t round = 0; round < 1'000; ++round) {
    std::string bytes;
    const std::size_t size = random_bits(round, 0) % 2'000;
    for (std::size_t i = 0; i < size; ++i) bytes += static_cast<char>(random_bits(round, i + 1));
    RawClient client(s.port);
    client.send(bytes);
    client.finish_sending();
    const auto answer = client.read_answer(false, milliseconds(2'000));
    ASSERT_TRUE(answer.status == 0 || answer.status == 400 || answer.status == 431) << round << answer.head;
  }
  EXPECT_EQ(ask_once(s.port, get("/healthz")).body, "well");
}

}  // namespace
}  // namespace slipway::server
