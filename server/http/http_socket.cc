#include "server/http/http_socket.h"

#include <poll.h>
#include <sys/socket.h>

#include <cerrno>

namespace slipway::server {

Transfer receive_some(int fd, char* to, std::size_t size, std::size_t& received) {
  for (;;) {
    const ssize_t n = ::recv(fd, to, size, 0);
    if (n > 0) {
      received = static_cast<std::size_t>(n);
      return Transfer::kSome;
    }
    if (n == 0) return Transfer::kEnded;
    if (errno == EAGAIN || errno == EWOULDBLOCK) return Transfer::kBlocked;
    if (errno != EINTR) return Transfer::kBroken;
  }
}

Transfer send_some(int fd, std::string_view& bytes, bool more_follows) {
  while (!bytes.empty()) {
    // Without MSG_NOSIGNAL a client that has gone would end the whole program.
    const ssize_t n = ::send(fd, bytes.data(), bytes.size(), MSG_NOSIGNAL | (more_follows ? MSG_MORE : 0));
    if (n >= 0) {
      bytes.remove_prefix(static_cast<std::size_t>(n));
      continue;
    }
    if (errno == EAGAIN || errno == EWOULDBLOCK) return Transfer::kBlocked;
    if (errno != EINTR) return Transfer::kBroken;
  }
  return Transfer::kSome;
}

bool has_hung_up(int fd) {
  pollfd asked{fd, POLLRDHUP, 0};
  return ::poll(&asked, 1, 0) > 0;
}

}  // namespace slipway::server
