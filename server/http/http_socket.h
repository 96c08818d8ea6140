#pragma once

#include <cstddef>
#include <string_view>

#include "core/file_descriptor.h"

namespace slipway::server {

using Socket = FileDescriptor;

enum class Transfer { kSome, kBlocked, kEnded, kBroken };

// One recv() of at most `size` bytes on a non-blocking socket.
Transfer receive_some(int fd, char* to, std::size_t size, std::size_t& received);

// Sends until all is sent (kSome), or the peer does not take more now (kBlocked), or never will (kBroken).
// What was sent is taken off the front of `bytes`. With `more_follows` the end may be held back until more is
// sent.
Transfer send_some(int fd, std::string_view& bytes, bool more_follows = false);

// Whether the peer has closed the connection, or its direction to us.
bool has_hung_up(int fd);

}  // namespace slipway::server
