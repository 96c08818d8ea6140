#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

namespace slipway::gap_benchmark {

// Random numbers whose distributions are written out, so that every standard library draws the same.
class RandomStream {
 public:
  explicit RandomStream(std::uint64_t seed) : engine_(seed * 0x9E3779B97F4A7C15ULL + 0xD1B54A32D192ED03ULL) {}

  double uniform() { return (static_cast<double>(engine_() >> 11) + 0.5) * 0x1.0p-53; }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  double normal() {  // Box and Muller
    const double radius = std::sqrt(-2.0 * std::log(uniform()));
    return radius * std::cos(2.0 * std::numbers::pi * uniform());
  }
  static constexpr double kBoundedVariance = 0.774;  // of the following
  // A normal one no further out than two deviations.
  double bounded() {
    double x = normal();
    while (std::abs(x) > 2.0) x = normal();
    return x;
  }
  std::size_t below(std::size_t count) { return static_cast<std::size_t>(engine_() % count); }
  std::uint64_t seed() { return engine_(); }

 private:
  std::mt19937_64 engine_;
};

}  // namespace slipway::gap_benchmark
