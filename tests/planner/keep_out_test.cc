#include "planner/problem/keep_out.h"

#include <gtest/gtest.h>

#include "tests/planner/plan_fixture.h"

namespace slipway::planner {
namespace {

const std::vector<Polygon> kSquare{{{10.0, 10.0}, {20.0, 10.0}, {20.0, 20.0}, {10.0, 20.0}}};

TEST(KeepOut, IsHitFromInsideAndByTheBodysCornerButNotBeyondIt) {
  const KeepOut keep_out(kSquare, *test_rover());  // body 2.0 by 1.45 m
  EXPECT_TRUE(keep_out.hits({15.0, 15.0, 0.3}));
  EXPECT_TRUE(keep_out.hits({9.01, 15.0, 0.0}));
  EXPECT_FALSE(keep_out.hits({8.99, 15.0, 0.0}));
}

TEST(KeepOut, ARoverAlongItsEdgePassesNearerThanOneAcrossIt) {
  const KeepOut keep_out(kSquare, *test_rover());
  EXPECT_FALSE(keep_out.hits({9.2, 15.0, 0.5 * std::numbers::pi}));
  EXPECT_TRUE(keep_out.hits({9.2, 15.0, 0.0}));
  EXPECT_FALSE(keep_out.hits_at_any_heading(9.2, 15.0));
  EXPECT_FALSE(keep_out.clear_at_any_heading(9.2, 15.0));
}

TEST(KeepOut, AgreesWithItsBoundsAtAnyHeading) {
  const KeepOut keep_out(kSquare, *test_rover());
  for (double x = 5.0; x < 12.0; x += 0.1) {
    for (double yaw = 0.0; yaw < 6.2; yaw += 0.3) {
      const bool hit = keep_out.hits({x, 9.0, yaw});
      EXPECT_TRUE(!keep_out.hits_at_any_heading(x, 9.0) || hit);
      EXPECT_TRUE(!keep_out.clear_at_any_heading(x, 9.0) || !hit);
    }
  }
}

}  // namespace
}  // namespace slipway::planner
