#include "planner/search/overlap.h"

#include <gtest/gtest.h>

#include "planner/search/select_routes.h"

namespace slipway::planner {
namespace {

std::vector<Eigen::Vector2d> line(double x0, double y0, double x1, double y1) {
  const Motion motion = straight({x0, y0, 0.0}, x1, y1);
  return centreline({motion}, 0.25);
}

TEST(Overlap, OfARouteWithItselfIsOne) {
  EXPECT_DOUBLE_EQ(overlap(line(0, 0, 100, 30), line(0, 0, 100, 30), 1.5), 1.0);
}

TEST(Overlap, OfParallelRoutesIsOneWithinTheWidthAndZeroBeyond) {
  EXPECT_DOUBLE_EQ(overlap(line(0, 0, 100, 0), line(0, 1.4, 100, 1.4), 1.5), 1.0);
  EXPECT_DOUBLE_EQ(overlap(line(0, 0, 100, 0), line(0, 1.7, 100, 1.7), 1.5), 0.0);
}

TEST(Overlap, OfAShortRouteWithinALongOneIsNotSymmetric) {
  EXPECT_DOUBLE_EQ(overlap(line(40, 0, 60, 0), line(0, 0, 100, 0), 1.5), 1.0);
  EXPECT_NEAR(overlap(line(0, 0, 100, 0), line(40, 0, 60, 0), 1.5), 0.23, 0.01);
}

TEST(SelectRoutes, PrefersMoreRoutesToABetterOneAndThenTheBest) {
  Differences differences(1.5);
  differences.add(line(0, 0, 100, 0));   // 0: shares with 1 and 2 in halves
  differences.add(line(0, 0, 70, 0));    // 1: most of 0
  differences.add(line(30, 0, 100, 0));  // 2: most of 0
  differences.add(line(0, 9, 100, 9));   // 3: apart
  EXPECT_EQ(select_routes(differences, {0, 1, 2, 3}, 4, 3), (std::vector<std::size_t>{1, 2, 3}));
  EXPECT_EQ(select_routes(differences, {0, 1, 2, 3}, 4, 2), (std::vector<std::size_t>{0, 3}));
  EXPECT_EQ(select_routes(differences, {3, 0, 1, 2}, 4, 1), (std::vector<std::size_t>{3}));
  // One of the leaders is in the set, whatever that costs in number.
  EXPECT_EQ(select_routes(differences, {0, 1, 2, 3}, 1, 3), (std::vector<std::size_t>{0, 3}));
  EXPECT_EQ(select_routes(differences, {0, 1, 2, 3}, 2, 3), (std::vector<std::size_t>{1, 2, 3}));
  EXPECT_EQ(as_good_as_best({2.0, 2.01, 2.02, 2.03}), 3U);
}

}  // namespace
}  // namespace slipway::planner
