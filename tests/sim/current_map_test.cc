#include "sim/single_wheel/current_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/sim/zhurong_simulants.h"

// The Zhurong paper's statements on its figures 9 to 11, compared with its own equations (literal) and with
// the balanced wheel. Where a statement does not hold, the test checks what holds instead.
namespace slipway::sim {
namespace {

constexpr CurrentModel kBoth[] = {CurrentModel::kLiteral, CurrentModel::kBalanced};

std::vector<double> currents(const Soil& soil, CurrentModel model, const SweepAxis& axis, double slip = 0.1) {
  WheelSweep sweep{zhurong_rig(soil), {axis}};
  sweep.rig.test.slip = slip;
  std::vector<double> values;
  for (const CurrentPoint& point : run_current_map(sweep, model)) {
    if (point.current_a) values.push_back(*point.current_a);
  }
  return values;
}

bool rises(const std::vector<double>& values) {
  return std::adjacent_find(values.begin(), values.end(), [](double a, double b) { return b <= a; }) ==
         values.end();
}
bool falls(const std::vector<double>& values) {
  return std::adjacent_find(values.begin(), values.end(), [](double a, double b) { return b >= a; }) ==
         values.end();
}

// The largest distance of values over their places from the line through the first and the last, over the
// last.
double bend(const std::vector<double>& x, const std::vector<double>& y) {
  double worst = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double line = y.front() + (y.back() - y.front()) * (x[i] - x.front()) / (x.back() - x.front());
    worst = std::max(worst, std::abs(y[i] - line) / y.back());
  }
  return worst;
}

TEST(CurrentMap, ThePrintedCurrentIsTheLiteralModelsWithTheGear) {
  EXPECT_NEAR(currents(jlu_mars()[1][2], CurrentModel::kLiteral, {"slip", {0.0}}).at(0), 0.114, 5e-4);
}

TEST(CurrentMap, LiteralSinkageIsThatOfAnotherReproduction) {
  const double mm[3][3] = {{0.0, 7.3, 8.4}, {43.7, 19.1, 9.7}, {28.8, 16.3, 8.9}};
  for (std::size_t s = 0; s < 3; ++s) {
    for (std::size_t state = 0; state < 3; ++state) {
      if (mm[s][state] == 0.0) continue;
      const WheelSweep sweep{zhurong_rig(jlu_mars()[s][state]), {{"slip", {0.0}}}};
      EXPECT_NEAR(1e3 * run_current_map(sweep, CurrentModel::kLiteral)[0].sinkage_m, mm[s][state], 0.06);
    }
  }
}

TEST(CurrentMap, CurrentFallsWithStiffnessAndLevelsOff) {
  for (const CurrentModel model : kBoth) {
    for (std::size_t s = 0; s < 3; ++s) {
      for (const double n : {0.7, 1.0, 1.4}) {
        Soil soil = jlu_mars()[s][0];
        soil.pressure.n = n;
        const SweepAxis axis = *paper_axis("soil.k_s", 30);
        const std::vector<double> values = currents(soil, model, axis);
        ASSERT_GE(values.size(), 10U);
        EXPECT_TRUE(falls(values)) << s << " " << n;
        const std::size_t first = axis.values.size() - values.size(), last = axis.values.size() - 1;
        const auto slope = [&](std::size_t i) {
          return (values[i - first] - values[i - first + 1]) / (axis.values[i + 1] - axis.values[i]);
        };
        EXPECT_GT(slope(first), 3.0 * slope(last - 1));
      }
    }
  }
}

TEST(CurrentMap, BelowALeastStiffnessThePapersRangeSinksTheWheel) {
  const WheelSweep sweep{zhurong_rig(jlu_mars()[2][0]), {{"soil.n", {1.4}}, {"soil.k_s", {60e3}}}};
  for (const CurrentModel model : kBoth) {
    const CurrentPoint point = run_current_map(sweep, model).at(0);
    EXPECT_FALSE(point.current_a);
    EXPECT_TRUE(point.reason.starts_with("sunk to the axle")) << point.reason;
  }
}

// The paper's text states both; by its equations current rises with n, as sinkage does.
TEST(CurrentMap, CurrentRisesWithTheExponentContraryToThePapersText) {
  for (const CurrentModel model : kBoth) {
    for (std::size_t s = 0; s < 3; ++s) {
      Soil soil = jlu_mars()[s][0];
      soil.pressure.k_c = 0.0;
      soil.pressure.k_phi = 1000e3;
      EXPECT_TRUE(rises(currents(soil, model, *paper_axis("soil.n", 15)))) << s;
    }
  }
}

TEST(CurrentMap, BalancedCurrentRisesWithSlipEverywhere) {
  for (const auto& simulant : jlu_mars()) {
    for (const Soil& soil : simulant)
      EXPECT_TRUE(rises(currents(soil, CurrentModel::kBalanced, *paper_axis("slip", 46))));
  }
}

// A miss of the paper's "positive correlation between slip and current": with the entry angle fixed by A18,
// theta_m moves towards it as slip grows, and the printed equations let the current fall again, on the loose
// simulants from slip 0.4 to 0.6 on.
TEST(CurrentMap, LiteralCurrentRisesWithSlipToThreeTenthsAndLaterFallsAgain) {
  for (const auto& simulant : jlu_mars()) {
    for (const Soil& soil : simulant) {
      const SweepAxis axis = *paper_axis("slip", 46);
      const std::vector<double> values = currents(soil, CurrentModel::kLiteral, axis);
      const auto top = std::max_element(values.begin(), values.end());
      EXPECT_GE(axis.values[static_cast<std::size_t>(top - values.begin())], 0.3);
      EXPECT_LT(values.back(), *top) << "at slip 0.9 it has fallen";
    }
  }
}

// Another miss: on soil so soft that A18 sinks the wheel by half its radius, the literal current falls with
// slip all the way. The balanced one rises.
TEST(CurrentMap, OnTheSoftestSoilLiteralCurrentFallsWithSlip) {
  Soil soil = jlu_mars()[1][0];
  soil.pressure.k_c = 0.0;
  soil.pressure.k_phi = 110e3;
  EXPECT_TRUE(falls(currents(soil, CurrentModel::kLiteral, {"slip", {0.1, 0.3, 0.5, 0.7, 0.9}})));
  soil.pressure.k_phi = 250e3;  // the softest that carries the load
  EXPECT_TRUE(rises(currents(soil, CurrentModel::kBalanced, {"slip", {0.1, 0.3, 0.5, 0.7, 0.9}})));
}

TEST(CurrentMap, LiteralCurrentIsLinearInCohesionWithASlopeThatFrictionDoesNotChange) {
  for (std::size_t s = 0; s < 3; ++s) {
    const SweepAxis axis = *paper_axis("soil.cohesion_pa", 12);
    std::vector<double> slopes;
    for (const double phi : {16.0, 28.0, 40.0}) {
      Soil soil = jlu_mars()[s][0];
      soil.friction_angle_rad = rad_from_deg(phi);
      const std::vector<double> values = currents(soil, CurrentModel::kLiteral, axis);
      EXPECT_LT(bend(axis.values, values), 1e-9);
      slopes.push_back(values.back() - values.front());
    }
    EXPECT_NEAR(slopes[0], slopes[2], 1e-9);
    const std::vector<double> slipping = currents(jlu_mars()[s][0], CurrentModel::kLiteral, axis, 0.5);
    EXPECT_GT(slipping.back() - slipping.front(), slopes[0]) << "slip changes the slope";
  }
}

// Cohesion helps to carry the wheel, so that it sinks less: the balanced line bends by a few per cent.
TEST(CurrentMap, BalancedCurrentIsNearlyLinearInCohesion) {
  const SweepAxis axis = *paper_axis("soil.cohesion_pa", 12);
  for (std::size_t s = 1; s < 3; ++s) {
    const std::vector<double> values = currents(jlu_mars()[s][0], CurrentModel::kBalanced, axis);
    EXPECT_TRUE(rises(values));
    EXPECT_GT(bend(axis.values, values), 1e-3);
    EXPECT_LT(bend(axis.values, values), 0.2);
  }
}

TEST(CurrentMap, LiteralCurrentRisesWithFriction) {
  for (std::size_t s = 0; s < 3; ++s)
    EXPECT_TRUE(rises(
        currents(jlu_mars()[s][0], CurrentModel::kLiteral, *paper_axis("soil.friction_angle_deg", 13))));
}

// "The current at the beginning of slipping gradually increases as soil hardness decreases": simulants 2
// and 3. JLU Mars 1 misses it by 4 %: its dense state sinks deeper (8.4 mm) than its medium one (7.3 mm).
TEST(CurrentMap, CurrentAtNoSlipFallsWithHardnessExceptOnSimulantOne) {
  const auto at_rest = [](const Soil& soil) {
    return currents(soil, CurrentModel::kLiteral, {"slip", {0.0}}).at(0);
  };
  const auto soils = jlu_mars();
  for (const std::size_t s : {std::size_t{1}, std::size_t{2}})
    EXPECT_TRUE(falls({at_rest(soils[s][0]), at_rest(soils[s][1]), at_rest(soils[s][2])}));
  EXPECT_NEAR(at_rest(soils[0][2]) / at_rest(soils[0][1]), 1.04, 0.01);
}

// "The curve of JLU Mars 2 always has the largest slope": of the medium states only.
TEST(CurrentMap, SimulantTwoHasTheLargestRiseInItsMediumStateOnly) {
  const auto soils = jlu_mars();
  for (const CurrentModel model : kBoth) {
    const auto rise = [&](std::size_t simulant, std::size_t state) {
      const std::vector<double> values = currents(soils[simulant][state], model, {"slip", {0.0, 0.5}});
      return values.at(1) - values.at(0);
    };
    EXPECT_GT(rise(1, 1), rise(0, 1));
    EXPECT_GT(rise(1, 1), rise(2, 1));
    EXPECT_LT(rise(1, 0), rise(2, 0));
    EXPECT_LT(rise(1, 2), rise(0, 2));
  }
}

// Beyond slip 0.3 to 0.5 the literal currents of loose simulants fall below those of medium ones: a miss.
TEST(CurrentMap, TheSameCurrentMeansLessSlipOnLooserSimulantsAtLowSlip) {
  const auto soils = jlu_mars();
  for (const CurrentModel model : kBoth) {
    for (const std::size_t s : {std::size_t{1}, std::size_t{2}}) {
      for (const double slip : {0.05, 0.1, 0.2}) {
        const auto at = [&](std::size_t state) {
          return currents(soils[s][state], model, {"slip", {slip}}).at(0);
        };
        EXPECT_GT(at(0), at(1)) << s << " " << slip;
        EXPECT_GT(at(1), at(2)) << s << " " << slip;
      }
    }
  }
  for (const std::size_t s : {std::size_t{1}, std::size_t{2}}) {
    const auto at = [&](std::size_t state) {
      return currents(soils[s][state], CurrentModel::kLiteral, {"slip", {0.7}}).at(0);
    };
    EXPECT_LT(at(0), at(1));
    const auto balanced = [&](std::size_t state) {
      return currents(soils[s][state], CurrentModel::kBalanced, {"slip", {0.5}}).at(0);
    };
    EXPECT_GT(balanced(0), balanced(1));
    EXPECT_GT(balanced(1), balanced(2));
  }
}

TEST(PaperAxis, HasTheEndsOfTableThree) {
  const SweepAxis k_s = *paper_axis("soil.k_s", 5);
  EXPECT_EQ(k_s.values.front(), 60e3);
  EXPECT_EQ(k_s.values.back(), 7700e3);
  EXPECT_NEAR(k_s.values[1] / k_s.values[0], k_s.values[4] / k_s.values[3], 1e-9);
  EXPECT_FALSE(paper_axis("soil.c1", 5));
}

}  // namespace
}  // namespace slipway::sim
