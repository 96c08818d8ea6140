#include "server/http/http_chunked.h"

#include <gtest/gtest.h>

#include "core/random.h"

namespace slipway::server {
namespace {

using State = ChunkedBody::State;

struct Outcome {
  State state = State::kMore;
  std::string body;
  std::string rest;
};

// The bytes in pieces of at most `piece`.
Outcome decode(std::string_view bytes, std::size_t max_bytes, std::size_t piece = 1 << 20) {
  ChunkedBody chunked(max_bytes);
  Outcome out;
  while (!bytes.empty() && out.state == State::kMore) {
    std::string_view part = bytes.substr(0, piece);
    const std::size_t offered = part.size();
    out.state = chunked.feed(part, out.body);
    bytes.remove_prefix(offered - part.size());
  }
  out.rest = bytes;
  return out;
}

TEST(ChunkedBody, ChunksAreJoinedAndWhatFollowsIsLeft) {
  const Outcome out = decode("5\r\nhello\r\n6;name=\"v\"\r\n world\r\n0\r\nA: b\r\n\r\nGET /", 100);
  EXPECT_EQ(out.state, State::kDone);
  EXPECT_EQ(out.body, "hello world");
  EXPECT_EQ(out.rest, "GET /");
}

TEST(ChunkedBody, TheOutcomeDoesNotDependOnHowTheBytesArePieced) {
  const std::string bytes = "5\r\nhello\r\n1a;x\r\nabcdefghijklmnopqrstuvwxyz\r\n0\r\n\r\n";
  for (std::size_t piece = 1; piece <= bytes.size(); ++piece) {
    const Outcome out = decode(bytes, 100, piece);
    EXPECT_EQ(out.state, State::kDone) << piece;
    EXPECT_EQ(out.body, "helloabcdefghijklmnopqrstuvwxyz") << piece;
  }
}

TEST(ChunkedBody, ABodyAboveItsBudgetIsRefusedBeforeItIsThere) {
  EXPECT_EQ(decode("5\r\nhello\r\n0\r\n\r\n", 5).state, State::kDone);
  EXPECT_EQ(decode("5\r\nhello\r\n1\r\n", 5).state, State::kTooLarge);
  const Outcome out = decode("ffffffffffffffff\r\nxxxx", 100);
  EXPECT_EQ(out.state, State::kTooLarge);
  EXPECT_EQ(out.body, "");
  EXPECT_EQ(decode("fffffffffffffffff\r\n", 100).state, State::kTooLarge) << "more than 64 bits";
}

TEST(ChunkedBody, FramingThatTwoReadersCouldReadDifferentlyIsMalformed) {
  for (const char* bytes : {"5\nhello\r\n", "5\r\nhello0\r\n\r\n", "5 \r\nhello\r\n", " 5\r\nhello\r\n",
                            "+5\r\nhello\r\n", "-5\r\nhello\r\n", "0x5\r\nhello\r\n", "\r\n", "g\r\n",
                            ";x\r\n", "5\r\nhello\n\n", "0\r\nA: b\n\r\n"}) {
    EXPECT_EQ(decode(bytes, 100).state, State::kMalformed) << bytes;
  }
}

TEST(ChunkedBody, LinesAndTrailersWithoutEndAreRefused) {
  EXPECT_EQ(decode(std::string(10'000, '0'), 100).state, State::kMalformed);
  EXPECT_EQ(decode("1;" + std::string(10'000, 'x'), 100, 7).state, State::kMalformed);
  std::string trailers = "0\r\n";
  for (int i = 0; i < 1'000; ++i) trailers += "A: b\r\n";
  EXPECT_EQ(decode(trailers, 100).state, State::kMalformed);
}

TEST(ChunkedBody, RandomBytesNeverGiveMoreThanTheBudget) {
  const std::string alphabet = "0123456789abcdefF;\r\n\r\n\r\nxyz";
  for (std::uint64_t round = 0; round < 20'000; ++round) {
    std::string bytes;
    const std::size_t size = 1 + random_bits(round, 0) % 60;
    for (std::size_t i = 0; i < size; ++i) bytes += alphabet[random_bits(round, i + 1) % alphabet.size()];
    const Outcome whole = decode(bytes, 20);
    const Outcome pieced = decode(bytes, 20, 1 + round % 7);
    ASSERT_LE(whole.body.size(), 20U);
    ASSERT_EQ(whole.state, pieced.state) << bytes;
    ASSERT_EQ(whole.body, pieced.body) << bytes;
  }
}

}  // namespace
}  // namespace slipway::server
