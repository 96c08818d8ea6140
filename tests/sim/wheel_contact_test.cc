#include "sim/dynamic/wheel_contact.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/sim/reference_models.h"

namespace slipway::sim {
namespace {

constexpr double kMars = 3.71, kStandstill = 0.003;

class Contact : public testing::Test {
 protected:
  Contact() { use(six_wheeler()); }

  void use(const RoverModel& rover, const Soil& soil = sandy_loam()) {
    rover_ = rover;
    contacts_.emplace(rover_, kMars, 1, kStandstill);
    for (std::size_t k = 0; k < rover_.wheels.size(); ++k) contacts_->set_soil(k, soil, 0.04);
  }

  // A wheel 12 mm deep in level ground, steadily turning and slipping.
  WheelKinematics steady(double rate_rad_s, double u, double leftward = 0.0) const {
    WheelKinematics at;
    const double r = 0.125;
    at.centre = {0.0, 0.0, r - 0.012};
    at.rate_rad_s = rate_rad_s;
    at.velocity = {u * r * rate_rad_s, leftward * r * std::abs(rate_rad_s), 0.0};
    at.slip_x = (1.0 - u) * (rate_rad_s < 0.0 ? -1.0 : 1.0);
    at.slip_y = -leftward;
    return at;
  }

  ContactState find(const WheelKinematics& at) const {
    PerWheel<WheelKinematics> wheels(rover_.wheels.size(), at);
    PerWheel<ContactState> contacts(rover_.wheels.size());
    const FunctionGround level([](double, double) { return 0.0; });
    EXPECT_TRUE(contacts_->find(level, RutMap(), wheels, contacts));
    return contacts[0];
  }

  RoverModel rover_;
  std::optional<WheelContacts> contacts_;
};

TEST_F(Contact, InSteadyMotionIsTheLawAtItsSlip) {
  Soil soil = sandy_loam();
  soil.gravity_m_s2 = kMars;
  for (const double u : {0.2, 0.7, 1.0, 1.4})
    for (const double leftward : {-0.3, 0.0, 0.2}) {
      const ContactState contact = find(steady(0.32, u, leftward));
      const WheelForces law =
          wheel_forces(rover_.wheels[0].geometry(), soil, entry_angle_rad(0.125, 0.012), {u, leftward});
      EXPECT_NEAR(contact.load_n, law.vertical_n, 1e-9 * law.vertical_n);
      EXPECT_NEAR(contact.drawbar_pull_n, law.drawbar_pull_n, 1e-9 * law.vertical_n);
      EXPECT_NEAR(contact.lateral_n, law.lateral_n, 1e-9 * law.vertical_n);
      EXPECT_NEAR(contact.torque_nm, law.torque_nm, 1e-9 * law.vertical_n);
      EXPECT_NEAR(contact.slip_x_rate, 0.0, 1e-12);
      EXPECT_NEAR(contact.slip_y_rate, 0.0, 1e-12);
    }
}

TEST_F(Contact, BackwardsIsTheMirrorOfForwards) {
  const ContactState ahead = find(steady(0.32, 0.8, 0.1)), back = find(steady(-0.32, 0.8, 0.1));
  EXPECT_DOUBLE_EQ(back.drawbar_pull_n, -ahead.drawbar_pull_n);
  EXPECT_DOUBLE_EQ(back.torque_nm, -ahead.torque_nm);
  EXPECT_DOUBLE_EQ(back.lateral_n, ahead.lateral_n);
  EXPECT_DOUBLE_EQ(back.load_n, ahead.load_n);
}

// Nothing jumps where a wheel reverses.
TEST_F(Contact, PassesSmoothlyThroughRest) {
  WheelKinematics at = steady(0.32, 1.0);
  at.velocity.setZero();
  at.slip_x = 0.2;
  const double most = 2.0 * std::abs(find(at).drawbar_pull_n) + 100.0;
  double last = NAN;
  for (double rate = -0.05; rate <= 0.05; rate += 1e-5) {
    at.rate_rad_s = rate;
    const double pull = find(at).drawbar_pull_n;
    if (!std::isnan(last)) {
      EXPECT_LT(std::abs(pull - last), 0.01 * most) << rate;
    }
    last = pull;
  }
}

TEST_F(Contact, SoilResistsAWheelThatSlidesBackAgainstItsRolling) {
  const double spinning = find(steady(0.32, 0.0)).drawbar_pull_n;
  const double sliding = find(steady(0.32, -0.5)).drawbar_pull_n;
  EXPECT_GT(sliding, spinning + 5.0);
  double last = spinning;
  for (double u = 0.0; u > -0.6; u -= 0.001) {
    const double pull = find(steady(0.32, u)).drawbar_pull_n;
    EXPECT_LT(std::abs(pull - last), 1.0) << u;
    last = pull;
  }
}

TEST_F(Contact, DampsSinkingAndNeverPullsTheWheelDown) {
  WheelKinematics at = steady(0.32, 0.9);
  const double steady_n = find(at).load_n;
  at.velocity.z() = -0.01;
  EXPECT_GT(find(at).load_n, steady_n);
  at.velocity.z() = 10.0;
  EXPECT_EQ(find(at).load_n, 0.0);
}

TEST_F(Contact, HasNoForceInTheAir) {
  WheelKinematics at = steady(0.32, 0.9);
  at.centre.z() = 0.126;
  const ContactState contact = find(at);
  EXPECT_LT(contact.depth_m, 0.0);
  EXPECT_TRUE(contact.force.isZero());
  EXPECT_TRUE(contact.moment.isZero());
}

TEST_F(Contact, SlicesOfAWheelOnLevelGroundAreTheWholeWheel) {
  const ContactState whole = find(steady(0.32, 0.8, 0.1));
  RoverModel sliced = six_wheeler();
  sliced.wheel_slices = 5;
  use(sliced);
  const ContactState slices = find(steady(0.32, 0.8, 0.1));
  EXPECT_NEAR((slices.force - whole.force).norm(), 0.0, 1e-9 * whole.load_n);
  EXPECT_NEAR((slices.moment - whole.moment).norm(), 0.0, 1e-9 * whole.load_n);
}

// Points under a wheel agree on any plane.
TEST_F(Contact, SeveralPointsOnAPlaneAreOne) {
  const FunctionGround slope([](double x, double y) { return 0.3 * x - 0.2 * y; });
  WheelKinematics at;
  at.centre = {0.0, 0.0, 0.12};
  ContactState one, five;
  ASSERT_TRUE(contacts_->find_ground(slope, RutMap(), 0, at, one));
  ASSERT_TRUE(WheelContacts(rover_, kMars, 5, kStandstill).find_ground(slope, RutMap(), 0, at, five));
  EXPECT_NEAR(five.depth_m, one.depth_m, 1e-9);
  EXPECT_NEAR((five.normal - one.normal).norm(), 0.0, 1e-9);
}

}  // namespace
}  // namespace slipway::sim
