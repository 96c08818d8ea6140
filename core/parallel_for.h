#pragma once

#include <cstddef>
#include <functional>

namespace slipway {

// Calls body(i) for every i in [0, count), on up to `threads` threads; 0 takes as many as the machine has.
// The order is not defined, so that a body may write only to data of its own i; the outcome then does not
// depend on the number of threads. An exception in a body is rethrown to the caller after all threads have
// ended.
void parallel_for(std::size_t count, std::size_t threads, const std::function<void(std::size_t)>& body);

}  // namespace slipway
