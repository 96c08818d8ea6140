#include "server/http/http_target.h"

#include <algorithm>
#include <cstdint>

#include "server/http/http_message.h"

namespace slipway::server {
namespace {

int hex_value(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

// The number of bytes of the code point at the front, or 0 if there is none (RFC 3629: no overlong forms, no
// surrogates, nothing above U+10FFFF) or it is a control character.
std::size_t printable_code_point(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(text[i]); };
  const std::uint8_t first = byte(0);
  if (first < 0x80) return first >= 0x20 && first != 0x7f ? 1 : 0;
  const std::size_t size = first >= 0xc2 && first <= 0xdf   ? 2
                           : first >= 0xe0 && first <= 0xef ? 3
                           : first >= 0xf0 && first <= 0xf4 ? 4
                                                            : 0;
  if (size == 0 || text.size() < size) return 0;
  std::uint32_t code = first & (0xffU >> (size + 1));
  for (std::size_t i = 1; i < size; ++i) {
    if ((byte(i) & 0xc0) != 0x80) return 0;
    code = (code << 6) | (byte(i) & 0x3fU);
  }
  if (size == 2) return code >= 0xa0 ? 2 : 0;
  if (size == 3) return code >= 0x800 && (code < 0xd800 || code > 0xdfff) ? 3 : 0;
  return code >= 0x10000 && code <= 0x10ffff ? 4 : 0;
}

// What stands before the authority in the absolute form "http://host/path", which a server must accept as
// well [RFC 9112, 3.2.2]; empty in another one.
std::string_view scheme_of(std::string_view target) {
  for (const std::string_view scheme : {"http://", "https://"})
    if (equal_ignoring_case(target.substr(0, scheme.size()), scheme)) return target.substr(0, scheme.size());
  return {};
}

std::string_view without_origin(std::string_view target) {
  const auto authority = authority_in(target);
  return authority ? target.substr(scheme_of(target).size() + authority->size()) : target;
}

}  // namespace

std::optional<std::string> percent_decoded(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      out += text[i];
      continue;
    }
    if (i + 2 >= text.size()) return std::nullopt;
    const int high = hex_value(text[i + 1]);
    const int low = hex_value(text[i + 2]);
    if (high < 0 || low < 0) return std::nullopt;
    out += static_cast<char>(high * 16 + low);
    i += 2;
  }
  return out;
}

bool is_printable_utf8(std::string_view text) {
  while (!text.empty()) {
    const std::size_t size = printable_code_point(text);
    if (size == 0) return false;
    text.remove_prefix(size);
  }
  return true;
}

std::optional<std::string_view> authority_in(std::string_view target) {
  const std::string_view scheme = scheme_of(target);
  if (scheme.empty()) return std::nullopt;
  target.remove_prefix(scheme.size());
  return target.substr(0, target.find_first_of("/?"));
}

std::optional<std::string> checked_target(std::string_view method, std::string_view target) {
  if (target == "*" && method == "OPTIONS") return std::string(target);
  const std::string_view origin = without_origin(target);
  if (origin.empty() || origin.front() != '/') return std::nullopt;
  for (const char c : target) {
    // A fragment is the client's own business and is never sent; beyond ASCII everything is to be
    // percent-encoded.
    if (c <= ' ' || c >= 0x7f || c == '#') return std::nullopt;
  }
  const auto decoded = percent_decoded(origin);
  if (!decoded || !is_printable_utf8(*decoded)) return std::nullopt;
  // A question mark in a query is a character like any other, but cpp-httplib refuses the second one.
  std::string out(origin);
  const std::size_t query = std::min(out.find('?'), out.size() - 1) + 1;
  for (std::size_t at = out.find('?', query); at != std::string::npos; at = out.find('?', at)) {
    out.replace(at, 1, "%3F");
  }
  return out;
}

}  // namespace slipway::server
