#include "planner/search/slip_table_cache.h"

#include <gtest/gtest.h>

#include "tests/planner/plan_fixture.h"

namespace slipway::planner {
namespace {

void expect_the_same(const sim::SlipTable& a, const sim::SlipTable& b) {
  for (double pitch = -0.4; pitch <= 0.4; pitch += 0.037) {
    for (double roll = -0.4; roll <= 0.4; roll += 0.041) {
      const auto of_a = a.at(pitch, roll), of_b = b.at(pitch, roll);
      ASSERT_EQ(of_a.has_value(), of_b.has_value());
      if (!of_a) continue;
      EXPECT_EQ(of_a->slip_ratio, of_b->slip_ratio);
      EXPECT_EQ(of_a->energy_j_m, of_b->energy_j_m);
      EXPECT_EQ(of_a->sinkage_m, of_b->sinkage_m);
      EXPECT_EQ(of_a->current_a, of_b->current_a);
    }
  }
}

TEST(SlipTableCache, GivesWhatTheKeyMakesHoweverOftenAndWhateverIsKept) {
  SlipTableCache cache;
  SlipTableKey key{.rover = *test_rover(),
                   .gravity_m_s2 = 3.71,
                   .soil = firm_soil("firm").mean,
                   .limit_rad = 0.4,
                   .step_rad = 0.1,
                   .conditions = {}};
  expect_the_same(cache.get(key), key.make());
  expect_the_same(cache.get(key), key.make());
  SlipTableKey other = key;
  other.soil.cohesion_pa *= 0.5;
  EXPECT_FALSE(other == key);
  expect_the_same(cache.get(other), other.make());
  other = key;
  other.rover.mass_kg *= 1.1;
  EXPECT_FALSE(other == key);
  expect_the_same(cache.get(other), other.make());
  other = key;
  other.conditions.motor_temp_c = -60.0;
  EXPECT_FALSE(other == key);
}

}  // namespace
}  // namespace slipway::planner
