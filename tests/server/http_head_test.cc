#include "server/http/http_head.h"

#include <gtest/gtest.h>

#include "server/http/http_target.h"

namespace slipway::server {
namespace {

Result<RequestHead> read(std::string_view head) {
  static const HttpOptions options;
  return read_head(head, options);
}

// "" when the head is sound, else the name of its error.
std::string refusal(const std::string& head) {
  const auto result = read(head);
  return result ? "" : std::string(error_row(result.error().code).name);
}

std::string with(const std::string& line, const std::string& host = "Host: t\r\n") {
  return "POST /a HTTP/1.1\r\n" + host + "Content-Type: application/json\r\n" + line + "\r\n\r\n";
}

const std::string kMalformed{error_row(ErrorCode::kMalformedHttp).name};

TEST(RequestHead, WithoutALengthThereIsNoBody) {
  const auto head = read("GET /a?b HTTP/1.1\r\nHost: t\r\nX: y\r\n\r\n");
  ASSERT_TRUE(head);
  EXPECT_EQ(head->method, "GET");
  EXPECT_EQ(head->framing, BodyFraming::kNone);
  EXPECT_TRUE(head->keep_alive);
  EXPECT_EQ(head->forwarded, "GET /a?b HTTP/1.1\r\nHost: t\r\nX: y\r\n\r\n");
}

TEST(RequestHead, LengthAndChunksAreTheTwoFramings) {
  const auto length = read(with("Content-Length: 12"));
  ASSERT_TRUE(length);
  EXPECT_EQ(length->framing, BodyFraming::kLength);
  EXPECT_EQ(length->content_length, 12U);
  const auto chunked = read(with("Transfer-Encoding: Chunked"));
  ASSERT_TRUE(chunked);
  EXPECT_EQ(chunked->framing, BodyFraming::kChunked);
}

TEST(RequestHead, FramingsThatCanBeReadInTwoWaysAreMalformed) {
  for (const char* lines : {"Content-Length: 1\r\nTransfer-Encoding: chunked",
                            "Transfer-Encoding: chunked\r\nContent-Length: 1",
                            "Content-Length: 1\r\nContent-Length: 1",
                            "Content-Length: 1\r\ncontent-length: 2",
                            "Content-Length: 1, 1",
                            "Content-Length: +1",
                            "Content-Length: -1",
                            "Content-Length: 0x1",
                            "Content-Length:",
                            "Content-Length: 1 1",
                            "Content-Length: 1.0",
                            "Transfer-Encoding: gzip, chunked",
                            "Transfer-Encoding: identity",
                            "Transfer-Encoding: chunked\r\nTransfer-Encoding: chunked",
                            "Transfer-Encoding: xchunked",
                            "Content-Length : 1",
                            " Content-Length: 1",
                            "X: a\r\n Content-Length: 1",
                            "Content-Length: 1\nX: y",
                            "X: a\rb",
                            "X",
                            ": x",
                            "X\xc3\xa9: y"}) {
    EXPECT_EQ(refusal(with(lines)), kMalformed) << lines;
  }
  EXPECT_EQ(refusal(with(std::string("X: a\0b", 6))), kMalformed);
  EXPECT_EQ(refusal("POST /a HTTP/1.0\r\nTransfer-Encoding: chunked\r\n\r\n"), kMalformed);
}

TEST(RequestHead, ExactlyOneHostIsNeeded) {
  EXPECT_EQ(refusal("GET / HTTP/1.1\r\n\r\n"), kMalformed);
  EXPECT_EQ(refusal("GET / HTTP/1.1\r\nHost: a\r\nHost: a\r\n\r\n"), kMalformed);
  EXPECT_EQ(refusal("GET / HTTP/1.0\r\n\r\n"), "");
}

TEST(RequestHead, MalformedRequestLinesAreRefused) {
  for (const char* line : {"GET",
                           "GET /",
                           "GET  HTTP/1.1",
                           "GET / HTTP/1.2",
                           "GET / HTTP/2.0",
                           "GET / http/1.1",
                           "GET / HTTP/1.1 ",
                           "GET /a b HTTP/1.1",
                           " GET / HTTP/1.1",
                           "G\"T / HTTP/1.1",
                           "GET a HTTP/1.1",
                           "GET * HTTP/1.1",
                           "GET /%zz HTTP/1.1",
                           "GET /%4 HTTP/1.1",
                           "GET /%00 HTTP/1.1",
                           "GET /%0a HTTP/1.1",
                           "GET /%ff HTTP/1.1",
                           "GET /a#b HTTP/1.1",
                           "GET /\xc3\xa9 HTTP/1.1",
                           "GET ftp://h/ HTTP/1.1",
                           "GET http://h HTTP/1.1"}) {
    EXPECT_EQ(refusal(std::string(line) + "\r\nHost: t\r\n\r\n"), kMalformed) << line;
  }
  EXPECT_EQ(refusal("BREW / HTTP/1.1\r\nHost: t\r\n\r\n"), "method_not_allowed");
  EXPECT_EQ(refusal("CONNECT a:1 HTTP/1.1\r\nHost: t\r\n\r\n"), "method_not_allowed");
}

TEST(RequestHead, TheAbsoluteFormOfATargetIsReadAsItsPath) {
  const auto head = read("GET HTTP://host:1/a?b HTTP/1.1\r\nHost: t\r\n\r\n");
  ASSERT_TRUE(head);
  // Its address stands for that of Host.
  EXPECT_EQ(head->forwarded, "GET /a?b HTTP/1.1\r\nHost: host:1\r\n\r\n");
  EXPECT_EQ(refusal("GET http:///a HTTP/1.1\r\nHost: t\r\n\r\n"), kMalformed);
  EXPECT_EQ(refusal("GET http://a\tb/ HTTP/1.1\r\nHost: t\r\n\r\n"), kMalformed);
}

TEST(RequestHead, AHostWithoutANameAndACharsetThatIsNotUtf8AreRefused) {
  EXPECT_EQ(refusal("GET / HTTP/1.1\r\nHost:\r\n\r\n"), kMalformed);
  for (const auto& [type, expected] :
       {std::pair{"application/json; charset=utf-16", "unsupported_media_type"},
        {"application/json;a=b;Charset=\"latin1\"", "unsupported_media_type"},
        {"application/json;charset=\"UTF-8\"", ""},
        {"application/json;", ""}}) {
    EXPECT_EQ(refusal("POST /a HTTP/1.1\r\nHost: t\r\nContent-Length: 1\r\nContent-Type: " +
                      std::string(type) + "\r\n\r\n"),
              expected)
        << type;
  }
}

TEST(RequestHead, ASecondQuestionMarkBelongsToTheQuery) {
  EXPECT_EQ(checked_target("GET", "/a?b?c??d"), "/a?b%3Fc%3F%3Fd");
  EXPECT_EQ(checked_target("GET", "/?"), "/?");
  EXPECT_EQ(checked_target("GET", "/"), "/");
}

TEST(RequestHead, ABodyAboveTheLimitIsRefusedByItsLengthAlone) {
  EXPECT_EQ(refusal(with("Content-Length: 4194304")), "");
  EXPECT_EQ(refusal(with("Content-Length: 4194305")), "payload_too_large");
  EXPECT_EQ(refusal(with("Content-Length: 99999999999999999999999")), "payload_too_large");
}

TEST(RequestHead, ABodyIsJsonAndNothingElse) {
  const auto typed = [](const std::string& type) {
    return refusal("POST / HTTP/1.1\r\nHost: t\r\nContent-Length: 2\r\n" + type + "\r\n");
  };
  EXPECT_EQ(typed("Content-Type: application/json\r\n"), "");
  EXPECT_EQ(typed("Content-Type: Application/JSON ; charset=utf-8\r\n"), "");
  for (const char* type :
       {"", "Content-Type: application/x-www-form-urlencoded\r\n", "Content-Type: text/plain\r\n",
        "Content-Type: multipart/form-data; boundary=x\r\n", "Content-Type: application/jsonx\r\n",
        "Content-Type: application/json\r\nContent-Encoding: gzip\r\n"}) {
    EXPECT_EQ(typed(type), "unsupported_media_type") << type;
  }
  EXPECT_EQ(refusal("POST / HTTP/1.1\r\nHost: t\r\nContent-Length: 0\r\n\r\n"), "")
      << "nothing needs no type";
}

TEST(RequestHead, HeadersThatMustNotBeActedOnAreNotPassedOn) {
  const auto head = read(
      "GET / HTTP/1.1\r\nHost: t\r\nRange: bytes=0-1,2-3\r\nAccept-Encoding: gzip\r\nREMOTE_ADDR: 1.1.1.1\r\n"
      "Connection: close\r\nKeep: 1\r\n\r\n");
  ASSERT_TRUE(head);
  EXPECT_EQ(head->forwarded,
            "GET / HTTP/1.1\r\nHost: t\r\nWithheld-Range: bytes=0-1,2-3\r\nWithheld-Accept-Encoding: gzip\r\n"
            "Keep: 1\r\n\r\n");
  EXPECT_FALSE(head->keep_alive);
}

TEST(RequestHead, TooManyOrTooLongHeadersAreTooLarge) {
  std::string many;
  for (int i = 0; i < 98; ++i) many += "X: y\r\n";
  EXPECT_EQ(refusal("GET / HTTP/1.1\r\nHost: t\r\n" + many + "X: y\r\n\r\n"), "");
  EXPECT_EQ(refusal("GET / HTTP/1.1\r\nHost: t\r\n" + many + "X: y\r\nX: y\r\n\r\n"), "header_too_large");
  EXPECT_EQ(refusal("GET / HTTP/1.1\r\nHost: t\r\nX: " + std::string(8'000, 'y') + "\r\n\r\n"),
            "header_too_large");
  EXPECT_EQ(refusal("GET /" + std::string(8'000, 'y') + " HTTP/1.1\r\nHost: t\r\n\r\n"), "header_too_large");
}

TEST(RequestHead, OnlyABodyCanBeContinued) {
  EXPECT_TRUE(read(with("Expect: 100-continue\r\nContent-Length: 2"))->expects_continue);
  EXPECT_FALSE(read(with("Expect: 100-continue"))->expects_continue);
  EXPECT_EQ(refusal(with("Expect: cookies")), kMalformed);
}

TEST(HeadScan, TheEndIsFoundFromWhicheverByteTheScanResumes) {
  const std::string head = "GET / HTTP/1.1\r\nHost: t\r\n\r\n";
  for (std::size_t cut = 0; cut < head.size(); ++cut) {
    const HeadScan part = scan_head(std::string_view(head).substr(0, cut), 0);
    ASSERT_EQ(part.found, HeadScan::Found::kNothingYet) << cut;
    const HeadScan whole = scan_head(head + "rest", part.resume_at);
    ASSERT_EQ(whole.found, HeadScan::Found::kEnd) << cut;
    EXPECT_EQ(whole.size, head.size()) << cut;
  }
}

TEST(HeadScan, WhatIsNotHttpIsSeenAtItsFirstByteOrLine) {
  EXPECT_EQ(scan_head("\x16\x03\x01", 0).found, HeadScan::Found::kMalformed) << "TLS";
  EXPECT_EQ(scan_head("GET / HTTP/1.1\n", 0).found, HeadScan::Found::kMalformed);
}

TEST(PrintableUtf8, OverlongSurrogateAndControlBytesAreRefused) {
  EXPECT_TRUE(is_printable_utf8("a\xc3\xa9\xe2\x82\xac\xf0\x9f\x9a\x80"));
  for (const char* text : {"\xc0\x80", "\xe0\x80\x80", "\xed\xa0\x80", "\xf4\x90\x80\x80", "\xf0\x80\x80\x80",
                           "\x80", "\xc3", "\xe2\x82", "\x7f", "\xc2\x85", "a\nb"}) {
    EXPECT_FALSE(is_printable_utf8(text)) << text;
  }
}

}  // namespace
}  // namespace slipway::server
