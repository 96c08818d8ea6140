#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace slipway::server {

// Why the service can't take work, as something looks at it: one sentence with a remedy; nothing where it
// can.
using ReadinessCheck = std::function<std::optional<std::string>()>;

// No room is left for jobs and files on the disk of one of these folders; an empty one is passed over.
ReadinessCheck disk_check(std::vector<std::string> folders);

// Looks again and again whether the service can take work, in a thread of its own, so that who asks waits for
// no store. A look that does not end is a reason too. Thread-safe.
class Readiness {
 public:
  struct Options {
    std::chrono::milliseconds look_every{500};
    std::chrono::milliseconds longest_look{2000};
  };
  explicit Readiness(std::vector<ReadinessCheck> checks) : Readiness(std::move(checks), Options()) {}
  Readiness(std::vector<ReadinessCheck> checks, Options options);
  ~Readiness();
  Readiness(const Readiness&) = delete;
  Readiness& operator=(const Readiness&) = delete;

  // Nothing: it can take work.
  std::optional<std::string> reason() const;

 private:
  using Clock = std::chrono::steady_clock;
  void watch();

  const std::vector<ReadinessCheck> checks_;
  const Options options_;
  mutable std::mutex mutex_;
  std::condition_variable stopped_;
  bool stopping_ = false;
  std::optional<std::string> reason_ = "the service has just started: ask again";
  Clock::time_point looked_ = Clock::now();  // when the last look ended
  std::thread thread_;
};

}  // namespace slipway::server
