#pragma once

#include "core/progress.h"

namespace slipway {

// The progress of a part of some work, which takes the whole from one fraction to another. The whole must
// outlive it. What is found is not passed on: a part's is not the whole's.
class PartOfProgress final : public Progress {
 public:
  PartOfProgress(Progress& whole, double begin, double end) : whole_(whole), begin_(begin), end_(end) {}
  void report(std::string_view stage, double fraction) override {
    whole_.report(stage, begin_ + (end_ - begin_) * fraction);
  }
  bool cancelled() const override { return whole_.cancelled(); }

 private:
  Progress& whole_;
  double begin_, end_;
};

}  // namespace slipway
