#include "core/boot_clock.h"

#include <ctime>
#include <fstream>

namespace slipway {

std::int64_t boot_ms() {
  timespec now{};
  ::clock_gettime(CLOCK_BOOTTIME, &now);
  constexpr std::int64_t kPerSecond = 1000, kNanoseconds = 1'000'000;
  return now.tv_sec * kPerSecond + now.tv_nsec / kNanoseconds;
}

std::string boot_id() {
  std::ifstream file("/proc/sys/kernel/random/boot_id");
  std::string id;
  std::getline(file, id);
  return id;
}

}  // namespace slipway
