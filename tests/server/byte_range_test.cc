#include "server/routes/byte_range.h"

#include <gtest/gtest.h>

#include <memory>
#include <string>

namespace slipway::server {
namespace {

const std::string kText = "abcdefghijklmnopqrstuvwxyz";
const std::string kTag = "\"tag\"";

HttpRequest request_with(NamedValues headers, std::string method = "GET") {
  HttpRequest request;
  request.method = std::move(method);
  request.headers = std::move(headers);
  return request;
}

// The alphabet in pages of 10, 10 and 6 letters; notes which were read.
PagedBody alphabet(const std::shared_ptr<std::string>& read) {
  return {{10, 10, 6},
          [read](std::size_t page) -> Result<std::string> {
            *read += std::to_string(page);
            return kText.substr(10 * page, 10);
          },
          kTag};
}

struct Answered {
  int status = 0;
  std::string body, content_range, pages_read;
  std::uint64_t length = 0;
};

Answered answer(const HttpRequest& request) {
  const auto read = std::make_shared<std::string>();
  HttpResponse response = ranged({200, "text/plain", "", {}}, alphabet(read), request);
  Answered out{response.status, "", response.header("Content-Range").value_or(""), "",
               response.pieces_bytes.value_or(0)};
  while (response.pieces) {
    const auto piece = response.pieces();
    if (!piece || !*piece) break;
    out.body += **piece;
  }
  out.pages_read = *read;
  if (response.status != 416) {
    EXPECT_EQ(response.header("Accept-Ranges"), "bytes");
    EXPECT_EQ(response.header("ETag"), kTag);
  }
  return out;
}

TEST(ByteRange, APartIsSentFromThePagesItLiesIn) {
  const struct {
    const char *range, *body, *content_range, *pages;
  } cases[] = {
      {"bytes=0-0", "a", "bytes 0-0/26", "0"},
      {"bytes=0-9", "abcdefghij", "bytes 0-9/26", "0"},
      {"bytes=9-10", "jk", "bytes 9-10/26", "01"},
      {"bytes=10-19", "klmnopqrst", "bytes 10-19/26", "1"},
      {"Bytes= 8-21 ", "ijklmnopqrstuv", "bytes 8-21/26", "012"},
      {"bytes=24-", "yz", "bytes 24-25/26", "2"},
      {"bytes=24-99999999999999999999999", "yz", "bytes 24-25/26", "2"},
      {"bytes=-7", "tuvwxyz", "bytes 19-25/26", "12"},
      {"bytes=-26", kText.c_str(), "bytes 0-25/26", "012"},
      {"bytes=-99", kText.c_str(), "bytes 0-25/26", "012"},
  };
  for (const auto& c : cases) {
    const Answered got = answer(request_with({{"Range", c.range}}));
    EXPECT_EQ(got.status, 206) << c.range;
    EXPECT_EQ(got.body, c.body) << c.range;
    EXPECT_EQ(got.length, got.body.size()) << c.range;
    EXPECT_EQ(got.content_range, c.content_range) << c.range;
    EXPECT_EQ(got.pages_read, c.pages) << c.range;
  }
}

TEST(ByteRange, WhatIsNotOneRangeIsAnsweredWithTheWhole) {
  for (const char* range :
       {"", "bytes", "bytes=", "bytes=-", "bytes=5-2", "bytes=a-b", "bytes=1-2x", "bytes=+1-2", "bytes=1",
        "bytes=0-1,4-5", "bytes=0-1,", "lines=1-2", "bytes=--1", "bytes=1--2"}) {
    const Answered got = answer(request_with({{"Range", range}}));
    EXPECT_EQ(got.status, 200) << range;
    EXPECT_EQ(got.body, kText) << range;
    EXPECT_EQ(got.length, 26U) << range;
    EXPECT_EQ(got.content_range, "") << range;
  }
  EXPECT_EQ(answer(request_with({{"Range", "bytes=0-1"}, {"range", "bytes=4-5"}})).status, 200);
  EXPECT_EQ(answer(request_with({{"Range", "bytes=0-1"}}, "HEAD")).status, 200);
  EXPECT_EQ(answer(request_with({})).body, kText);
}

TEST(ByteRange, ARangeBehindTheEndIsRefusedWithTheLength) {
  for (const char* range : {"bytes=26-", "bytes=26-30", "bytes=-0", "bytes=99999999999999999999999-"}) {
    const Answered got = answer(request_with({{"Range", range}}));
    EXPECT_EQ(got.status, 416) << range;
    EXPECT_EQ(got.content_range, "bytes */26") << range;
    EXPECT_EQ(got.pages_read, "") << range;
  }
}

TEST(ByteRange, IfRangeHoldsOnlyForTheVersionItNames) {
  const auto status = [](const char* if_range) {
    return answer(request_with({{"Range", "bytes=0-1"}, {"If-Range", if_range}})).status;
  };
  EXPECT_EQ(status("\"tag\""), 206);
  EXPECT_EQ(status("\"other\""), 200);
  EXPECT_EQ(status("W/\"tag\""), 200);
  EXPECT_EQ(status("Sun, 06 Nov 1994 08:49:37 GMT"), 200);
  EXPECT_EQ(answer(request_with({{"Range", "bytes=0-1"}, {"If-None-Match", kTag}})).status, 304);
}

TEST(ByteRange, APageThatHasAnotherLengthThanItHadEndsTheBody) {
  PagedBody body{{10}, [](std::size_t) -> Result<std::string> { return std::string("short"); }, kTag};
  const HttpResponse response = ranged({200, "text/plain", "", {}}, std::move(body), request_with({}));
  EXPECT_FALSE(response.pieces());
}

TEST(ByteRange, AnEmptyBodyHasNoRange) {
  const PagedBody body{{}, nullptr, kTag};
  const HttpResponse whole = ranged({200, "text/plain", "", {}}, body, request_with({}));
  EXPECT_EQ(whole.pieces_bytes, 0U);
  EXPECT_EQ(whole.pieces().value(), std::nullopt);
  EXPECT_EQ(ranged({200, "text/plain", "", {}}, body, request_with({{"Range", "bytes=0-"}})).status, 416);
}

}  // namespace
}  // namespace slipway::server
