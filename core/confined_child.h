#pragma once

#include <functional>
#include <string>

#include "core/progress.h"
#include "core/result.h"

namespace slipway {

// What a child process may use.
struct ChildLimits {
  long long max_memory_bytes = 4LL << 30U;  // of address space
  double max_time_s = 1800.0;               // by the clock, kept by the parent; and of each core
};

// Does `work` in a child process with these limits and, where the system allows it, without network: a file
// from outside that makes a library crash or grow takes nobody with it. The child's progress is told to
// `progress`, and where that is cancelled the child is killed. What the child wrote to disk is the caller's
// to remove where this fails. Only for a process with one thread, since the others would not be in the child.
// Errors: those of `work`; payload_too_large where a limit is reached; cancelled; internal where the child
// ends by itself.
Result<std::string> run_confined(const ChildLimits& limits,
                                 const std::function<Result<std::string>(Progress&)>& work,
                                 Progress& progress);

}  // namespace slipway
