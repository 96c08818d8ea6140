#pragma once

#include <string>
#include <utility>

#include "core/progress.h"

namespace slipway::planner {

// A part of the whole work that reports under one name, as [from, to] of the whole.
class StageProgress final : public Progress {
 public:
  StageProgress(Progress& whole, std::string stage, double from, double to)
      : whole_(whole), stage_(std::move(stage)), from_(from), to_(to) {
    whole_.report(stage_, from_);
  }
  void report(std::string_view /*stage*/, double fraction) override {
    whole_.report(stage_, from_ + (to_ - from_) * fraction);
  }
  bool cancelled() const override { return whole_.cancelled(); }
  void found(const RouteSoFar& route) override { whole_.found(route); }

 private:
  Progress& whole_;
  std::string stage_;
  double from_, to_;
};

}  // namespace slipway::planner
