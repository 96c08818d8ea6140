#include "core/random.h"

#include <gtest/gtest.h>

#include <cmath>

namespace slipway {
namespace {

TEST(Random, ANumberDependsOnlyOnItsKeyAndCounter) {
  EXPECT_EQ(random_bits(1, 2), random_bits(1, 2));
  EXPECT_NE(random_bits(1, 2), random_bits(1, 3));
  EXPECT_NE(random_bits(1, 2), random_bits(2, 2));
  EXPECT_NE(random_bits(1, 2), random_bits(2, 1));
}

TEST(Random, TheQuantileInvertsTheErrorFunction) {
  for (const double p : {1e-12, 1e-6, 0.01, 0.05, 0.3, 0.5, 0.7, 0.95, 0.999, 1.0 - 1e-9}) {
    const double z = normal_quantile(p);
    EXPECT_NEAR(0.5 * std::erfc(-z / std::sqrt(2.0)) / p, 1.0, 1e-12) << "p = " << p;
  }
}

TEST(Random, NormalsHaveMeanZeroVarianceOneAndNoSkew) {
  constexpr int n = 200'000;
  double sum = 0.0, square = 0.0, cube = 0.0;
  for (int k = 0; k < n; ++k) {
    const double z = random_normal(7, k);
    sum += z;
    square += z * z;
    cube += z * z * z;
  }
  const double error = 5.0 / std::sqrt(n);
  EXPECT_NEAR(sum / n, 0.0, error);
  EXPECT_NEAR(square / n, 1.0, error * std::sqrt(2.0));
  EXPECT_NEAR(cube / n, 0.0, error * std::sqrt(15.0));
}

TEST(Random, NeighbouringCountersAndKeysAreUncorrelated) {
  constexpr int n = 100'000;
  double along_counter = 0.0, along_key = 0.0;
  for (int k = 0; k < n; ++k) {
    along_counter += random_normal(3, k) * random_normal(3, k + 1);
    along_key += random_normal(k, 5) * random_normal(k + 1, 5);
  }
  EXPECT_NEAR(along_counter / n, 0.0, 5.0 / std::sqrt(n));
  EXPECT_NEAR(along_key / n, 0.0, 5.0 / std::sqrt(n));
}

}  // namespace
}  // namespace slipway
