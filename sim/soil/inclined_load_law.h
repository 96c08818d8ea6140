#pragma once

#include <cmath>

namespace slipway::sim {

// What is left of the pressure that soil bears under a wheel that skids or moves sideways, whose load is
// inclined:
//
//   p / p_rolling = exp(-a (1 - g)),    g = cos(beta) min(1, r w / |v|)
//
//   a   softening        g   progress by rolling: the way along the wheel's plane that its rim has turned,
//   over the wheel's whole way; 1 for a wheel that rolls or drives straight, 0 locked or straight sideways
//
// That load which is inclined is borne at a fraction is the theory of bearing capacity [Meyerhof 1953; Hansen
// 1970]. There the fraction follows from the inclination; this closure takes it from the motion, which the
// inclination follows (docs/method/wheel.md). Found on the tests of [Pavlov & Johnson 2022], where locked
// wheels and wheels moved sideways bear their load at three times the depth of rolling ones: a = 2.0.
// Properties: 1 at a = 0 and for every wheel that rolls or drives straight; falls with skid and with the slip
// angle; never below exp(-a).
template <class V>
V inclined_load_share(const V& softening, const V& forward, const V& speed) {
  using std::abs, std::exp, std::max;
  // |v_x| / |v| min(1, 1 / |v|), speeds over the rim's.
  const V progress = abs(forward) / (max(speed, V(1e-12)) * max(speed, V(1.0)));
  return exp(-softening * (V(1.0) - progress));
}

}  // namespace slipway::sim
