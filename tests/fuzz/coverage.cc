#include "coverage.h"

namespace slipway::fuzz {
std::array<std::uint8_t, kCoveragePlaces> coverage{};
}  // namespace slipway::fuzz

// The compiler calls this at every branch of what it compiles with -fsanitize-coverage=trace-pc. It must not
// be instrumented itself, and several threads may call it: a lost count does no harm. Its name is the
// compiler's.

// NOLINTBEGIN(bugprone-reserved-identifier)
extern "C" __attribute__((no_sanitize("address", "thread", "undefined"))) void __sanitizer_cov_trace_pc();
extern "C" void __sanitizer_cov_trace_pc() {
  const auto place = reinterpret_cast<std::uintptr_t>(__builtin_return_address(0));
  std::uint8_t& count =
      slipway::fuzz::coverage[((place >> 4U) ^ (place >> 19U) ^ place) % slipway::fuzz::kCoveragePlaces];
  if (count < 255) ++count;
}
// NOLINTEND(bugprone-reserved-identifier)
