#pragma once

namespace slipway::server {

// From a signal handler: the running question is given up.
void interrupt();
// Whether interrupt() was called.
bool given_up();

}  // namespace slipway::server
