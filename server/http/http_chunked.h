#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace slipway::server {

// Takes the framing off a chunked body [RFC 9112, 7.1] as its bytes arrive, and keeps to a budget:
// cpp-httplib's own reader would take 256 MiB in chunks whatever its payload maximum says.
class ChunkedBody {
 public:
  enum class State { kMore, kDone, kTooLarge, kMalformed };

  explicit ChunkedBody(std::size_t max_bytes) : max_bytes_(max_bytes) {}

  // Consumes from the front of `bytes` and appends what it frames to `body`. In kDone what follows the body
  // is left.
  State feed(std::string_view& bytes, std::string& body);

 private:
  enum class Expecting { kSize, kData, kDataEnd, kTrailer, kNothing };

  State line(std::string& body);
  State size_line(std::string_view text, const std::string& body);

  // A size has at most 16 digits, an extension is legal and ignored; trailers are read and forgotten.
  static constexpr std::size_t kMaxLine = 256;
  static constexpr std::size_t kMaxTrailers = 32;

  std::size_t max_bytes_;
  Expecting expecting_ = Expecting::kSize;
  std::uint64_t left_ = 0;  // of the chunk's data
  std::size_t trailers_ = 0;
  std::string line_;  // a line of framing of which the end has not come yet
};

}  // namespace slipway::server
