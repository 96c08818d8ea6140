#include "core/process_limits.h"

#include <sys/resource.h>

namespace slipway {

void limit_memory([[maybe_unused]] double max_bytes) {
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
  const auto most = static_cast<rlim_t>(max_bytes);
  const rlimit limits{most, most};
  ::setrlimit(RLIMIT_AS, &limits);
#endif
}

void leave_no_core() {
  const rlimit none{0, 0};
  ::setrlimit(RLIMIT_CORE, &none);
}

}  // namespace slipway
