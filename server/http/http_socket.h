#pragma once

#include <unistd.h>

#include <cstddef>
#include <string_view>
#include <utility>

namespace slipway::server {

// Owns a file descriptor.
class Socket {
 public:
  Socket() = default;
  explicit Socket(int fd) : fd_(fd) {}
  Socket(Socket&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  Socket& operator=(Socket&& other) noexcept {
    std::swap(fd_, other.fd_);
    return *this;
  }
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;
  ~Socket() { close(); }

  int fd() const { return fd_; }
  bool is_open() const { return fd_ >= 0; }
  void close() {
    if (fd_ >= 0) ::close(std::exchange(fd_, -1));
  }

 private:
  int fd_ = -1;
};

enum class Transfer { kSome, kBlocked, kEnded, kBroken };

// One recv() of at most `size` bytes on a non-blocking socket.
Transfer receive_some(int fd, char* to, std::size_t size, std::size_t& received);

// Sends until all is sent (kSome), or the peer does not take more now (kBlocked), or never will (kBroken).
// What was sent is taken off the front of `bytes`. With `more_follows` the end may be held back until more is
// sent.
Transfer send_some(int fd, std::string_view& bytes, bool more_follows = false);

}  // namespace slipway::server
