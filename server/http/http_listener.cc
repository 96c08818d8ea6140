#include "server/http/http_listener.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <httplib.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <system_error>

namespace slipway::server {
namespace {

// cpp-httplib resolves the address and binds; the listening socket is then taken from it, since its accept
// loop hands each connection to a thread, ends for good on some errors of accept(), and has no cap.
class Binder final : public httplib::Server {
 public:
  Binder() {
    // Its default is SO_REUSEPORT: a second server on the same port would start without a word and take half
    // of the first one's clients. SO_REUSEADDR only passes over connections of a server that has ended.
    set_socket_options([](socket_t fd) {
      const int yes = 1;
      setsockopt(fd, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof(yes));
    });
  }

  int bind(const std::string& address, int port) {
    if (port == 0) return bind_to_any_port(address);
    return bind_to_port(address, port) ? port : -1;
  }
  Socket take() { return Socket(svr_sock_.exchange(INVALID_SOCKET)); }
};

// IPv4 as such even when it came through an IPv6 socket, so that one peer has one name.
std::string address_text(const sockaddr_storage& peer) {
  std::array<char, INET6_ADDRSTRLEN> text{};
  if (peer.ss_family == AF_INET) {
    sockaddr_in v4{};
    std::memcpy(&v4, &peer, sizeof(v4));
    inet_ntop(AF_INET, &v4.sin_addr, text.data(), text.size());
  } else if (peer.ss_family == AF_INET6) {
    sockaddr_in6 v6{};
    std::memcpy(&v6, &peer, sizeof(v6));
    inet_ntop(AF_INET6, &v6.sin6_addr, text.data(), text.size());
  }
  const std::string_view whole = text.data();
  constexpr std::string_view kMapped = "::ffff:";
  const bool mapped = whole.starts_with(kMapped) && whole.find('.') != std::string_view::npos;
  return std::string(mapped ? whole.substr(kMapped.size()) : whole);
}

}  // namespace

Result<Listener> listen_at(const HttpOptions& options) {
  if (options.port < 0 || options.port > 65535) {
    return fail(ErrorCode::kInvalidRequest, fmt::format("port = {}, must be in [0, 65535]", options.port));
  }
  Binder binder;
  errno = 0;
  const int port = binder.bind(options.address, options.port);
  const int reason = errno;
  Listener out{binder.take(), port};
  const auto failed = [&](int error) {
    return fail(ErrorCode::kConflict,
                fmt::format("can't listen at {} port {}: {}", options.address, options.port,
                            error == 0 ? "the address is not one of this machine"
                                       : std::system_category().message(error)));
  };
  if (port <= 0 || !out.socket.is_open()) return failed(reason);
  const int fd = out.socket.fd();
  if (::listen(fd, options.listen_backlog) != 0 || fcntl(fd, F_SETFL, O_NONBLOCK) != 0 ||
      fcntl(fd, F_SETFD, FD_CLOEXEC) != 0) {
    return failed(errno);
  }
  return out;
}

AcceptOutcome accept_one(const Socket& listener, Accepted& out) {
  for (;;) {
    sockaddr_storage peer{};
    socklen_t size = sizeof(peer);
    const int fd =
        ::accept4(listener.fd(), reinterpret_cast<sockaddr*>(&peer), &size, SOCK_NONBLOCK | SOCK_CLOEXEC);
    if (fd >= 0) {
      const int yes = 1;
      // With Nagle's delay a request on a kept connection takes 43 ms instead of 0.07.
      setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof(yes));
      out = {Socket(fd), address_text(peer)};
      return AcceptOutcome::kAccepted;
    }
    if (errno == EMFILE || errno == ENFILE || errno == ENOBUFS || errno == ENOMEM) {
      return AcceptOutcome::kNoDescriptors;
    }
    if (errno == EAGAIN || errno == EWOULDBLOCK) return AcceptOutcome::kNobodyWaits;
    // Everything else is the fate of that one connection (accept(2) reports pending network errors), or a
    // signal.
    if (errno == EBADF || errno == EINVAL || errno == ENOTSOCK) return AcceptOutcome::kNobodyWaits;
  }
}

}  // namespace slipway::server
