#include "raw_client.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <stdexcept>
#include <thread>
#include <utility>

#include "server/http/http_chunked.h"

namespace slipway::server {

using Clock = std::chrono::steady_clock;

RawClient::RawClient(int port) : fd_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  const int yes = 1;
  setsockopt(fd_, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof(yes));
  const timeval patience{5, 0};
  setsockopt(fd_, SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof(patience));
  if (::connect(fd_, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) != 0) {
    ::close(std::exchange(fd_, -1));
  }
}

RawClient::~RawClient() {
  if (fd_ >= 0) ::close(fd_);
}

RawClient::RawClient(RawClient&& other) noexcept
    : fd_(std::exchange(other.fd_, -1)), input_(std::move(other.input_)) {}

bool RawClient::send(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t n = ::send(fd_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (n <= 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(n));
  }
  return true;
}

void RawClient::finish_sending() {
  ::shutdown(fd_, SHUT_WR);
}

bool RawClient::receive(Clock::time_point until) {
  const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(until - Clock::now()).count();
  pollfd poller{fd_, POLLIN, 0};
  if (left <= 0 || ::poll(&poller, 1, static_cast<int>(left)) <= 0) return false;
  std::array<char, 65536> piece;
  const ssize_t n = ::recv(fd_, piece.data(), piece.size(), 0);
  if (n <= 0) return false;
  input_.append(piece.data(), static_cast<std::size_t>(n));
  return true;
}

RawClient::Answer RawClient::read_answer(bool to_head_request, std::chrono::milliseconds patience) {
  const auto until = Clock::now() + patience;
  std::size_t end = 0;
  while ((end = input_.find("\r\n\r\n")) == std::string::npos) {
    if (!receive(until)) return {};
  }
  Answer answer;
  answer.head = input_.substr(0, end + 4);
  input_.erase(0, end + 4);
  const int status = std::stoi(answer.head.substr(answer.head.find(' ') + 1));
  const std::string length = answer.header("Content-Length");
  if (!to_head_request && !length.empty()) {
    const std::size_t size = std::stoul(length);
    while (input_.size() < size) {
      if (!receive(until)) return {};
    }
    answer.body = input_.substr(0, size);
    input_.erase(0, size);
  } else if (!to_head_request && answer.header("Transfer-Encoding") == "chunked") {
    ChunkedBody chunks(std::size_t{64} << 20);
    for (auto state = ChunkedBody::State::kMore; state != ChunkedBody::State::kDone;) {
      std::string_view bytes = input_;
      state = chunks.feed(bytes, answer.body);
      input_.erase(0, input_.size() - bytes.size());
      if (state == ChunkedBody::State::kDone) break;
      if (state != ChunkedBody::State::kMore || !receive(until)) return {};
    }
  }
  answer.status = status;
  return answer;
}

RawClient::Answer RawClient::ask(std::string_view request) {
  send(request);
  return read_answer(request.starts_with("HEAD "));
}

std::string RawClient::read_some(std::chrono::milliseconds patience) {
  receive(Clock::now() + patience);
  return std::exchange(input_, {});
}

std::string RawClient::read_rest(std::chrono::milliseconds patience) {
  for (const auto until = Clock::now() + patience; receive(until);) {
  }
  return std::exchange(input_, {});
}

bool RawClient::closed_within(std::chrono::milliseconds patience) {
  const auto until = Clock::now() + patience;
  while (receive(until)) {
  }
  return Clock::now() < until;
}

std::string RawClient::Answer::header(std::string_view name) const {
  std::string_view rest = head;
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find("\r\n"), rest.size());
    const std::string_view line = rest.substr(0, end);
    rest.remove_prefix(std::min(end + 2, rest.size()));
    const std::size_t colon = line.find(':');
    if (colon == std::string_view::npos || !equal_ignoring_case(line.substr(0, colon), name)) continue;
    return std::string(line.substr(std::min(line.find_first_not_of(' ', colon + 1), line.size())));
  }
  return {};
}

RawClient::Answer ask_once(int port, std::string_view request) {
  return RawClient(port).ask(request);
}

std::string get(std::string_view target, std::string_view more_headers) {
  return fmt::format("GET {} HTTP/1.1\r\nHost: test\r\n{}\r\n", target, more_headers);
}

std::string post(std::string_view target, std::string_view body, std::string_view more_headers) {
  return fmt::format(
      "POST {} HTTP/1.1\r\nHost: test\r\nContent-Type: application/json\r\nContent-Length: {}\r\n{}\r\n{}",
      target, body.size(), more_headers, body);
}

HttpResponse test_problem(const Error& error, const HttpRequest* request) {
  const ErrorRow& row = error_row(error.code);
  return {row.http_status,
          "application/problem+json",
          fmt::format(R"({{"type":"/errors#{}","status":{},"detail":"{}","instance":"{}"}})", row.name,
                      row.http_status, error.detail, request != nullptr ? request->path : ""),
          {}};
}

namespace {

HttpResponse text(std::string body) {
  return {200, "text/plain", std::move(body), {}};
}

std::vector<Route> test_routes() {
  return {
      {"GET", "/healthz", [](const HttpRequest&) { return text("well"); }},
      {"POST", "/echo", [](const HttpRequest& r) { return text(r.body); }},
      {"GET", "/jobs/{id}",
       [](const HttpRequest& r) { return text("job " + std::string(r.parameter("id"))); }},
      {"DELETE", "/jobs/{id}",
       [](const HttpRequest&) {
         return HttpResponse{204, "", "", {}};
       }},
      {"GET", "/peer",
       [](const HttpRequest& r) {
         return text(r.remote_address + "|" + r.header("REMOTE_ADDR").value_or("none"));
       }},
      {"GET", "/query",
       [](const HttpRequest& r) {
         std::string all;
         for (const auto& [name, value] : r.query) all += name + "=" + value + ";";
         return text(all);
       }},
      {"GET", "/header/{name}",
       [](const HttpRequest& r) { return text(r.header(r.parameter("name")).value_or("none")); }},
      {"GET", "/large", [](const HttpRequest&) { return text(std::string(std::size_t{8} << 20, 'x')); }},
      {"GET", "/pieces/{count}",
       [](const HttpRequest& r) {
         HttpResponse response = text("");
         response.pieces = [next = 0, count = std::stoi(std::string(r.parameter(
                                          "count")))]() mutable -> Result<std::optional<std::string>> {
           if (next == count) return std::nullopt;
           if (count > 1000 && next == 100) return fail(ErrorCode::kStorage, "it can't be read any more");
           const std::size_t size = next % 3 == 1 ? 0 : 100'000;
           return std::string(size, static_cast<char>('a' + next++ % 26));
         };
         return response;
       }},
      {"GET", "/counted",  // three pieces, whose length is known before
       [](const HttpRequest&) {
         HttpResponse response = text("");
         response.headers.emplace_back("Accept-Ranges", "bytes");
         response.pieces_bytes = 300'000;
         response.pieces = [next = 0]() mutable -> Result<std::optional<std::string>> {
           if (next == 3) return std::nullopt;
           return std::string(100'000, static_cast<char>('a' + next++));
         };
         return response;
       }},
      {"GET", "/megabyte", [](const HttpRequest&) { return text(std::string(std::size_t{1} << 20, 'x')); }},
      {"GET", "/slow",
       [](const HttpRequest&) {
         std::this_thread::sleep_for(std::chrono::milliseconds(300));
         return text("at last");
       }},
      {"GET", "/throws",
       [](const HttpRequest&) -> HttpResponse { throw std::runtime_error("the password is swordfish"); }},
      {"GET", "/throws_int", [](const HttpRequest&) -> HttpResponse { throw 42; }},
      {"GET", "/splits",
       [](const HttpRequest&) {
         HttpResponse r = text("ok");
         r.headers = {{"X-Evil", "a\r\nX-Injected: 1"}, {"Content-Length", "99"}, {"X-Good", "1"}};
         return r;
       }},
      {"GET", "/refuses",
       [](const HttpRequest& r) {
         return test_problem({ErrorCode::kOffMap, "off the map by 3 m", {}}, &r);
       }},
  };
}

HttpOptions with_problem(HttpOptions options) {
  if (!options.problem) options.problem = test_problem;
  if (!options.log) options.log = [](std::string_view) {};
  return options;
}

}  // namespace

TestServer::TestServer(HttpOptions options) : server(with_problem(std::move(options)), test_routes()) {
  const auto started = server.start();
  if (!started) throw std::runtime_error(started.error().detail);
  port = *started;
}

std::size_t resident_kib() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with("VmRSS:")) return std::stoul(line.substr(6));
  }
  return 0;
}

}  // namespace slipway::server
