#include "server/operations/readiness.h"

#include <fmt/format.h>

#include <cstdint>
#include <filesystem>
#include <system_error>
#include <utility>

namespace slipway::server {

ReadinessCheck disk_check(std::vector<std::string> folders) {
  return [folders = std::move(folders)]() -> std::optional<std::string> {
    constexpr std::uintmax_t kNeeded_bytes = 16'000'000;
    for (const std::string& folder : folders) {
      if (folder.empty()) continue;
      std::error_code error;
      const auto space = std::filesystem::space(folder, error);
      if (error) return fmt::format("{} can't be looked at ({}): see to its disk", folder, error.message());
      if (space.available < kNeeded_bytes)
        return fmt::format("the disk of {} is full, {} bytes are left: make room there, or DELETE uploads",
                           folder, space.available);
    }
    return std::nullopt;
  };
}

Readiness::Readiness(std::vector<ReadinessCheck> checks, Options options)
    : checks_(std::move(checks)), options_(options), thread_([this] { watch(); }) {}

Readiness::~Readiness() {
  {
    const std::scoped_lock lock(mutex_);
    stopping_ = true;
  }
  stopped_.notify_all();
  thread_.join();
}

std::optional<std::string> Readiness::reason() const {
  const std::scoped_lock lock(mutex_);
  const auto silent = Clock::now() - looked_;
  if (silent > options_.look_every + options_.longest_look)
    return fmt::format("the store or the disk has not answered for {} s: see to them",
                       std::chrono::duration_cast<std::chrono::seconds>(silent).count());
  return reason_;
}

void Readiness::watch() {
  std::unique_lock lock(mutex_);
  while (!stopping_) {
    lock.unlock();
    std::optional<std::string> found;
    for (const ReadinessCheck& check : checks_)
      if (!found) found = check();
    lock.lock();
    reason_ = std::move(found);
    looked_ = Clock::now();
    stopped_.wait_for(lock, options_.look_every, [&] { return stopping_; });
  }
}

}  // namespace slipway::server
