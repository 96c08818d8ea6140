#include "server/http/http_head.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <optional>

#include "server/http/http_target.h"

namespace slipway::server {
namespace {

// CONNECT and TRACE are for proxies; any other name cpp-httplib would refuse with an empty answer.
constexpr std::array<std::string_view, 7> kMethods{"GET",   "HEAD",   "POST",   "PUT",
                                                   "PATCH", "DELETE", "OPTIONS"};

// Never passed on: framing and connection are dealt with here; and the last four are names under which
// cpp-httplib puts the socket's own addresses, beside any that a client sent.
constexpr std::array<std::string_view, 9> kNotForwarded{
    "content-length", "transfer-encoding", "connection", "keep-alive", "expect",
    "remote_addr",    "remote_port",       "local_addr", "local_port"};

bool is_token(std::string_view text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
           std::string_view("!#$%&'*+-.^_`|~").find(c) != std::string_view::npos;
  });
}

bool is_field_value(std::string_view text) {
  return std::all_of(text.begin(), text.end(), [](char c) {
    const auto byte = static_cast<std::uint8_t>(c);
    return (byte >= 0x20 && byte != 0x7f) || c == '\t';
  });
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
  return text;
}

tl::unexpected<Error> malformed(std::string detail) {
  return fail(ErrorCode::kMalformedHttp, std::move(detail));
}

// Reads the lines of one head; its members are what is gathered on the way.
class HeadReader {
 public:
  explicit HeadReader(const HttpOptions& options) : options_(options) {}

  Result<RequestHead> read(std::string_view head) {
    std::size_t fields = 0;
    for (bool first = true; !head.empty(); first = false) {
      const std::size_t end = head.find("\r\n");
      if (end == std::string_view::npos) return malformed("a line of the head does not end in CR LF");
      const std::string_view line = head.substr(0, end);
      head.remove_prefix(end + 2);
      if (line.empty() && !first) break;
      if (line.size() > options_.max_line_bytes) {
        return fail(ErrorCode::kHeaderTooLarge,
                    fmt::format("a line of the head has {} bytes, at most {} are read", line.size(),
                                options_.max_line_bytes));
      }
      if (!first && ++fields > options_.max_header_count) {
        return fail(ErrorCode::kHeaderTooLarge,
                    fmt::format("there are more than {} headers", options_.max_header_count));
      }
      if (auto fault = first ? request_line(line) : field(line)) return fail(std::move(*fault));
    }
    if (auto fault = conclude()) return fail(std::move(*fault));
    return std::move(out_);
  }

 private:
  using MaybeError = std::optional<Error>;

  static MaybeError bad(std::string detail) {
    return Error{ErrorCode::kMalformedHttp, std::move(detail), {}};
  }

  MaybeError request_line(std::string_view line) {
    const std::size_t first = line.find(' ');
    const std::size_t last = line.rfind(' ');
    if (first == std::string_view::npos || first == last)
      return bad("the request line is not METHOD TARGET VERSION");
    const std::string_view method = line.substr(0, first);
    const std::string_view version = line.substr(last + 1);
    if (!is_token(method)) return bad("the request's method is not a token");
    if (version != "HTTP/1.1" && version != "HTTP/1.0")
      return bad("only HTTP/1.1 and HTTP/1.0 are spoken here");
    if (std::find(kMethods.begin(), kMethods.end(), method) == kMethods.end()) {
      return Error{ErrorCode::kMethodNotAllowed,
                   fmt::format("the methods known are {}", fmt::join(kMethods, ", ")),
                   {}};
    }
    const std::string_view sent = line.substr(first + 1, last - first - 1);
    const auto target = checked_target(method, sent);
    if (!target) return bad("the request's target is not a path and query in percent-encoded UTF-8");
    out_.method = method;
    one_point_one_ = version == "HTTP/1.1";
    out_.path = target->substr(0, target->find('?'));
    out_.large = options_.large_bodies.take(method, out_.path);
    out_.forwarded = fmt::format("{} {} {}\r\n", method, *target, version);
    // The address in the request line counts, whatever Host says [RFC 9112, 3.2.2].
    authority_ = authority_in(sent);
    if (authority_ && authority_->empty()) return bad("the request's target names no host");
    if (authority_) out_.forwarded += fmt::format("Host: {}\r\n", *authority_);
    return std::nullopt;
  }

  MaybeError field(std::string_view line) {
    const std::size_t colon = line.find(':');
    // A name that is not a token also catches a folded line and a blank before the colon.
    if (colon == std::string_view::npos || !is_token(line.substr(0, colon))) {
      return bad("a header line is not NAME: VALUE");
    }
    const std::string_view name = line.substr(0, colon);
    const std::string_view value = trimmed(line.substr(colon + 1));
    if (!is_field_value(value)) return bad("a header's value contains a control character");
    if (auto fault = framing_field(name, value)) return fault;
    const auto is_name = [&](std::string_view other) { return equal_ignoring_case(name, other); };
    if (std::any_of(kNotForwarded.begin(), kNotForwarded.end(), is_name) || (authority_ && is_name("host")))
      return std::nullopt;
    const bool withheld = std::any_of(kWithheldNames.begin(), kWithheldNames.end(), is_name);
    fmt::format_to(std::back_inserter(out_.forwarded), "{}{}: {}\r\n", withheld ? kWithheld : "", name,
                   value);
    return std::nullopt;
  }

  MaybeError framing_field(std::string_view name, std::string_view value) {
    if (equal_ignoring_case(name, "content-length")) return length_field(value);
    if (equal_ignoring_case(name, "transfer-encoding")) {
      if (out_.framing == BodyFraming::kLength) return both_framings();
      if (out_.framing == BodyFraming::kChunked) return bad("Transfer-Encoding is given twice");
      if (!one_point_one_) return bad("HTTP/1.0 has no Transfer-Encoding");
      if (!equal_ignoring_case(value, "chunked")) return bad("the only Transfer-Encoding read is chunked");
      out_.framing = BodyFraming::kChunked;
    } else if (equal_ignoring_case(name, "host")) {
      ++hosts_;
      if (value.empty()) return bad("the Host header names no host");
    } else if (equal_ignoring_case(name, "connection")) {
      connection_field(value);
    } else if (equal_ignoring_case(name, "expect")) {
      if (!equal_ignoring_case(value, "100-continue")) return bad("the only Expect met here is 100-continue");
      out_.expects_continue = true;
    } else if (equal_ignoring_case(name, "content-encoding")) {
      return Error{ErrorCode::kUnsupportedMediaType, "a body with a Content-Encoding is not read", {}};
    } else if (equal_ignoring_case(name, "content-type")) {
      if (content_type_) return bad("Content-Type is given twice");
      content_type_ = value;
    }
    return std::nullopt;
  }

  static MaybeError both_framings() { return bad("Content-Length and Transfer-Encoding exclude each other"); }

  MaybeError length_field(std::string_view value) {
    if (out_.framing == BodyFraming::kChunked) return both_framings();
    if (out_.framing == BodyFraming::kLength) return bad("Content-Length is given twice");
    std::uint64_t length = 0;
    const auto [end, fault] = std::from_chars(value.data(), value.data() + value.size(), length);
    const bool digits_only = !value.empty() && end == value.data() + value.size() && value.front() != '-';
    if (fault == std::errc::invalid_argument || !digits_only) return bad("Content-Length is not a number");
    const std::uint64_t most = max_body_bytes(out_, options_);
    if (fault == std::errc::result_out_of_range || length > most) return body_too_large(most);
    out_.framing = BodyFraming::kLength;
    out_.content_length = static_cast<std::size_t>(length);
    return std::nullopt;
  }

  void connection_field(std::string_view value) {
    while (!value.empty()) {
      const std::size_t comma = std::min(value.find(','), value.size());
      if (equal_ignoring_case(trimmed(value.substr(0, comma)), "close")) closes_ = true;
      value.remove_prefix(std::min(comma + 1, value.size()));
    }
  }

  // What can be said only when all fields are there.
  MaybeError conclude() {
    if (hosts_ > 1 || (one_point_one_ && hosts_ == 0)) return bad("exactly one Host header is needed");
    // HTTP/1.0's keep-alive is an extension with traps of its own, and its clients can do without.
    out_.keep_alive = one_point_one_ && !closes_;
    if (out_.framing == BodyFraming::kLength && out_.content_length == 0) out_.framing = BodyFraming::kNone;
    out_.expects_continue = out_.expects_continue && one_point_one_ && out_.framing != BodyFraming::kNone;
    out_.forwarded += "\r\n";
    return out_.framing == BodyFraming::kNone ? std::nullopt : media_type();
  }

  MaybeError media_type() const {
    if (out_.method != "POST" && out_.method != "PUT" && out_.method != "PATCH") return std::nullopt;
    const std::string_view whole = content_type_ ? std::string_view(*content_type_) : std::string_view();
    const std::size_t semicolon = std::min(whole.find(';'), whole.size());
    const std::string_view type = trimmed(whole.substr(0, semicolon));
    const std::vector<std::string>& known =
        out_.large ? options_.large_bodies.media_types : options_.body_media_types;
    for (const std::string& one : known)
      if (equal_ignoring_case(type, one)) return out_.large ? std::nullopt : charset(whole.substr(semicolon));
    return Error{ErrorCode::kUnsupportedMediaType,
                 fmt::format("a body needs a Content-Type, one of: {}", fmt::join(known, ", ")),
                 {}};
  }

  // What is read as text is UTF-8 [RFC 8259, 8.1].
  static MaybeError charset(std::string_view parameters) {
    while (!parameters.empty()) {
      parameters.remove_prefix(1);
      const std::string_view one = trimmed(parameters.substr(0, parameters.find(';')));
      parameters.remove_prefix(std::min(parameters.find(';'), parameters.size()));
      const std::size_t equals = std::min(one.find('='), one.size());
      const std::string_view value = one.substr(std::min(equals + 1, one.size()));
      if (equal_ignoring_case(one.substr(0, equals), "charset") && !equal_ignoring_case(value, "utf-8") &&
          !equal_ignoring_case(value, "\"utf-8\""))
        return Error{ErrorCode::kUnsupportedMediaType, "a body's charset must be utf-8", {}};
    }
    return std::nullopt;
  }

  const HttpOptions& options_;
  RequestHead out_;
  bool one_point_one_ = false;
  bool closes_ = false;
  int hosts_ = 0;
  std::optional<std::string_view> authority_;  // of a target in absolute form
  std::optional<std::string> content_type_;
};

}  // namespace

std::uint64_t max_body_bytes(const RequestHead& head, const HttpOptions& options) {
  return head.large ? static_cast<std::uint64_t>(options.large_bodies.max_bytes) : options.max_body_bytes;
}

Error body_too_large(std::uint64_t max_bytes) {
  return {ErrorCode::kPayloadTooLarge,
          fmt::format("the body has more than the {} bytes that are read", max_bytes),
          {}};
}

Result<RequestHead> read_head(std::string_view head, const HttpOptions& options) {
  return HeadReader(options).read(head);
}

std::optional<std::string> header_in(std::string_view head, std::string_view name) {
  while (!head.empty()) {
    const std::size_t end = std::min(head.find("\r\n"), head.size());
    const std::string_view line = head.substr(0, end);
    head.remove_prefix(std::min(end + 2, head.size()));
    const std::size_t colon = line.find(':');
    if (colon == std::string_view::npos || !equal_ignoring_case(line.substr(0, colon), name)) continue;
    return std::string(trimmed(line.substr(colon + 1)));
  }
  return std::nullopt;
}

HeadScan scan_head(std::string_view bytes, std::size_t resume_at) {
  // Something that is not HTTP at all, TLS above all, would otherwise sit there until its deadline.
  if (resume_at == 0 && !bytes.empty() && !is_token(bytes.substr(0, 1)))
    return {HeadScan::Found::kMalformed, 0, 0};
  for (std::size_t at = bytes.find('\n', resume_at); at != std::string_view::npos;
       at = bytes.find('\n', at + 1)) {
    if (at == 0 || bytes[at - 1] != '\r') return {HeadScan::Found::kMalformed, 0, 0};
    if (at >= 3 && bytes[at - 2] == '\n') return {HeadScan::Found::kEnd, at + 1, 0};
  }
  return {HeadScan::Found::kNothingYet, 0, bytes.size()};
}

}  // namespace slipway::server
