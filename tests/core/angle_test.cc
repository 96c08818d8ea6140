#include "core/angle.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/random.h"

namespace slipway {
namespace {

double by_remainder(double rad) {
  const double r = std::remainder(rad, 2.0 * std::numbers::pi);
  return r <= -std::numbers::pi ? std::numbers::pi : r;
}

void expect_the_same_bits(double rad) {
  EXPECT_EQ(wrapped_rad(rad), by_remainder(rad)) << rad;
  EXPECT_EQ(std::signbit(wrapped_rad(rad)), std::signbit(by_remainder(rad))) << rad;
}

TEST(WrappedRad, IsTheExactRemainderToTheLastBit) {
  for (std::uint64_t i = 0; i < 100'000; ++i) {
    expect_the_same_bits(20.0 * (random_uniform(1, i) - 0.5));
    expect_the_same_bits(1e6 * (random_uniform(2, i) - 0.5));
  }
  for (int halves = -8; halves <= 8; ++halves) {
    const double at = halves * std::numbers::pi;
    for (const double rad : {at, std::nextafter(at, 100.0), std::nextafter(at, -100.0)})
      expect_the_same_bits(rad);
  }
  EXPECT_TRUE(std::isnan(wrapped_rad(std::numeric_limits<double>::quiet_NaN())));
}

}  // namespace
}  // namespace slipway
