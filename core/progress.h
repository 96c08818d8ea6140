#pragma once

#include <atomic>
#include <string_view>

namespace slipway {

// How long work reports itself and hears that nobody wants it any more. Thread-safe by contract: report() and
// cancelled() are called from worker threads. Work asks cancelled() at least every 100 ms.
class Progress {
 public:
  virtual ~Progress() = default;
  // stage: a short noun phrase ("proposing routes"); fraction of the whole work that is done, in [0, 1].
  virtual void report(std::string_view stage, double fraction) = 0;
  virtual bool cancelled() const = 0;
};

// For callers that wait and do not look.
class NoProgress final : public Progress {
 public:
  void report(std::string_view /*stage*/, double /*fraction*/) override {}
  bool cancelled() const override { return false; }
};

}  // namespace slipway
