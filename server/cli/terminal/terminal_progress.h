#pragma once

#include <atomic>
#include <string_view>

#include "core/progress.h"

namespace slipway::server {

// Stage and share on one line of a terminal; nothing where standard error is a file. Given up when
// interrupt() is called.
class TerminalProgress final : public Progress {
 public:
  TerminalProgress();
  ~TerminalProgress() override;
  TerminalProgress(const TerminalProgress&) = delete;
  TerminalProgress& operator=(const TerminalProgress&) = delete;
  void report(std::string_view stage, double fraction) override;
  bool cancelled() const override;

 private:
  const bool terminal_;
  std::atomic<bool> shown_{false};
};

}  // namespace slipway::server
