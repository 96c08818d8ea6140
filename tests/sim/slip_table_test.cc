#include "sim/quasi_static/slip_table.h"

#include <gtest/gtest.h>

#include "core/angle.h"
#include "sim/prediction/drive_risk.h"
#include "sim/quasi_static/traction_limit.h"
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

TEST_F(SlipTableOnLoam, BetweenNodesItIsTheQuasiStaticLevelToAThousandthOfSlip) {
  const double lean_rad = rad_from_deg(0.02);
  double largest_lean = 0.0;
  int moving = 0;
  for (double pitch = -23.0; pitch < 23.0; pitch += 1.7)
    for (double roll = -19.0; roll < 19.0; roll += 3.1) {
      const StationState state = exact(pitch, roll);
      if (!state.moving() || state.slip_ratio > 0.8) continue;
      const auto entry = table.at(rad_from_deg(pitch), rad_from_deg(roll));
      ASSERT_TRUE(entry);
      ASSERT_FALSE(entry->immobile) << pitch << " " << roll;
      const double current = largest_current_a(state), sinkage = deepest_sinkage_m(state);
      EXPECT_NEAR(entry->slip_ratio, state.slip_ratio, 1e-3) << pitch << " " << roll;
      EXPECT_NEAR(entry->side_slip_rad, state.side_slip_rad, rad_from_deg(0.2)) << pitch << " " << roll;
      EXPECT_NEAR(entry->sinkage_m, sinkage, 0.01 * sinkage) << pitch << " " << roll;
      EXPECT_NEAR(entry->current_a, current, 0.002 * current) << pitch << " " << roll;
      EXPECT_NEAR(rad_from_deg(pitch) + entry->pitch_lean_rad, state.attitude.pitch_rad, lean_rad);
      EXPECT_NEAR(rad_from_deg(roll) + entry->roll_lean_rad, state.attitude.roll_rad, lean_rad);
      largest_lean = std::max(largest_lean, std::abs(entry->pitch_lean_rad));
      ++moving;
    }
  EXPECT_GT(moving, 300);
  EXPECT_GT(largest_lean, rad_from_deg(0.1));
}

TEST_F(SlipTableOnLoam, UpToTheTractionLimitEnergyIsThePowerPerMetreOfProgress) {
  for (const double pitch : {-21.3, -22.4, -23.2}) {
    const StationState state = exact(pitch, 1.3);
    const double energy = state.electric_power_w / (state.forward_m_s * std::cos(rad_from_deg(pitch)));
    EXPECT_NEAR(table.at(rad_from_deg(pitch), rad_from_deg(1.3))->energy_j_m, energy, 0.01 * energy);
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

TEST_F(SlipTableOnLoam, ItEndsWhereTheBalanceDoes) {
  for (const double roll : {-13.7, 0.0, 6.1}) {
    double lowest = 0.0;
    const auto ahead = [&](double pitch) {
      const StationState state = exact(pitch, roll);
      return state.moving() && std::abs(state.leftward_m_s) < state.forward_m_s;
    };
    while (ahead(lowest)) lowest -= 0.1;
    EXPECT_TRUE(table.at(rad_from_deg(lowest - 0.1), rad_from_deg(roll))->immobile) << roll;
    EXPECT_FALSE(table.at(rad_from_deg(lowest + 0.2), rad_from_deg(roll))->immobile) << roll;
  }
  EXPECT_EQ(table.at(rad_from_deg(-25.0), 0.0)->slip_ratio, 1.0);
}

TEST(TractionLimit, IsTheSlopeOnWhichTheWheelsSpin) {
  const RoverModel rover = six_wheeler();
  const DriveCommand command{.speed_m_s = rover.cruise_speed_m_s};
  const Soil soil = loose_sand();
  TractionLimitSearch search(rover, 3.71, soil, command, rad_from_deg(-40.0), rad_from_deg(30.0));
  const std::optional<double> limit = search.find(0.0, std::nullopt);
  ASSERT_TRUE(limit);
  QuasiStaticSolver solver(rover, 3.71);
  const auto slip_at = [&](double pitch) {
    const Attitude attitude{.roll_rad = 0.0, .pitch_rad = pitch, .yaw_rad = 0.0};
    return solver.solve(stance_on_plane(rover, attitude), soil, command);
  };
  EXPECT_TRUE(slip_at(*limit).moving());
  EXPECT_GT(slip_at(*limit).slip_ratio, 0.85);
  EXPECT_FALSE(slip_at(*limit - rad_from_deg(0.1)).moving());
  // From a neighbour's limit the search ends at the same place.
  EXPECT_NEAR(*search.find(0.0, *limit + rad_from_deg(1.5)), *limit, rad_from_deg(0.03));
}

TEST(TractionLimit, OfASideSlopeTooSteepToHoldIsNone) {
  const RoverModel rover = six_wheeler();
  const Soil soil = make_soil({3125.0, 536156.0, 0.867}, 0.0, 20.0, 0.0171, 0.285, 0.32);
  TractionLimitSearch search(rover, 3.71, soil, {.speed_m_s = rover.cruise_speed_m_s}, rad_from_deg(-40.0),
                             rad_from_deg(20.0));
  EXPECT_FALSE(search.find(rad_from_deg(35.0), std::nullopt));
}

}  // namespace
}  // namespace slipway::sim
