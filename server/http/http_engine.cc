#include "server/http/http_engine.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <httplib.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <ctime>
#include <optional>
#include <stdexcept>
#include <utility>

#include "server/http/http_head.h"

namespace slipway::server {
namespace {

// Under these names cpp-httplib puts the socket's addresses beside the request's headers.
constexpr std::array<std::string_view, 4> kAddressNames{"REMOTE_ADDR", "REMOTE_PORT", "LOCAL_ADDR",
                                                        "LOCAL_PORT"};
constexpr std::array<std::string_view, 4> kFramingNames{"Content-Length", "Transfer-Encoding", "Connection",
                                                        "Keep-Alive"};

template <std::size_t N>
bool is_among(const std::array<std::string_view, N>& names, std::string_view name) {
  return std::any_of(names.begin(), names.end(),
                     [&](std::string_view n) { return equal_ignoring_case(n, name); });
}

// Below this, one more copy is cheaper than one more call of send().
constexpr std::size_t kJoinedBody = std::size_t{16} << 10;

// A head to read, and room for the head of an answer.
class MemoryStream final : public httplib::Stream {
 public:
  explicit MemoryStream(std::string_view head) : head_(head) {}

  bool is_readable() const override { return !head_.empty(); }
  bool is_writable() const override { return true; }
  ssize_t read(char* to, size_t size) override {
    const std::size_t n = std::min(size, head_.size());
    std::memcpy(to, head_.data(), n);
    head_.remove_prefix(n);
    return static_cast<ssize_t>(n);
  }
  ssize_t write(const char* from, size_t size) override {
    written_.append(from, size);
    return static_cast<ssize_t>(size);
  }
  void get_remote_ip_and_port(std::string& /*ip*/, int& /*port*/) const override {}
  void get_local_ip_and_port(std::string& /*ip*/, int& /*port*/) const override {}
  // Not a descriptor: above FD_SETSIZE cpp-httplib would give up on a real one.
  socket_t socket() const override { return INVALID_SOCKET; }

  std::string take() { return std::move(written_); }

 private:
  std::string_view head_;
  std::string written_;
};

std::string name_before_withholding(const std::string& name) {
  const auto known =
      std::find_if(kWithheldNames.begin(), kWithheldNames.end(), [&](std::string_view withheld) {
        return equal_ignoring_case(name, fmt::format("{}{}", kWithheld, withheld));
      });
  return known == kWithheldNames.end() ? name : std::string(*known);
}

NamedValues decoded_query(std::string_view text) {
  // cpp-httplib's own reading drops the second of two equal pairs and forgets their order.
  NamedValues out;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('&'), text.size());
    const std::string_view pair = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (pair.empty()) continue;
    const std::size_t equals = std::min(pair.find('='), pair.size());
    const std::string_view value = pair.substr(std::min(equals + 1, pair.size()));
    out.emplace_back(httplib::detail::decode_url(std::string(pair.substr(0, equals)), true),
                     httplib::detail::decode_url(std::string(value), true));
  }
  return out;
}

HttpRequest request_from(const httplib::Request& in, HttpEngine::Exchange& exchange) {
  HttpRequest out;
  out.method = in.method;
  out.path = in.path;
  const std::size_t question = std::min(in.target.find('?'), in.target.size());
  out.raw_path = in.target.substr(0, question);
  if (question < in.target.size())
    out.query = decoded_query(std::string_view(in.target).substr(question + 1));
  for (const auto& [name, value] : in.headers) {
    if (is_among(kAddressNames, name)) continue;
    out.headers.emplace_back(name_before_withholding(name), value);
  }
  out.body = std::move(exchange.body);
  out.body_file = std::move(exchange.body_file);
  out.remote_address = std::move(exchange.remote_address);
  return out;
}

// The same body in chunks [RFC 9112, 7.1]; the last one is empty.
BodyPieces in_chunks(BodyPieces pieces) {
  return [pieces = std::move(pieces), ended = false]() mutable -> Result<std::optional<std::string>> {
    for (;;) {
      if (ended) return std::nullopt;
      auto piece = pieces();
      if (!piece) return fail(piece.error());
      if (*piece && (*piece)->empty()) continue;
      ended = !*piece;
      const std::string_view bytes = ended ? std::string_view() : std::string_view(**piece);
      return fmt::format("{:x}\r\n{}\r\n", bytes.size(), bytes);
    }
  };
}

void fill(httplib::Response& out, HttpResponse in) {
  out.status = in.status;
  for (const auto& [name, value] : in.headers) {
    if (!is_among(kFramingNames, name)) out.set_header(name, value);
  }
  if ((!in.body.empty() || in.stream || in.pieces) && !in.content_type.empty())
    out.set_header("Content-Type", in.content_type);
  out.body = std::move(in.body);
  // "Sun, 06 Nov 1994 08:49:37 GMT" [RFC 9110, 5.6.7]; in the program's locale, which nobody sets.
  out.set_header("Date", fmt::format("{:%a, %d %b %Y %H:%M:%S} GMT", fmt::gmtime(std::time(nullptr))));
}

}  // namespace

class HttpEngine::Adapter final : public httplib::Server {
 public:
  explicit Adapter(const HttpOptions& options) {
    set_keep_alive_timeout(std::chrono::duration_cast<std::chrono::seconds>(options.idle_deadline).count());
    set_keep_alive_max_count(options.max_requests_per_connection);
    // A browser is not to guess a type from the bytes: then an uploaded name could become a page.
    set_default_headers({{"X-Content-Type-Options", "nosniff"}});
    set_pre_routing_handler([this](const httplib::Request& in, httplib::Response& out) {
      reached_ = true;
      HttpRequest request = request_from(in, *exchange_);
      HttpResponse response = (*answer_)(request);
      goes_on_ = response.stream || response.pieces;
      pieces_bytes_ = response.pieces_bytes;
      offers_ranges_ = response.header("Accept-Ranges").has_value();
      stream_ = in.method == "HEAD" ? nullptr : response.stream;
      pieces_ = in.method == "HEAD" ? nullptr : response.pieces;
      fill(out, std::move(response));
      return HandlerResponse::Handled;
    });
    set_post_routing_handler([this](const httplib::Request& in, httplib::Response& out) {
      // Here its length is in the headers already, and nothing of it is written.
      body_ = in.method == "HEAD" ? std::string() : std::move(out.body);
      out.body.clear();
      // cpp-httplib offers ranges with every HEAD, and a length where there must be none [RFC 9110, 8.6].
      if (!offers_ranges_) out.headers.erase("Accept-Ranges");
      if (out.status == 204 || out.status < 200 || goes_on_) out.headers.erase("Content-Length");
      if (goes_on_ && pieces_bytes_) {
        out.set_header("Content-Length", fmt::to_string(*pieces_bytes_));
      } else if (pieces_ && in.version == "HTTP/1.1") {
        out.set_header("Transfer-Encoding", "chunked");
        pieces_ = in_chunks(std::move(pieces_));
      }
      if (!stream_) return;
      out.headers.erase("Keep-Alive");
      out.headers.erase("Connection");
      out.set_header("Connection", "close");
    });
    // Without one, cpp-httplib sends an exception's text in a header.
    set_exception_handler([this](const httplib::Request&, httplib::Response&, std::exception_ptr thrown) {
      thrown_ = std::move(thrown);
    });
  }

  Outgoing respond(Exchange exchange, const std::function<HttpResponse(HttpRequest&)>& answer) {
    exchange_ = &exchange;
    answer_ = &answer;
    reached_ = false;
    thrown_ = nullptr;
    MemoryStream stream(exchange.head);
    bool client_closes = false;
    process_request(stream, exchange.close, client_closes, nullptr);
    if (thrown_) std::rethrow_exception(std::exchange(thrown_, nullptr));
    // The head was checked by stricter rules than cpp-httplib's.
    if (!reached_) throw std::logic_error("cpp-httplib refused a head that was found to be sound");
    Outgoing out{stream.take(), std::exchange(body_, {}), std::exchange(stream_, {}),
                 std::exchange(pieces_, {})};
    if (out.body.size() <= kJoinedBody) out.front += std::exchange(out.body, {});
    return out;
  }

 private:
  Exchange* exchange_ = nullptr;
  const std::function<HttpResponse(HttpRequest&)>* answer_ = nullptr;
  bool reached_ = false;
  std::string body_;
  std::function<void(std::shared_ptr<AnswerStream>)> stream_;
  BodyPieces pieces_;
  bool goes_on_ = false;  // after the head, by one of the two
  std::optional<std::uint64_t> pieces_bytes_;
  bool offers_ranges_ = false;
  std::exception_ptr thrown_;
};

HttpEngine::HttpEngine(const HttpOptions& options) : adapter_(std::make_unique<Adapter>(options)) {}

HttpEngine::~HttpEngine() = default;

HttpEngine::Outgoing HttpEngine::respond(Exchange exchange,
                                         const std::function<HttpResponse(HttpRequest&)>& answer) {
  return adapter_->respond(std::move(exchange), answer);
}

HttpEngine::Outgoing HttpEngine::respond_without_request(std::string_view method, HttpResponse response) {
  const std::string head = method == "HEAD" ? "HEAD / HTTP/1.1\r\n\r\n" : "GET / HTTP/1.1\r\n\r\n";
  return adapter_->respond({head, {}, {}, {}, true},
                           [&](HttpRequest&) -> HttpResponse { return std::move(response); });
}

}  // namespace slipway::server
