#pragma once

namespace slipway::api {

// What a commit survives. kQuick: the death of the process that made it. kDurable: a loss of power too, and,
// of a database server that has one, the loss of the primary for a synchronous standby; it waits for both.
enum class CommitKind { kQuick, kDurable };

}  // namespace slipway::api
