#pragma once

#include <optional>
#include <string>

#include "core/result.h"
#include "server/http/http_options.h"
#include "server/http/http_socket.h"

namespace slipway::server {

struct Listener {
  Socket socket;  // non-blocking
  int port = 0;
};

// Binds and listens, or says why not.
Result<Listener> listen_at(const HttpOptions& options);

struct Accepted {
  Socket socket;  // non-blocking, without Nagle's delay
  std::string address;
};

enum class AcceptOutcome { kAccepted, kNobodyWaits, kNoDescriptors };

// One waiting connection, if there is one.
AcceptOutcome accept_one(const Socket& listener, Accepted& out);

}  // namespace slipway::server
