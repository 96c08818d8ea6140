#include "sim/dynamic/rut_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "core/random.h"

namespace slipway::sim {
namespace {

TEST(RutMap, UndrivenGroundHasNoRut) {
  const RutMap ruts;
  EXPECT_EQ(ruts.at(1.0, -3.0).depth_m, 0.0);
  EXPECT_EQ(ruts.at(1.0, -3.0).share, 0.0);
  EXPECT_EQ(ruts.tile_count(), 0u);
  EXPECT_TRUE(ruts.cells().empty());
}

TEST(RutMap, AWheelLeavesARutOfItsWidthAndDepthAlongItsWay) {
  for (const double heading : {0.0, 0.7, 2.0, -2.6}) {
    RutMap ruts;
    const Eigen::Vector2d along(std::cos(heading), std::sin(heading)), left(-along.y(), along.x());
    const Eigen::Vector2d from(-0.4, 0.3);  // across the origin, where tiles meet
    ruts.press(from, from + 0.9 * along, 0.16, 0.03);
    const auto at = [&](double done, double across) -> RutMap::Rut {
      const Eigen::Vector2d p = from + done * along + across * left;
      return ruts.at(p.x(), p.y());
    };
    for (double done = 0.03; done < 0.87; done += 0.01) {
      for (const double across : {-0.05, 0.0, 0.05}) {
        EXPECT_NEAR(at(done, across).depth_m, 0.03, 1e-8) << heading << " " << done;
        EXPECT_NEAR(at(done, across).share, 1.0, 1e-12) << heading << " " << done;
      }
      EXPECT_EQ(at(done, 0.12).share, 0.0);
      EXPECT_EQ(at(done, -0.12).share, 0.0);
    }
    EXPECT_EQ(at(-0.05, 0.0).share, 0.0);
    EXPECT_EQ(at(0.95, 0.0).share, 0.0);
    // As much ground as the wheel passed over.
    const double area = static_cast<double>(ruts.cells().size()) * ruts.cell_m() * ruts.cell_m();
    EXPECT_NEAR(area, 0.16 * 0.91, 0.06 * 0.16);
  }
}

TEST(RutMap, OnlyTheDeepestPassageCounts) {
  RutMap ruts;
  ruts.press({0.0, 0.0}, {1.0, 0.0}, 0.2, 0.02);
  ruts.press({0.0, 0.0}, {0.5, 0.0}, 0.2, 0.05);
  ruts.press({0.0, 0.0}, {1.0, 0.0}, 0.2, 0.01);
  EXPECT_NEAR(ruts.at(0.25, 0.0).depth_m, 0.05, 1e-8);
  EXPECT_NEAR(ruts.at(0.75, 0.0).depth_m, 0.02, 1e-8);
}

TEST(RutMap, ManyStepsAroundABendLeaveNoGaps) {
  // A wheel of the left side of a tight turn: at its outer edge the steps' rectangles part.
  const double radius = 0.5, width = 0.2, step = 0.013;
  RutMap ruts;
  const auto place = [=](double angle) {
    return Eigen::Vector2d(radius * std::cos(angle), radius * std::sin(angle));
  };
  for (double angle = 0.0; angle < 2.0 * std::numbers::pi; angle += step / radius)
    ruts.press(place(angle), place(angle + step / radius), width, 0.04);
  for (double angle = 0.0; angle < 6.3; angle += 0.003) {
    for (double r = radius - 0.5 * width + 0.03; r < radius + 0.5 * width - 0.03; r += 0.005)
      EXPECT_NEAR(ruts.at(r * std::cos(angle), r * std::sin(angle)).share, 1.0, 1e-12) << angle << " " << r;
  }
}

TEST(RutMap, BetweenCellsTheRutIsBilinear) {
  // One read after another against the cells themselves, across tiles' borders and the origin.
  RutMap ruts(0.05);
  for (std::uint64_t i = 0; i < 40; ++i) {
    const auto any = [&](std::uint64_t key) { return 4.0 * random_uniform(key, i) - 2.0; };
    ruts.press({any(1), any(2)}, {any(3), any(4)}, 0.15, 0.01 + 0.05 * random_uniform(5, i));
  }
  std::map<std::pair<int, int>, double> cells;
  const auto index = [](double place) { return static_cast<int>(std::floor(place / 0.05)); };
  for (const RutMap::Cell& cell : ruts.cells()) cells[{index(cell.x_m), index(cell.y_m)}] = cell.depth_m;
  for (std::uint64_t i = 0; i < 5000; ++i) {
    const double x = 4.4 * random_uniform(6, i) - 2.2, y = 4.4 * random_uniform(7, i) - 2.2;
    double depth = 0.0, share = 0.0;
    for (int dx = 0; dx < 2; ++dx) {
      for (int dy = 0; dy < 2; ++dy) {
        const int column = index(x - 0.025) + dx, row = index(y - 0.025) + dy;
        const double weight =
            (1.0 - std::abs(x / 0.05 - 0.5 - column)) * (1.0 - std::abs(y / 0.05 - 0.5 - row));
        const auto cell = cells.find({column, row});
        if (cell == cells.end()) continue;
        depth += weight * cell->second;
        share += weight;
      }
    }
    const RutMap::Rut rut = ruts.at(x, y);
    EXPECT_NEAR(rut.depth_m, depth, 1e-12);
    EXPECT_NEAR(rut.share, share, 1e-12);
  }
}

TEST(RutMap, AWheelThatDoesNotMoveOrIsNotPressedLeavesNothing) {
  RutMap ruts;
  ruts.press({0.3, 0.3}, {0.3, 0.3}, 0.2, 0.05);
  ruts.press({0.0, 0.0}, {1.0, 0.0}, 0.2, 0.0);
  EXPECT_EQ(ruts.tile_count(), 0u);
}

TEST(RutMap, ForgetsFarTilesAndKeepsNearOnes) {
  RutMap ruts;
  ruts.press({0.0, 0.0}, {100.0, 0.0}, 0.2, 0.03);
  const std::size_t before = ruts.tile_count();
  ruts.forget_beyond({100.0, 0.0}, 5.0);
  EXPECT_LT(ruts.tile_count(), before / 10);
  EXPECT_EQ(ruts.at(90.0, 0.0).depth_m, 0.0);
  for (double x = 95.0; x < 99.9; x += 0.1) EXPECT_NEAR(ruts.at(x, 0.0).depth_m, 0.03, 1e-8) << x;
}

TEST(RutMap, TheOrderOfCellsDoesNotDependOnHowTheMapGrew) {
  RutMap forth, back;
  for (int i = 0; i < 50; ++i) {
    forth.press({i * 0.3, -1.0}, {i * 0.3, 1.0}, 0.1, 0.03);
    back.press({(49 - i) * 0.3, -1.0}, {(49 - i) * 0.3, 1.0}, 0.1, 0.03);
  }
  const auto a = forth.cells(), b = back.cells();
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].x_m, b[i].x_m);
    EXPECT_EQ(a[i].y_m, b[i].y_m);
    EXPECT_EQ(a[i].depth_m, b[i].depth_m);
  }
}

}  // namespace
}  // namespace slipway::sim
