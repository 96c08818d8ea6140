#include "sim/slip_table.h"

#include <gtest/gtest.h>

#include "core/angle.h"
#include "tests/sim/reference_models.h"

namespace slipway::sim {
namespace {

class SlipTableOnLoam : public testing::Test {
 protected:
  RoverModel rover = six_wheeler();
  SlipTable table{rover, 3.71, sandy_loam(), rad_from_deg(25.0), rad_from_deg(2.5)};

  StationState exact(double pitch_deg, double roll_deg) {
    QuasiStaticSolver solver(rover, 3.71);
    const Attitude attitude{
        .roll_rad = rad_from_deg(roll_deg), .pitch_rad = rad_from_deg(pitch_deg), .yaw_rad = 0.0};
    return solver.solve(stance_on_plane(rover, attitude), sandy_loam(),
                        {.speed_m_s = rover.cruise_speed_m_s});
  }
};

TEST_F(SlipTableOnLoam, AtANodeItIsTheQuasiStaticRung) {
  const auto entry = table.at(rad_from_deg(-10.0), rad_from_deg(5.0));
  ASSERT_TRUE(entry);
  EXPECT_NEAR(entry->slip_ratio, exact(-10.0, 5.0).slip_ratio, 1e-6);
}

TEST_F(SlipTableOnLoam, BetweenNodesItStaysWithinTwoPointsOfSlipWhereTheRoverMoves) {
  for (double pitch = -17.0; pitch < 18.0; pitch += 1.7)
    for (double roll = -17.0; roll < 18.0; roll += 3.1) {
      const auto entry = table.at(rad_from_deg(pitch), rad_from_deg(roll));
      ASSERT_TRUE(entry);
      EXPECT_NEAR(entry->slip_ratio, exact(pitch, roll).slip_ratio, 0.02) << pitch << " " << roll;
    }
}

TEST_F(SlipTableOnLoam, PitchIsNotRoll) {
  const auto climb = table.at(rad_from_deg(-15.0), 0.0), across = table.at(0.0, rad_from_deg(15.0));
  EXPECT_GT(climb->slip_ratio, 3.0 * across->slip_ratio);
  EXPECT_GT(std::abs(across->side_slip_rad), rad_from_deg(2.0));
}

TEST_F(SlipTableOnLoam, BeyondItsLimitItHasNoAnswer) {
  EXPECT_FALSE(table.at(rad_from_deg(26.0), 0.0));
  EXPECT_FALSE(table.at(0.0, std::nan("")));
}

TEST_F(SlipTableOnLoam, WhereTheRoverIsStuckTheEntrySaysSo) {
  EXPECT_EQ(table.at(rad_from_deg(-25.0), 0.0)->immobile, 1.0);
  EXPECT_EQ(table.at(rad_from_deg(-5.0), 0.0)->immobile, 0.0);
}

}  // namespace
}  // namespace slipway::sim
