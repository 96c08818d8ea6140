#pragma once

#include <atomic>
#include <string_view>

namespace slipway {

// Through this a long computation reports its progress and learns that it was cancelled. Implementations must
// be thread-safe, since worker threads call report() and cancelled(). A computation asks cancelled() at least
// every 100 ms.
class Progress {
 public:
  virtual ~Progress() = default;
  // stage is a short phrase ("proposing routes"); fraction is the share of the whole work that is done, in
  // [0, 1].
  virtual void report(std::string_view stage, double fraction) = 0;
  virtual bool cancelled() const = 0;
};

// For callers that need no reports and never cancel.
class NoProgress final : public Progress {
 public:
  void report(std::string_view /*stage*/, double /*fraction*/) override {}
  bool cancelled() const override { return false; }
};

}  // namespace slipway
