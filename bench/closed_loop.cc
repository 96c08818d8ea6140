// Clients that ask again as soon as they are answered: how many requests a second a running service takes.
//
//   closed_loop PORT PATH ETAG CONNECTIONS SECONDS
//
// Each kept connection asks GET PATH with If-None-Match: ETAG. All are one thread over epoll, so that the
// service has the rest of the machine. Prints one JSON line; status 1 where an answer was neither 200 nor
// 304.
#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/epoll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <iostream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/file_descriptor.h"

namespace {

using Clock = std::chrono::steady_clock;
using slipway::FileDescriptor;

FileDescriptor connect_to(int port) {
  FileDescriptor socket(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  const int yes = 1;
  ::setsockopt(socket.fd(), IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
  if (::connect(socket.fd(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
    socket.close();
  return socket;
}

// The size of the first answer in the bytes, 0 where it is not whole.
std::size_t answer_size(std::string_view bytes) {
  const std::size_t end = bytes.find("\r\n\r\n");
  if (end == std::string_view::npos) return 0;
  constexpr std::string_view kLength = "Content-Length: ";
  const std::size_t at = bytes.substr(0, end).find(kLength);
  std::size_t length = 0;
  if (at != std::string_view::npos && !bytes.starts_with("HTTP/1.1 304"))
    std::from_chars(bytes.data() + at + kLength.size(), bytes.data() + end, length);
  return bytes.size() < end + 4 + length ? 0 : end + 4 + length;
}

struct Client {
  FileDescriptor socket;
  std::string received;
  Clock::time_point asked;
};

class Load {
 public:
  Load(int port, std::string request)
      : port_(port), request_(std::move(request)), epoll_(::epoll_create1(EPOLL_CLOEXEC)) {}

  bool open(std::size_t connections) {
    clients_.resize(connections);
    return std::all_of(clients_.begin(), clients_.end(), [this](Client& client) { return begin(client); });
  }

  void run(std::chrono::duration<double> time) {
    const auto until = Clock::now() + std::chrono::duration_cast<Clock::duration>(time);
    std::array<epoll_event, 64> events{};
    while (Clock::now() < until && !lost_) {
      const int count = ::epoll_wait(epoll_.fd(), events.data(), static_cast<int>(events.size()), 100);
      for (int k = 0; k < count; ++k) take(clients_[events[static_cast<std::size_t>(k)].data.u64]);
    }
  }

  // Of all answers [ms], unsorted.
  std::vector<double>& taken_ms() { return taken_ms_; }
  int errors() const { return errors_ + (lost_ ? 1 : 0); }

 private:
  bool begin(Client& client) {
    client.socket = connect_to(port_);
    client.received.clear();
    epoll_event event{};
    event.events = EPOLLIN;
    event.data.u64 = static_cast<std::uint64_t>(&client - clients_.data());
    return client.socket.is_open() &&
           ::epoll_ctl(epoll_.fd(), EPOLL_CTL_ADD, client.socket.fd(), &event) == 0 && ask(client);
  }

  bool ask(Client& client) {
    client.asked = Clock::now();
    return ::send(client.socket.fd(), request_.data(), request_.size(), MSG_NOSIGNAL) ==
           static_cast<ssize_t>(request_.size());
  }

  void take(Client& client) {
    std::array<char, 16384> piece{};
    const ssize_t count = ::recv(client.socket.fd(), piece.data(), piece.size(), 0);
    if (count <= 0) {  // the service closes a connection after so many requests
      lost_ = !begin(client);
      return;
    }
    client.received.append(piece.data(), static_cast<std::size_t>(count));
    const std::size_t size = answer_size(client.received);
    if (size == 0) return;
    const std::string_view answer = client.received;
    errors_ += answer.starts_with("HTTP/1.1 304") || answer.starts_with("HTTP/1.1 200") ? 0 : 1;
    taken_ms_.push_back(std::chrono::duration<double, std::milli>(Clock::now() - client.asked).count());
    const bool closes = answer.substr(0, size).find("Connection: close") != std::string_view::npos;
    client.received.erase(0, size);
    if (closes)
      lost_ = !begin(client);
    else
      lost_ = !ask(client);
  }

  const int port_;
  const std::string request_;
  const FileDescriptor epoll_;
  std::vector<Client> clients_;
  std::vector<double> taken_ms_;
  int errors_ = 0;
  bool lost_ = false;
};

}  // namespace

int main(int argc, char** argv) {
  if (argc != 6) {
    std::cerr << "usage: closed_loop PORT PATH ETAG CONNECTIONS SECONDS\n";
    return 2;
  }
  const int connections = std::atoi(argv[4]);
  const double seconds = std::atof(argv[5]);
  Load load(std::atoi(argv[1]),
            fmt::format("GET {} HTTP/1.1\r\nHost: 127.0.0.1\r\nIf-None-Match: {}\r\n\r\n", argv[2], argv[3]));
  if (!load.open(static_cast<std::size_t>(connections))) {
    std::cerr << "the service takes no connection\n";
    return 1;
  }
  load.run(std::chrono::duration<double>(seconds));
  std::vector<double>& taken = load.taken_ms();
  std::sort(taken.begin(), taken.end());
  if (taken.empty()) return 1;
  std::cout << fmt::format(
      "{{\"connections\":{},\"seconds\":{},\"answered\":{},\"per_s\":{:.0f},\"errors\":{},\"p50_ms\":{:.2f},"
      "\"p99_ms\":{:.2f},\"longest_ms\":{:.1f}}}\n",
      connections, seconds, taken.size(), static_cast<double>(taken.size()) / seconds, load.errors(),
      taken[taken.size() / 2], taken[taken.size() * 99 / 100], taken.back());
  return load.errors() == 0 ? 0 : 1;
}
