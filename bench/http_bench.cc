// The cost of a request over 127.0.0.1 with a handler that does nothing. Client and server share the
// machine's cores.

#include <arpa/inet.h>
#include <benchmark/benchmark.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <chrono>
#include <stdexcept>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "server/http/http_server.h"

namespace {

using slipway::server::HttpOptions;
using slipway::server::HttpRequest;
using slipway::server::HttpResponse;
using slipway::server::HttpServer;

constexpr std::string_view kGet = "GET /healthz HTTP/1.1\r\nHost: bench\r\nAccept: application/json\r\n\r\n";
constexpr std::string_view kBody = R"({"status":"well"})";

class Connection {
 public:
  explicit Connection(int port) : fd_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    const int yes = 1;
    setsockopt(fd_, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof(yes));
    if (::connect(fd_, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) != 0) {
      throw std::runtime_error("can't connect");
    }
  }
  Connection(Connection&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;
  Connection& operator=(Connection&&) = delete;
  ~Connection() {
    if (fd_ >= 0) ::close(fd_);
  }

  // True when a whole answer of status 200 came.
  bool ask() {
    if (::send(fd_, kGet.data(), kGet.size(), MSG_NOSIGNAL) != static_cast<ssize_t>(kGet.size()))
      return false;
    std::array<char, 2048> piece;
    std::size_t size = 0;
    while (size < piece.size()) {
      const ssize_t n = ::recv(fd_, piece.data() + size, piece.size() - size, 0);
      if (n <= 0) return false;
      size += static_cast<std::size_t>(n);
      const std::string_view answer(piece.data(), size);
      if (answer.ends_with(kBody)) return answer.starts_with("HTTP/1.1 200");
    }
    return false;
  }

 private:
  int fd_;
};

class BenchServer {
 public:
  BenchServer()
      : server_(options(), {{"GET", "/healthz", [](const HttpRequest&) {
                               return HttpResponse{200, "application/json", std::string(kBody), {}};
                             }}}) {
    port_ = server_.start().value();
  }
  int port() const { return port_; }

 private:
  static HttpOptions options() {
    HttpOptions out;
    out.max_connections_per_address = out.max_connections;
    out.max_requests_per_connection = 100'000'000;
    return out;
  }

  HttpServer server_;
  int port_ = 0;
};

// The time that one client waits for an answer, with one request at a time, while other connections are open.
void one_client(benchmark::State& state) {
  const BenchServer server;
  std::vector<Connection> idle;
  for (int64_t i = 0; i < state.range(0); ++i) {
    idle.emplace_back(server.port());
    if (!idle.back().ask()) return state.SkipWithError("an idle connection got no answer");
  }
  Connection connection(server.port());
  for (auto _ : state) {
    if (!connection.ask()) return state.SkipWithError("no answer");
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(one_client)
    ->ArgName("idle_connections")
    ->Arg(0)
    ->Arg(200)
    ->UseRealTime()
    ->Unit(benchmark::kMicrosecond);

// Kept connections that each send the next request as soon as they are answered.
void many_clients(benchmark::State& state) {
  const BenchServer server;
  const auto count = static_cast<std::size_t>(state.range(0));
  constexpr int kEach = 2'000;
  std::atomic<bool> failed = false;
  for (auto _ : state) {
    state.PauseTiming();
    std::vector<Connection> connections;
    for (std::size_t i = 0; i < count; ++i) connections.emplace_back(server.port());
    std::vector<std::thread> clients;
    state.ResumeTiming();
    for (Connection& connection : connections) {
      clients.emplace_back([&] {
        for (int i = 0; i < kEach; ++i) {
          if (!connection.ask()) failed = true;
        }
      });
    }
    for (std::thread& client : clients) client.join();
  }
  if (failed) state.SkipWithError("a request got no answer");
  state.SetItemsProcessed(state.iterations() * static_cast<int64_t>(count) * kEach);
}
BENCHMARK(many_clients)
    ->ArgName("connections")
    ->Arg(8)
    ->Arg(64)
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

// A new connection for each request, as from a client without keep-alive.
void new_connection(benchmark::State& state) {
  const BenchServer server;
  for (auto _ : state) {
    Connection connection(server.port());
    if (!connection.ask()) return state.SkipWithError("no answer");
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(new_connection)->UseRealTime()->Unit(benchmark::kMicrosecond);

}  // namespace

BENCHMARK_MAIN();
