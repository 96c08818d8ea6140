// What comes over a socket before any library of others sees it: the head of a request, its target and the
// framing of its body.

#include <algorithm>
#include <string>

#include "fuzz_target.h"
#include "server/http/http_chunked.h"
#include "server/http/http_head.h"
#include "server/http/http_target.h"

namespace {

using namespace slipway;

// The body's framing says the same whether its bytes come at once or one by one.
void check_chunked(std::string_view bytes) {
  constexpr std::size_t kMaxBytes = 1000;
  server::ChunkedBody whole(kMaxBytes), dripped(kMaxBytes);
  std::string body_whole, body_dripped;
  std::string_view rest = bytes;
  const auto state = whole.feed(rest, body_whole);
  auto dripped_state = server::ChunkedBody::State::kMore;
  for (std::size_t i = 0; i < bytes.size() && dripped_state == server::ChunkedBody::State::kMore; ++i) {
    std::string_view one = bytes.substr(i, 1);
    dripped_state = dripped.feed(one, body_dripped);
  }
  fuzz::require(body_whole.size() <= kMaxBytes, "a chunked body keeps to its budget");
  fuzz::require(state == dripped_state, "a chunked body ends the same way in pieces");
  if (state == server::ChunkedBody::State::kDone)
    fuzz::require(body_whole == body_dripped, "a chunked body has the same bytes in pieces");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes = fuzz::text_of(data, size);
  const server::HeadScan scan = server::scan_head(bytes, 0);
  if (scan.found == server::HeadScan::Found::kEnd) {
    fuzz::require(scan.size <= bytes.size(), "a head ends inside what has come");
    const auto head = server::read_head(bytes.substr(0, scan.size), server::HttpOptions{});
    if (head) {
      fuzz::require(head->forwarded.ends_with("\r\n\r\n"), "a head is passed on whole");
      if (head->framing == server::BodyFraming::kChunked) check_chunked(bytes.substr(scan.size));
    } else {
      fuzz::require(!head.error().detail.empty(), "a refusal says why");
    }
  }
  // A head that drips in is scanned on from where the last scan stopped, to the same end.
  server::HeadScan dripped;
  for (std::size_t have = 1; have <= bytes.size() && dripped.found == server::HeadScan::Found::kNothingYet;
       ++have)
    dripped = server::scan_head(bytes.substr(0, have), dripped.resume_at);
  fuzz::require(dripped.found == scan.found && dripped.size == scan.size,
                "a head ends at the same place in pieces");
  (void)server::checked_target("GET", bytes);
  check_chunked(bytes);
  return 0;
}
