#include "sim/dynamic/rover_dynamics.h"

#include <gtest/gtest.h>

#include <vector>

#include "sim/rover/stance.h"
#include "tests/sim/reference_models.h"

namespace slipway::sim {
namespace {

constexpr double kMars = 3.71;

class LevelStart : public testing::Test {
 protected:
  LevelStart() : dynamics_(rover_, kMars, level_, soils_, options_) {
    state_ = dynamics_.at_rest(stance_on_plane(rover_, {}));
    dynamics_.halt(PerWheel<double>(rover_.wheels.size()));
    dynamics_.after_step(0.0, state_.data());
  }

  const RoverModel rover_ = six_wheeler();
  const FunctionGround level_{[](double, double) { return 0.0; }, 3.0};
  const DriveSoils soils_{{sandy_loam()}, sandy_loam()};
  const DynamicOptions options_;
  RoverDynamics dynamics_;
  std::vector<double> state_;
};

// Ground that is lost on a trial step and found on a shorter one must not be the reason of a later failure.
TEST_F(LevelStart, LostGroundIsForgottenWithTheNextStep) {
  std::vector<double> rate(state_.size()), values(static_cast<std::size_t>(dynamics_.event_count())),
      off = state_;
  off[0] = 5.0;
  EXPECT_FALSE(dynamics_.derivative(0.1, off.data(), rate.data()));
  ASSERT_TRUE(dynamics_.lost_ground());
  EXPECT_GT(dynamics_.lost_ground()->x(), 3.0);
  dynamics_.after_step(0.1, state_.data());
  EXPECT_FALSE(dynamics_.lost_ground());
  EXPECT_FALSE(dynamics_.events(0.2, off.data(), values.data()));
  EXPECT_TRUE(dynamics_.lost_ground());
}

}  // namespace
}  // namespace slipway::sim
