// Tests of what the best diagnosis could see of a hidden cause.
#include "detectability.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

namespace slipway::gap_benchmark {
namespace {

Detectability of(std::vector<std::string> causes, double size = 1.0) {
  CampaignCase made_of;
  made_of.causes = std::move(causes);
  made_of.size = size;
  made_of.soil = "sandy-loam";
  made_of.seed = 5;
  RandomStream random(made_of.seed);
  return detectability(make_campaign(made_of, random));
}

TEST(Detectability, NothingHiddenIsNothingToSee) {
  EXPECT_EQ(of({}).parameters_known, 0.0);
}

TEST(Detectability, WhatMayBeRetunedTakesAPart) {
  for (const char* cause : {"hardpan", "side_bulldozing", "gearbox_friction"}) {
    const Detectability d = of({cause});
    EXPECT_GT(d.parameters_known, d.retuned_as_drawn) << cause;
    EXPECT_GT(d.parameters_known, d.retuned_as_believed) << cause;
    EXPECT_GE(d.retuned_as_drawn, 0.0) << cause;
    EXPECT_GE(d.retuned_as_believed, 0.0) << cause;
  }
}

TEST(Detectability, AShiftedLoadStaysVisible) {
  const Detectability d = of({"com_offset"});
  EXPECT_GT(d.retuned_as_believed, 0.5 * d.parameters_known);
}

// Why no diagnosis that lets the shear modulus across differ from that along by 15 % can name it.
TEST(Detectability, SideWallsActLikeALateralShearModulus) {
  const Detectability d = of({"side_bulldozing"});
  EXPECT_GT(d.retuned_as_drawn, 100.0);
  EXPECT_LT(d.retuned_as_believed, 20.0);
}

TEST(Detectability, GrowsWithTheSquareOfASmallCause) {
  const double half = of({"gearbox_friction"}, 0.05).parameters_known,
               whole = of({"gearbox_friction"}, 0.1).parameters_known;
  EXPECT_NEAR(whole / half, 4.0, 0.4);
}

TEST(Detectability, IsARowOfAsManyCellsAsTheHeaderHas) {
  EXPECT_EQ(detectability_header(), "campaign,parameters_known,retuned_as_drawn,retuned_as_believed\n");
  EXPECT_EQ(detectability_row("s01", {100.0, 20.5, 3.0}), "s01,100,20.5,3\n");
}

}  // namespace
}  // namespace slipway::gap_benchmark
