#include "core/utc.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <chrono>
#include <ctime>

namespace slipway {

std::string utc_text(std::int64_t ms) {
  constexpr std::int64_t kPerSecond = 1000;
  const auto seconds = static_cast<std::time_t>(ms / kPerSecond);
  return fmt::format("{:%Y-%m-%dT%H:%M:%S}.{:03}Z", fmt::gmtime(seconds), ms % kPerSecond);
}

std::int64_t now_ms() {
  using std::chrono::system_clock;
  return std::chrono::duration_cast<std::chrono::milliseconds>(system_clock::now().time_since_epoch())
      .count();
}

}  // namespace slipway
