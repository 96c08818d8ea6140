#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "core/result.h"
#include "server/http/http_options.h"

namespace slipway::server {

// Under names that begin so pass the headers which cpp-httplib must not see and handlers may: of
// Accept-Encoding it would compress whole answers in memory, of Range cut them up there.
inline constexpr std::string_view kWithheld = "Withheld-";
inline constexpr std::array<std::string_view, 3> kWithheldNames{"Accept-Encoding", "Range", "If-Range"};

enum class BodyFraming { kNone, kLength, kChunked };

// What the head of a request says about how to read on, and the head as it is passed on.
struct RequestHead {
  std::string method;
  std::string path;  // as sent, without the query
  BodyFraming framing = BodyFraming::kNone;
  std::size_t content_length = 0;  // with kLength
  bool large = false;              // the body goes into a file, see LargeBodies
  bool keep_alive = true;          // what the client wants
  bool expects_continue = false;   // it waits for "100 Continue" before it sends the body
  std::string forwarded;           // the head for cpp-httplib, without the headers it must not act on
};

// Checks a whole head (up to and including its empty line) against RFC 9112, refusing whatever two parsers
// could read in two ways: such differences are how one request is smuggled inside another.
Result<RequestHead> read_head(std::string_view head, const HttpOptions& options);

// Of the body that follows a head, and the refusal of what is longer.
std::uint64_t max_body_bytes(const RequestHead& head, const HttpOptions& options);
Error body_too_large(std::uint64_t max_bytes);

// The value of the first header of this name in a whole head, sound or not; nothing where the head has none.
std::optional<std::string> header_in(std::string_view head, std::string_view name);

// What is known of a head of which only the beginning is there.
struct HeadScan {
  enum class Found { kNothingYet, kEnd, kMalformed } found = Found::kNothingYet;
  std::size_t size = 0;  // with kEnd: of the head, with its empty line
  std::size_t resume_at =
      0;  // with kNothingYet: where to go on, so that a dripped head is not scanned anew each time
};
HeadScan scan_head(std::string_view bytes, std::size_t resume_at);

}  // namespace slipway::server
