#pragma once

#include <array>

namespace slipway::sim {

constexpr int kArcNodes = 8;

// Gauss-Legendre with 8 points on s in [0, 1], taken to t = s^2: the integral over t in [0, 1] of a function
// is the sum of its values at `node` by `weight`. Smooth where sigma ~ z^n is not.
struct ArcQuadrature {
  alignas(64) std::array<double, kArcNodes> node;
  alignas(64) std::array<double, kArcNodes> weight;
};

constexpr ArcQuadrature make_arc_quadrature() {
  constexpr std::array<double, 4> x{0.1834346424956498049394761, 0.5255324099163289858177390,
                                    0.7966664774136267395915539, 0.9602898564975362316835609};
  constexpr std::array<double, 4> w{0.3626837833783619829651504, 0.3137066458778872873379622,
                                    0.2223810344533744705443560, 0.1012285362903762591525314};
  ArcQuadrature q{};
  for (int k = 0; k < 4; ++k) {
    for (const int sign : {-1, 1}) {
      const int at = sign < 0 ? 3 - k : 4 + k;
      const double s = 0.5 * (1.0 + sign * x[k]);
      q.node[at] = s * s;
      q.weight[at] = s * w[k];  // 2 s times the half of the interval's length
    }
  }
  return q;
}

inline constexpr ArcQuadrature kArcQuadrature = make_arc_quadrature();

}  // namespace slipway::sim
