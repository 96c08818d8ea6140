#include "server/http/http_chunked.h"

#include <algorithm>
#include <charconv>

namespace slipway::server {

ChunkedBody::State ChunkedBody::feed(std::string_view& bytes, std::string& body) {
  while (!bytes.empty() && expecting_ != Expecting::kNothing) {
    if (expecting_ == Expecting::kData) {
      const std::size_t n = static_cast<std::size_t>(std::min<std::uint64_t>(left_, bytes.size()));
      body.append(bytes.substr(0, n));
      bytes.remove_prefix(n);
      left_ -= n;
      if (left_ == 0) expecting_ = Expecting::kDataEnd;
      continue;
    }
    const std::size_t newline = bytes.find('\n');
    const std::size_t n = newline == std::string_view::npos ? bytes.size() : newline + 1;
    if (line_.size() + n > kMaxLine) return State::kMalformed;
    line_.append(bytes.substr(0, n));
    bytes.remove_prefix(n);
    if (newline == std::string_view::npos) break;
    const State state = line(body);
    if (state == State::kMalformed || state == State::kTooLarge) return state;
  }
  return expecting_ == Expecting::kNothing ? State::kDone : State::kMore;
}

ChunkedBody::State ChunkedBody::line(std::string& body) {
  if (!line_.ends_with("\r\n")) return State::kMalformed;
  const std::string text = line_.substr(0, line_.size() - 2);
  line_.clear();
  switch (expecting_) {
    case Expecting::kSize:
      return size_line(text, body);
    case Expecting::kDataEnd:
      if (!text.empty()) return State::kMalformed;
      expecting_ = Expecting::kSize;
      return State::kMore;
    case Expecting::kTrailer:
      if (text.empty()) expecting_ = Expecting::kNothing;
      return ++trailers_ > kMaxTrailers ? State::kMalformed : State::kMore;
    case Expecting::kData:
    case Expecting::kNothing:
      break;
  }
  return State::kMalformed;
}

ChunkedBody::State ChunkedBody::size_line(std::string_view text, const std::string& body) {
  std::uint64_t size = 0;
  const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), size, 16);
  if (fault == std::errc::result_out_of_range) return State::kTooLarge;
  const std::string_view rest = text.substr(static_cast<std::size_t>(end - text.data()));
  if (fault != std::errc{} || (!rest.empty() && rest.front() != ';')) return State::kMalformed;
  if (size > max_bytes_ - body.size()) return State::kTooLarge;
  left_ = size;
  expecting_ = size == 0 ? Expecting::kTrailer : Expecting::kData;
  return State::kMore;
}

}  // namespace slipway::server
