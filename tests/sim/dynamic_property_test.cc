#include <gtest/gtest.h>

#include <cmath>

#include "core/angle.h"
#include "core/random.h"
#include "sim/dynamic/dynamic_drive.h"
#include "tests/sim/reference_models.h"

namespace slipway::sim {
namespace {

class Dice {
 public:
  explicit Dice(std::uint64_t key) : key_(key) {}
  double in(double low, double high) { return low + (high - low) * random_uniform(key_, next_++); }
  bool one_in(double n) { return in(0.0, 1.0) < 1.0 / n; }
  double magnitude(double low, double high) { return std::pow(10.0, in(low, high)); }

 private:
  std::uint64_t key_, next_ = 0;
};

RoverModel any_rover(Dice& dice) {
  const int kind = static_cast<int>(dice.in(0.0, 5.0));
  RoverModel rover = kind == 0   ? six_wheeler()
                     : kind == 1 ? all_steered(six_wheeler())
                     : kind == 2 ? four_wheeler(SuspensionType::kAveraging)
                     : kind == 3 ? four_wheeler(SuspensionType::kRigid)
                                 : even_wheeler(SuspensionType::kRigid, 4);
  if (dice.one_in(3.0)) rover.wheel_slices = 3;
  if (dice.one_in(3.0)) {
    WheelModel& wheel = rover.wheels[static_cast<std::size_t>(dice.in(0.0, 4.0))];
    wheel.drive = dice.one_in(2.0) ? WheelDrive::kLocked : WheelDrive::kFree;
    wheel.drag_nm = dice.in(0.0, 2.0);
  }
  return rover;
}

Soil any_soil(Dice& dice) {
  Soil soil =
      make_soil({dice.in(-2e3, 4e4), dice.magnitude(4.5, 7.0), dice.in(0.5, 1.4)}, dice.magnitude(0.0, 4.0),
                dice.in(15.0, 45.0), dice.magnitude(-3.0, -1.3), dice.in(0.1, 0.6), dice.in(0.0, 0.4));
  if (dice.one_in(3.0)) soil.n1 = dice.in(0.0, 0.8);
  if (dice.one_in(3.0)) soil.multipass_stiffening = dice.in(0.0, 2.0);
  if (dice.one_in(3.0)) soil.bulldozing = dice.in(0.0, 1.0);
  if (dice.one_in(3.0)) soil.side_bulldozing = dice.in(0.0, 1.0);
  if (dice.one_in(3.0)) soil.side_mobilised_rad = rad_from_deg(dice.in(1.0, 90.0));
  if (dice.one_in(5.0)) soil.crust = {dice.in(0.0, 3e4), dice.in(0.005, 0.02)};
  if (dice.one_in(5.0)) soil.rate_shear_exponent = dice.in(-0.3, 0.3);
  return soil;
}

std::vector<DriveLeg> any_legs(Dice& dice) {
  std::vector<DriveLeg> legs(1 + static_cast<std::size_t>(dice.in(0.0, 2.0)));
  for (DriveLeg& leg : legs) {
    leg.command.turn_in_place = dice.one_in(3.0);
    leg.command.turn_rate_rad_s = dice.one_in(2.0) ? 0.05 : -0.05;
    leg.turn_rad = dice.in(0.05, 1.0);
    leg.command.speed_m_s = (dice.one_in(2.0) ? 1.0 : -1.0) * dice.in(0.01, 0.06);
    if (dice.one_in(2.0)) leg.command.curvature_1_m = dice.in(-0.6, 0.6);
    if (dice.one_in(5.0)) leg.command.crab_rad = dice.in(-0.8, 0.8);
    leg.length_m = dice.in(0.2, 1.0);
  }
  return legs;
}

bool is_finite(const DriveSample& sample) {
  bool finite =
      sample.p_MB.allFinite() && sample.velocity_B.allFinite() && sample.specific_force_B.allFinite();
  for (const WheelState& wheel : sample.wheels)
    finite = finite && std::isfinite(wheel.load_n) && std::isfinite(wheel.current_a) &&
             std::isfinite(wheel.torque_nm) && std::isfinite(wheel.sinkage_m);
  return finite;
}

class AnyDrive : public testing::TestWithParam<int> {};

// Every drive has an answer or a refusal with its reason, and never a NaN, a hang or a crash.
TEST_P(AnyDrive, HasAnAnswerOrAReason) {
  for (int n = 0; n < 40; ++n) {
    Dice dice(random_key(2026, static_cast<std::uint64_t>(GetParam() * 40 + n)));
    const RoverModel rover = any_rover(dice);
    const Soil soil = any_soil(dice);
    const double slope = std::tan(rad_from_deg(dice.in(0.0, 35.0)));
    const double rough = dice.one_in(2.0) ? dice.in(0.0, 0.15) : 0.0;
    const FunctionGround ground([=](double x, double y) {
      return slope * x + rough * (std::sin(3.0 * x) * std::cos(2.3 * y) +
                                  0.5 * std::sin(7.0 * x + 1.0) * std::sin(5.0 * y) +
                                  0.25 * std::sin(17.0 * x + 1.0) * std::sin(15.0 * y));
    });
    DynamicOptions options;
    options.feedback = static_cast<Feedback>(static_cast<int>(dice.in(0.0, 3.0)));
    options.contact_points = dice.one_in(2.0) ? 1 : 3;
    options.give_up_s = 20.0;
    const std::vector<DriveLeg> legs = any_legs(dice);
    const double gravity = dice.one_in(3.0) ? 9.81 : 3.71;
    const Pose2 start{dice.in(-3.0, 3.0), dice.in(-3.0, 3.0), dice.in(-3.1, 3.1)};
    bool finite = true;
    NoProgress progress;
    const auto drive = simulate_drive(
        rover, gravity, ground, {{soil}, soil}, start, legs, options,
        [&](const DriveSample& sample) { finite = finite && is_finite(sample); }, progress);
    EXPECT_TRUE(finite) << n;
    if (drive) {
      EXPECT_EQ(drive->reason.empty(), drive->end == DriveEnd::kFinished) << n;
      EXPECT_TRUE(std::isfinite(drive->energy_j) && drive->energy_j >= 0.0) << n;
    } else {
      EXPECT_FALSE(drive.error().detail.empty()) << n;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, AnyDrive, testing::Range(0, 4));

}  // namespace
}  // namespace slipway::sim
