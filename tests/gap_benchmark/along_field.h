#pragma once

#include <array>
#include <cmath>
#include <numbers>

#include "random_stream.h"

namespace slipway::gap_benchmark {

// A smooth random field along the way: a few cosines.
class AlongField {
 public:
  AlongField(RandomStream& random, double length_m) {
    for (Part& part : parts_)
      part = {2.0 * std::numbers::pi / (length_m * random.uniform(1.5, 6.0)),
              random.uniform(0.0, 2.0 * std::numbers::pi)};
  }
  double at(double s_m) const {  // of unit deviation
    double sum = 0.0;
    for (const Part& part : parts_) sum += std::cos(part.wavenumber * s_m + part.phase);
    return sum * std::sqrt(2.0 / parts_.size());
  }

 private:
  struct Part {
    double wavenumber = 0.0, phase = 0.0;
  };
  std::array<Part, 4> parts_;
};

}  // namespace slipway::gap_benchmark
