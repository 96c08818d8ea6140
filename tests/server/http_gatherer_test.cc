#include "server/http/http_gatherer.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <vector>

#include "core/random.h"
#include "raw_client.h"

namespace slipway::server {
namespace {

using State = RequestGatherer::State;

struct Outcome {
  std::vector<std::string> requests;  // head and body
  State last = State::kIdle;
  ErrorCode refusal = ErrorCode::kInternal;

  bool operator==(const Outcome&) const = default;
};

HttpOptions small_options() {
  HttpOptions options;
  options.max_body_bytes = 1'000;
  options.max_header_bytes = 400;
  return options;
}

// As the loop does it: never more than the appetite, and at most `piece` bytes at once.
Outcome gather(std::string_view bytes, const HttpOptions& options, std::size_t piece = 1 << 20) {
  RequestGatherer gatherer(options);
  Outcome out;
  for (;;) {
    out.last = gatherer.feed({});
    if (out.last == State::kReady) {
      auto taken = gatherer.take();
      out.requests.push_back(taken.head.forwarded + taken.body);
      continue;
    }
    if (out.last == State::kRefused) out.refusal = gatherer.refusal().code;
    const std::size_t n = std::min({bytes.size(), piece, gatherer.appetite()});
    if (n == 0) return out;
    gatherer.feed(bytes.substr(0, n));
    bytes.remove_prefix(n);
  }
}

std::string three_requests() {
  return get("/a") + post("/b", "{\"x\": 1}") + "\r\n" + "PUT /c HTTP/1.1\r\nHost: t\r\n" +
         "Content-Type: application/json\r\nTransfer-Encoding: "
         "chunked\r\n\r\n3\r\nabc\r\n2\r\nde\r\n0\r\n\r\n" +
         "GET /incomplete";
}

TEST(RequestGatherer, RequestsAreTheSameWhateverPiecesTheyArriveIn) {
  const HttpOptions options = small_options();
  const Outcome whole = gather(three_requests(), options);
  ASSERT_EQ(whole.requests.size(), 3U);
  EXPECT_TRUE(whole.requests[1].ends_with("\r\n\r\n{\"x\": 1}")) << whole.requests[1];
  EXPECT_TRUE(whole.requests[2].ends_with("\r\n\r\nabcde")) << whole.requests[2];
  EXPECT_EQ(whole.last, State::kHead);
  for (std::size_t piece = 1; piece < 200; ++piece)
    EXPECT_EQ(gather(three_requests(), options, piece), whole) << piece;
}

TEST(RequestGatherer, AHeadOfExactlyTheLimitIsReadAndOneByteMoreIsNot) {
  HttpOptions options = small_options();
  const std::string head = get("/a", "X: y\r\n");
  options.max_header_bytes = head.size();
  for (const std::size_t piece : {1, 7, 1'000}) {
    EXPECT_EQ(gather(head, options, piece).requests.size(), 1U) << piece;
    const Outcome more = gather(get("/a", "X: yy\r\n"), options, piece);
    EXPECT_EQ(more.last, State::kRefused) << piece;
    EXPECT_EQ(more.refusal, ErrorCode::kHeaderTooLarge) << piece;
  }
}

TEST(RequestGatherer, ALongRowOfPipelinedRequestsIsNotTakenForALongHead) {
  std::string bytes;
  for (int i = 0; i < 100; ++i) bytes += get("/a");
  EXPECT_EQ(gather(bytes, small_options()).requests.size(), 100U);
}

TEST(RequestGatherer, ContinueIsDueOnceAndOnlyWhileTheClientWaits) {
  const HttpOptions options = small_options();
  RequestGatherer waiting(options);
  waiting.feed(
      "POST / HTTP/1.1\r\nHost: t\r\nContent-Type: application/json\r\nContent-Length: 2\r\n"
      "Expect: 100-continue\r\n\r\n");
  EXPECT_TRUE(waiting.take_continue());
  EXPECT_FALSE(waiting.take_continue());
  RequestGatherer eager(options);
  eager.feed(post("/", "{}", "Expect: 100-continue\r\n"));
  EXPECT_FALSE(eager.take_continue());
}

TEST(RequestGatherer, WhatItHoldsIsBoundedByTheLimits) {
  const HttpOptions options = small_options();
  RequestGatherer gatherer(options);
  gatherer.feed(
      "POST / HTTP/1.1\r\nHost: t\r\nContent-Type: application/json\r\nTransfer-Encoding: chunked\r\n\r\n");
  for (int i = 0; i < 10'000 && gatherer.state() == State::kBody; ++i) {
    gatherer.feed("10\r\n0123456789abcdef\r\n");
    ASSERT_LE(gatherer.held(), options.max_body_bytes + 64);
  }
  EXPECT_EQ(gatherer.state(), State::kRefused);
  EXPECT_EQ(gatherer.refusal().code, ErrorCode::kPayloadTooLarge);
  EXPECT_EQ(gatherer.held(), 0U);
}

// Options under which POST /large goes into files of the tests' own folder.
HttpOptions with_large_bodies() {
  HttpOptions options = small_options();
  options.large_bodies.folder = ::testing::TempDir();
  options.large_bodies.paths = {"/large"};
  options.large_bodies.max_bytes = 5'000;
  options.large_bodies.max_total_bytes = 6'000;
  return options;
}

std::string large_request(const std::string& body, const std::string& path = "/large") {
  return "POST " + path + "?name=a HTTP/1.1\r\nHost: t\r\nContent-Type: text/csv\r\nContent-Length: " +
         std::to_string(body.size()) + "\r\n\r\n" + body;
}

// The gatherer after all bytes that it wants.
RequestGatherer::State give(RequestGatherer& gatherer, std::string_view bytes, std::size_t piece) {
  while (!bytes.empty() && gatherer.appetite() > 0) {
    const std::size_t n = std::min({bytes.size(), piece, gatherer.appetite()});
    gatherer.feed(bytes.substr(0, n));
    bytes.remove_prefix(n);
  }
  return gatherer.state();
}

TEST(RequestGatherer, ALargeBodyIsInItsFileAndNotInMemory) {
  const HttpOptions options = with_large_bodies();
  std::string body;
  for (int k = 0; k < 4'000; ++k) body += static_cast<char>('a' + k % 26);
  for (const std::size_t piece : {1U, 33U, 5'000U}) {
    RequestGatherer gatherer(options);
    ASSERT_EQ(give(gatherer, large_request(body), piece), State::kReady) << piece;
    EXPECT_EQ(gatherer.held(), 0U);
    EXPECT_EQ(*options.large_bodies.under_way, 4'000);
    const auto taken = gatherer.take();
    EXPECT_TRUE(taken.body.empty());
    ASSERT_NE(taken.body_file, nullptr);
    std::string read(body.size() + 1, '\0');
    read.resize(static_cast<std::size_t>(::pread(taken.body_file->fd(), read.data(), read.size(), 0)));
    EXPECT_EQ(read, body);
  }
  EXPECT_EQ(*options.large_bodies.under_way, 0) << "the files are gone with their requests";
}

TEST(RequestGatherer, LargeBodiesHaveBoundsOfTheirOwn) {
  const HttpOptions options = with_large_bodies();
  RequestGatherer one(options), other(options), third(options), elsewhere(options);
  EXPECT_EQ(give(one, large_request(std::string(5'000, 'x')), 1'000), State::kReady);
  EXPECT_EQ(give(other, large_request(std::string(5'001, 'x')), 1'000), State::kRefused);
  EXPECT_EQ(other.refusal().code, ErrorCode::kPayloadTooLarge);
  EXPECT_EQ(give(third, large_request(std::string(2'000, 'x')), 500), State::kRefused) << "7,000 in all";
  EXPECT_EQ(third.refusal().code, ErrorCode::kTooManyJobs);
  EXPECT_EQ(*options.large_bodies.under_way, 5'000);
  EXPECT_EQ(give(elsewhere, large_request("x", "/larger"), 100), State::kRefused);
  EXPECT_EQ(elsewhere.refusal().code, ErrorCode::kUnsupportedMediaType) << "CSV is taken there alone";
}

TEST(RequestGatherer, MutatedRequestsAreReadTheSameInAnyPieces) {
  const HttpOptions options = small_options();
  constexpr std::string_view kWithNul{"\r\n :;0159afGPX/%,*\0\x7f\x80\xff\t", 23};
  const std::string alphabet(kWithNul);
  for (std::uint64_t round = 0; round < 5'000; ++round) {
    std::string bytes = three_requests();
    const std::size_t mutations = 1 + random_bits(round, 0) % 4;
    for (std::size_t m = 0; m < mutations; ++m) {
      const std::size_t at = random_bits(round, 3 * m + 1) % bytes.size();
      const char c = alphabet[random_bits(round, 3 * m + 2) % alphabet.size()];
      switch (random_bits(round, 3 * m + 3) % 3) {
        case 0:
          bytes[at] = c;
          break;
        case 1:
          bytes.insert(at, 1, c);
          break;
        default:
          bytes.erase(at, 1);
      }
    }
    const Outcome whole = gather(bytes, options);
    ASSERT_EQ(gather(bytes, options, 1 + round % 50), whole) << bytes;
    for (const std::string& request : whole.requests) ASSERT_LE(request.size(), 1'400U);
  }
}

}  // namespace
}  // namespace slipway::server
