// The soils that one place may have: as likely as DrawnGround draws them.
#include "sim/prediction/likely_soils.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "core/random.h"
#include "tests/sim/reference_models.h"

namespace slipway::sim {
namespace {

SoilDistribution either(const SoilDistribution& strong, const SoilDistribution& weak, double weak_share) {
  SoilDistribution belief = strong;
  belief.name = "either";
  for (const auto& [soil, weight] : {std::pair{strong, 1.0 - weak_share}, std::pair{weak, weak_share}})
    belief.alternatives.push_back(
        {soil.name, std::make_shared<const SoilDistribution>(soil), weight, weight});
  return belief;
}

double share_with_friction_below(const std::vector<LikelySoil>& soils, double angle_rad) {
  double below = 0.0, all = 0.0;
  for (const LikelySoil& each : soils) {
    all += each.weight;
    if (each.soil.friction_angle_rad < angle_rad) below += each.weight;
  }
  return below / all;
}

TEST(LikelySoils, AnAlternativeHasItsShareOfTheRows) {
  Soil weak = sandy_loam();
  weak.friction_angle_rad = 0.2;
  const SoilDistribution belief = either(certain("strong", sandy_loam()), certain("weak", weak), 0.15);
  EXPECT_NEAR(share_with_friction_below(likely_soils(belief, 40, {}), 0.3), 0.15, 1e-9);
}

TEST(LikelySoils, HaveTheSpreadThatIsBelieved) {
  const auto soils = likely_soils(spread("loam", sandy_loam(), 0.3), 40, {});
  ASSERT_EQ(soils.size(), 40U);
  double sum = 0.0, square = 0.0;
  for (const LikelySoil& each : soils) {
    const double log_k = std::log(each.soil.pressure.k_phi);
    sum += log_k / 40.0;
    square += log_k * log_k / 40.0;
  }
  const double variance = std::log1p(0.09);
  EXPECT_NEAR(sum, std::log(1.2e6) - 0.5 * variance, 0.01);
  EXPECT_NEAR(std::sqrt(square - sum * sum), std::sqrt(variance), 0.02);
  for (const LikelySoil& each : likely_soils(certain("loam", sandy_loam()), 5, {}))
    EXPECT_EQ(each.soil.pressure.k_phi, 1.2e6);
}

TEST(LikelySoils, HaveTheSpreadOfTheClosuresToo) {
  SoilDistribution belief = certain("loam", sandy_loam());
  belief.std.c1 = 0.1;
  const auto soils = likely_soils(belief, 60, {});
  double sum = 0.0, square = 0.0;
  for (const LikelySoil& each : soils) {
    sum += each.soil.c1 / 60.0;
    square += each.soil.c1 * each.soil.c1 / 60.0;
    EXPECT_EQ(each.soil.c2, belief.mean.c2);
  }
  EXPECT_NEAR(sum, belief.mean.c1, 0.005);
  EXPECT_NEAR(std::sqrt(square - sum * sum), 0.1, 0.01);
}

// As DrawnGround, whose draws are compared: ground that does not carry the rover on the level is rare.
TEST(LikelySoils, GroundThatDoesNotCarryTheRoverOnTheLevelIsAsRareAsInTheDraws) {
  const RoverModel rover = six_wheeler();
  Soil quicksand = loose_sand();
  quicksand.friction_angle_rad = 0.1;
  quicksand.cohesion_pa = 0.0;
  const LevelGroundTest carries(rover, 3.71);
  ASSERT_TRUE(carries(sandy_loam()));
  ASSERT_FALSE(carries(quicksand));
  const SoilDistribution belief =
      either(certain("strong", sandy_loam()), certain("quicksand", quicksand), 0.3);
  EXPECT_LT(share_with_friction_below(likely_soils(belief, 40, carries), 0.2), 1e-3);
  const SoilBeliefs beliefs{{belief}, belief};
  int drawn = 0;
  for (std::uint64_t d = 0; d < 400; ++d)
    drawn += DrawnGround(beliefs, random_key(3, d), carries).at(0, 1.0, 2.0).friction_angle_rad < 0.2 ? 1 : 0;
  EXPECT_LE(drawn, 3);
}

}  // namespace
}  // namespace slipway::sim
