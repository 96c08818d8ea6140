// One draw of the ground: a function of key and place, with the spread that is believed.
#include "sim/prediction/drawn_ground.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random.h"
#include "tests/sim/reference_models.h"

namespace slipway::sim {
namespace {

SoilDistribution loam() {
  return spread("loam", sandy_loam(), 0.3);
}

double log_k(const Soil& soil) {
  return std::log(soil.pressure.k_phi);
}

double covariance(const SoilDistribution& belief, double apart_m) {
  const SoilBeliefs beliefs{{belief}, belief};
  double xx = 0.0, xy = 0.0, mx = 0.0, my = 0.0;
  constexpr int kDraws = 4000;
  for (int d = 0; d < kDraws; ++d) {
    DrawnGround ground(beliefs, random_key(7, static_cast<std::uint64_t>(d)));
    const double x = log_k(ground.at(0, 1234.5, -77.0)), y = log_k(ground.at(0, 1234.5 + apart_m, -77.0));
    mx += x / kDraws;
    my += y / kDraws;
    xx += x * x / kDraws;
    xy += x * y / kDraws;
  }
  return (xy - mx * my) / (xx - mx * mx);
}

TEST(DrawnGround, IsAFunctionOfKeyAndPlaceInWhateverOrderItIsAsked) {
  const SoilBeliefs beliefs{{loam()}, spread("unknown_ground", loose_sand(), 0.5)};
  DrawnGround forth(beliefs, 11), back(beliefs, 11), other(beliefs, 12);
  std::vector<double> going;
  for (int k = 0; k < 60; ++k) going.push_back(log_k(forth.at(0, 3.0 * k, 0.7 * k)));
  for (int k = 59; k >= 0; --k)
    EXPECT_EQ(log_k(back.at(0, 3.0 * k, 0.7 * k)), going[static_cast<std::size_t>(k)]);
  EXPECT_NE(log_k(other.at(0, 0.0, 0.0)), going.front());
}

TEST(DrawnGround, ASoilIsTheSameWhateverItsPlaceInTheLegend) {
  const SoilBeliefs first{{loam()}, loam()};
  const SoilBeliefs second{{spread("sand", loose_sand(), 0.3), loam()}, loam()};
  EXPECT_EQ(log_k(DrawnGround(first, 5).at(0, 40.0, 2.0)), log_k(DrawnGround(second, 5).at(1, 40.0, 2.0)));
}

TEST(DrawnGround, HasTheBelievedSpreadAtEveryPlaceOfTheLattice) {
  const SoilBeliefs beliefs{{loam()}, loam()};
  for (const double x : {0.0, 1.3, 2.5, 50.0}) {  // at corners and between them
    double sum = 0.0, square = 0.0;
    constexpr int kDraws = 4000;
    for (int d = 0; d < kDraws; ++d) {
      const double z =
          log_k(DrawnGround(beliefs, random_key(3, static_cast<std::uint64_t>(d))).at(0, x, 2.1));
      sum += z / kDraws;
      square += z * z / kDraws;
    }
    EXPECT_NEAR(std::sqrt(square - sum * sum), std::sqrt(std::log1p(0.09)), 0.012) << x;
    EXPECT_NEAR(sum, std::log(1.2e6) - 0.5 * std::log1p(0.09), 0.02) << x;
  }
}

TEST(DrawnGround, SharesItsSpreadBetweenAllGroundUnitsAndPatches) {
  EXPECT_NEAR(covariance(loam(), 0.5), 0.99, 0.03) << "within a patch";
  EXPECT_NEAR(covariance(loam(), 12.0), 0.5 + 0.3, 0.06) << "two patches of a unit";
  EXPECT_NEAR(covariance(loam(), 1000.0), 0.5, 0.05) << "two units";
  SoilDistribution patchy = loam();
  patchy.shares = {0.0, 0.0, 1.0};
  EXPECT_NEAR(covariance(patchy, 1000.0), 0.0, 0.05);
}

// c1 and c2 vary from draw to draw and from place to place where they have a spread, and change nothing else.
TEST(DrawnGround, ClosuresHaveASpreadOfTheirOwn) {
  SoilDistribution with = loam();
  with.std.c1 = 0.1;
  with.std.c2 = 0.05;
  const SoilBeliefs plain{{loam()}, loam()}, closures{{with}, with};
  double sum = 0.0, squares = 0.0;
  constexpr int kDraws = 3000;
  for (int d = 0; d < kDraws; ++d) {
    const std::uint64_t key = random_key(9, static_cast<std::uint64_t>(d));
    DrawnGround ground(closures, key);
    const Soil soil = ground.at(0, 17.0, 4.0);
    EXPECT_EQ(log_k(soil), log_k(DrawnGround(plain, key).at(0, 17.0, 4.0)));
    EXPECT_EQ(DrawnGround(plain, key).at(0, 17.0, 4.0).c1, with.mean.c1);
    sum += soil.c1 / kDraws;
    squares += soil.c1 * soil.c1 / kDraws;
    if (d == 0) {
      EXPECT_NE(soil.c1, ground.at(0, 400.0, 4.0).c1);
    }
  }
  EXPECT_NEAR(sum, with.mean.c1, 0.01);
  EXPECT_NEAR(std::sqrt(squares - sum * sum), 0.1, 0.01);
}

TEST(DrawnGround, WithoutSpreadEveryDrawIsTheMean) {
  const SoilBeliefs beliefs{{certain("loam", sandy_loam())}, certain("sand", loose_sand())};
  DrawnGround ground(beliefs, 99);
  EXPECT_EQ(ground.at(0, 5.0, 6.0).pressure.k_phi, sandy_loam().pressure.k_phi);
  EXPECT_EQ(ground.at({}, 5.0, 6.0).cohesion_pa, loose_sand().cohesion_pa);
}

SoilDistribution either(double loam_weight, double sand_weight, bool by_unit) {
  SoilDistribution mixed = certain("either", sandy_loam());
  const auto loam = std::make_shared<SoilDistribution>(certain("loam", sandy_loam()));
  const auto sand = std::make_shared<SoilDistribution>(certain("sand", loose_sand()));
  mixed.alternatives = {{"loam", loam, loam_weight, loam_weight}, {"sand", sand, sand_weight, sand_weight}};
  mixed.alternatives_by = by_unit ? AlternativesBy::kUnit : AlternativesBy::kEverywhere;
  return mixed;
}

TEST(DrawnGround, ChoosesAmongAlternativesByTheirWeights) {
  const SoilBeliefs beliefs{{either(3.0, 1.0, false)}, loam()};
  int sand = 0, mixed = 0;
  constexpr int kDraws = 4000;
  for (int d = 0; d < kDraws; ++d) {
    DrawnGround ground(beliefs, random_key(1, static_cast<std::uint64_t>(d)));
    const Soil& soil = ground.at(0, 0.0, 0.0);
    const bool weak = soil.cohesion_pa == loose_sand().cohesion_pa;
    sand += weak;
    mixed += weak != (soil.pressure.n == loose_sand().pressure.n);
    EXPECT_EQ(ground.at(0, 5000.0, 0.0).cohesion_pa, soil.cohesion_pa) << "one soil for all ground";
  }
  EXPECT_NEAR(sand, 1000, 90);
  EXPECT_NEAR(mixed, 2 * 0.25 * 0.75 * kDraws, 120) << "pressure and strength are drawn apart";
}

TEST(DrawnGround, OfUnknownGroundEveryUnitIsAnotherDraw) {
  const SoilBeliefs beliefs{{}, either(1.0, 1.0, true)};
  int changes = 0, places = 0;
  for (int d = 0; d < 50; ++d) {
    DrawnGround ground(beliefs, random_key(2, static_cast<std::uint64_t>(d)));
    double before = ground.at({}, 0.0, 0.0).cohesion_pa;
    for (int k = 1; k < 100; ++k, ++places) {
      const double here = ground.at({}, 20.0 * k, 0.0).cohesion_pa;
      changes += here != before;
      before = here;
    }
  }
  // A line of 100 m crosses 4 / pi of the sides of such cells [Moller 1994]; half of these change the soil.
  const double per_100_m = 5.0 * changes / places;
  EXPECT_GT(per_100_m, 0.4);
  EXPECT_LT(per_100_m, 0.8);
}

TEST(DrawnGround, AlternativesByPatchChangeWithinAUnitAndAreWholeSoils) {
  SoilDistribution patchy = either(3.0, 1.0, false);
  patchy.alternatives_by = AlternativesBy::kPatch;
  patchy.correlation_length_m = 10.0;
  patchy.drawn_apart = false;
  const SoilBeliefs beliefs{{patchy}, loam()};
  int sand = 0, changes = 0;
  constexpr int kDraws = 100, kPlaces = 100;
  for (int d = 0; d < kDraws; ++d) {
    DrawnGround ground(beliefs, random_key(8, static_cast<std::uint64_t>(d)));
    bool before = false;
    for (int k = 0; k < kPlaces; ++k) {
      const Soil& soil = ground.at(0, 10.0 * k, 3.0);
      const bool weak = soil.cohesion_pa == loose_sand().cohesion_pa;
      EXPECT_EQ(weak, soil.pressure.n == loose_sand().pressure.n);
      sand += weak;
      changes += k > 0 && weak != before;
      before = weak;
    }
  }
  EXPECT_NEAR(sand / double{kDraws * kPlaces}, 0.25, 0.02);
  EXPECT_GT(changes, kDraws * kPlaces / 8) << "steps as long as a patch mostly end in another";
}

TEST(DrawnGround, HowCommonAnAlternativeIsDiffersFromDrawToDraw) {
  SoilDistribution patchy = either(3.0, 1.0, false);
  patchy.alternatives_by = AlternativesBy::kPatch;
  patchy.drawn_apart = false;
  const auto variance = [&](double spread) {
    patchy.alternatives_spread = spread;
    const SoilBeliefs beliefs{{patchy}, loam()};
    double sum = 0.0, square = 0.0;
    for (int d = 0; d < 200; ++d) {
      DrawnGround ground(beliefs, random_key(4, static_cast<std::uint64_t>(d)));
      double share = 0.0;
      for (int k = 0; k < 100; ++k)
        share += 0.01 * (ground.at(0, 50.0 * k, 3.0).cohesion_pa == loose_sand().cohesion_pa);
      sum += share / 200.0;
      square += share * share / 200.0;
    }
    return square - sum * sum;
  };
  EXPECT_NEAR(variance(0.0), 0.25 * 0.75 / 100.0, 0.001);
  EXPECT_GT(variance(1.0), 10.0 * 0.25 * 0.75 / 100.0);
}

TEST(DrawnGround, RedrawnCellsChangeTheGroundThereAndNowhereElse) {
  const SoilBeliefs beliefs{{loam()}, loam()};
  DrawnGround before(beliefs, 5);
  std::unordered_set<std::uint64_t> met;
  before.note(met);
  const double here = log_k(before.at(0, 1.0, 1.0));
  RedrawnCells redrawn;
  for (const std::uint64_t cell : met) redrawn.keys[cell] = random_key(cell, 1);
  DrawnGround after(beliefs, 5, {}, &redrawn);
  EXPECT_NE(log_k(after.at(0, 1.0, 1.0)), here);
  EXPECT_EQ(log_k(after.at(0, 5000.0, 1.0)), log_k(before.at(0, 5000.0, 1.0)));
}

// Firm ground by units with a sand in patches of 8 m on 6 % of it.
SoilDistribution firm_with_patches() {
  SoilDistribution belief = loam();
  belief.drawn_apart = false;
  belief.alternatives_by = AlternativesBy::kUnit;
  belief.correlation_length_m = 8.0;
  const auto firm = std::make_shared<const SoilDistribution>(spread("firm", sandy_loam(), 0.0));
  const auto sand = std::make_shared<const SoilDistribution>(spread("sand", loose_sand(), 0.0));
  belief.alternatives = {{"firm", firm, 0.94, 0.94, false}, {"sand", sand, 0.06, 0.06, true}};
  return belief;
}

TEST(DrawnGround, PatchesWithinUnitsHaveTheirShareOfTheGroundAndTheirLength) {
  const SoilDistribution belief = firm_with_patches();
  const SoilBeliefs beliefs{{belief}, belief};
  const double sand = log_k(belief.alternatives[1].soil->mean);
  int on_sand = 0, ends = 0, metres = 0;
  for (std::uint64_t d = 0; d < 400; ++d) {
    DrawnGround ground(beliefs, random_key(21, d));
    bool was = false;
    for (int k = 0; k < 200; ++k, ++metres) {
      const bool is = log_k(ground.at(0, k, 3.0)) == sand;
      on_sand += is ? 1 : 0;
      ends += was && !is ? 1 : 0;
      was = is;
    }
  }
  EXPECT_NEAR(static_cast<double>(on_sand) / metres, 0.06, 0.006);
  // The mean chord of a square cell of 8 m is 6.3 m; neighbours are sand too now and then.
  EXPECT_NEAR(static_cast<double>(on_sand) / ends, 6.3, 1.3);
}

TEST(DrawnGround, ARenewedDrawKeepsTheGroundThatWasMetAndHasItsOwnElsewhere) {
  const SoilBeliefs beliefs{{loam()}, loam()};
  DrawnGround before(beliefs, random_key(1, 0));
  ConditionedDraw draw;
  before.note(draw.met);
  const double here = log_k(before.at(0, 1.0, 1.0));
  const auto copies = renewed({draw}, 2, 9);
  ASSERT_EQ(copies.size(), 2U);
  DrawnGround one(beliefs, random_key(1, 0), {}, &copies[0].redrawn),
      other(beliefs, random_key(1, 0), {}, &copies[1].redrawn);
  EXPECT_EQ(log_k(one.at(0, 1.0, 1.0)), here);
  EXPECT_EQ(log_k(other.at(0, 1.0, 1.0)), here);
  EXPECT_NE(log_k(one.at(0, 5000.0, 1.0)), log_k(other.at(0, 5000.0, 1.0)));
}

TEST(RenewedDraws, AreCopiedByTheirWeightAndAllCount) {
  std::vector<ConditionedDraw> draws(4);
  const std::vector<double> weights{0.0, 1.0, 3.0, 4.0};
  for (std::size_t d = 0; d < draws.size(); ++d) draws[d].weight = weights[d];
  const auto copies = renewed(draws, 800, 5);
  EXPECT_DOUBLE_EQ(effective_draws(copies), 800.0);
  std::vector<int> counted(4, 0);
  for (const ConditionedDraw& copy : copies) ++counted[copy.number.value()];
  for (std::size_t d = 0; d < draws.size(); ++d) EXPECT_NEAR(counted[d], 100.0 * weights[d], 1.0);
  // The first of them are as good as any.
  int heaviest = 0;
  for (std::size_t k = 0; k < 100; ++k) heaviest += *copies[k].number == 3 ? 1 : 0;
  EXPECT_NEAR(heaviest, 50, 20);
}

}  // namespace
}  // namespace slipway::sim
