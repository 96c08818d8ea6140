#include "sim/dynamic/multibody.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <new>
#include <numbers>
#include <stdexcept>

#include "core/random.h"
#include "tests/sim/reference_multibodies.h"
#include "tests/sim/simbody_multibody.h"

namespace {
std::atomic<long> allocations = 0;
}

// Counts what this executable allocates.
void* operator new(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}

namespace slipway::sim {
namespace {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

// Numbers in (-1, 1), one after the other.
class Symmetric {
 public:
  explicit Symmetric(std::uint64_t key) : key_(key) {}
  double number() { return 2.0 * random_uniform(key_, next_++) - 1.0; }
  Vector3d vector() {
    const double x = number(), y = number(), z = number();
    return {x, y, z};
  }
  Eigen::VectorXd numbers(int count) {
    Eigen::VectorXd all(count);
    for (double& one : all) one = number();
    return all;
  }
  Matrix3d rotation() {
    const double w = number();
    const Vector3d v = vector();
    return Quaterniond(w, v.x(), v.y(), v.z()).normalized().toRotationMatrix();
  }

 private:
  std::uint64_t key_, next_ = 0;
};

// Any motion under any load, fast enough that no velocity-dependent term is small.
LoadedState any_state(const Multibody& multibody, std::uint64_t trial) {
  Symmetric any(random_key(11, trial));
  LoadedState state;
  state.R_MB = any.rotation();
  state.base << 2.0 * any.vector(), 3.0 * any.vector();
  state.angles_rad = std::numbers::pi * any.numbers(multibody.joint_count());
  state.rates_rad_s = 5.0 * any.numbers(multibody.joint_count());
  state.torques_nm = 20.0 * any.numbers(multibody.joint_count());
  for (int body = -1; body < multibody.joint_count(); ++body)
    state.forces.push_back({body, any.vector(), 200.0 * any.vector(), 30.0 * any.vector()});
  state.gravity_M = 9.81 * any.vector();
  return state;
}

void set(MultibodyDynamics& dynamics, const LoadedState& state) {
  dynamics.set_state(state.R_MB, state.base, state.angles_rad.data(), state.rates_rad_s.data());
  for (const LoadedState::Force& force : state.forces)
    dynamics.add_force(force.body, force.p_B, force.force_B, force.moment_B);
  for (int i = 0; i < state.torques_nm.size(); ++i) dynamics.add_torque(i, state.torques_nm[i]);
}

Accelerations accelerations(MultibodyDynamics& dynamics, const LoadedState& state) {
  set(dynamics, state);
  Accelerations found{SpatialVector::Zero(), Eigen::VectorXd(state.angles_rad.size())};
  dynamics.accelerations(state.gravity_M, found.base, found.joints.data());
  return found;
}

Accelerations accelerations(const Multibody& multibody, const LoadedState& state) {
  MultibodyDynamics dynamics(multibody);
  return accelerations(dynamics, state);
}

TEST(Multibody, AgreesWithSimbodyInAnyMotionUnderAnyLoad) {
  for (const int steerings : {4, 6}) {
    const Multibody multibody = rocker_bogie_rover(steerings);
    MultibodyDynamics dynamics(multibody);
    SimbodyMultibody simbody(multibody);
    double worst = 0.0;
    for (std::uint64_t trial = 0; trial < 500; ++trial) {
      const LoadedState state = any_state(multibody, trial);
      const Accelerations ours = accelerations(dynamics, state), theirs = simbody.accelerations(state);
      worst = std::max({worst,
                        (ours.base.head<3>() - theirs.base.head<3>()).norm() / theirs.base.head<3>().norm(),
                        (ours.base.tail<3>() - theirs.base.tail<3>()).norm() / theirs.base.tail<3>().norm(),
                        (ours.joints - theirs.joints).norm() / theirs.joints.norm()});
    }
    EXPECT_LT(worst, 1e-11) << steerings;
  }
}

// By d'Alembert a rotor's inertia is a torque against its joint's acceleration.
TEST(Multibody, AnArmatureIsATorqueAgainstItsJointsAcceleration) {
  const double armature = 0.7;
  const Multibody with = rocker_bogie_rover(4, armature), without = rocker_bogie_rover(4);
  for (std::uint64_t trial = 0; trial < 50; ++trial) {
    LoadedState state = any_state(with, trial);
    const Accelerations expected = accelerations(with, state);
    for (int i = 0; i < with.joint_count(); ++i)
      state.torques_nm[i] -= with.bodies()[i].armature_kg_m2 * expected.joints[i];
    const Accelerations found = accelerations(without, state);
    EXPECT_LT((found.base - expected.base).norm(), 1e-9 * expected.base.norm()) << trial;
    EXPECT_LT((found.joints - expected.joints).norm(), 1e-9 * expected.joints.norm()) << trial;
  }
}

TEST(Multibody, AMotorTurnsItsWheelAgainstAFreeBase) {
  // About the y axis, both centres of mass on it: I (alpha + qdd) + A qdd = tau, J alpha = -I (alpha + qdd).
  const double base_inertia = 3.0, wheel_inertia = 0.2, armature = 0.5, torque = 4.0;
  const Multibody multibody({10.0, Vector3d::Zero(), base_inertia * Matrix3d::Identity()},
                            {{.name = "wheel",
                              .mass = {2.0, Vector3d::Zero(), wheel_inertia * Matrix3d::Identity()},
                              .armature_kg_m2 = armature,
                              .round = true}});
  LoadedState state;
  state.angles_rad = state.rates_rad_s = Eigen::VectorXd::Zero(1);
  state.torques_nm = Eigen::VectorXd::Constant(1, torque);
  const Accelerations found = accelerations(multibody, state);
  const double reduced = base_inertia * wheel_inertia / (base_inertia + wheel_inertia);
  const double joint = torque / (armature + reduced);
  EXPECT_NEAR(found.joints[0], joint, 1e-12 * joint);
  EXPECT_NEAR(found.base[1], -wheel_inertia / (base_inertia + wheel_inertia) * joint, 1e-12 * joint);
}

TEST(Multibody, APendulumOnAHeavyBaseThatIsHeldSwingsAsAPhysicalPendulum) {
  const double base_mass = 1e12, mass = 1.5, arm = 0.4, inertia = 0.03, armature = 0.01, g = 3.71;
  const Multibody multibody({base_mass, Vector3d::Zero(), base_mass * Matrix3d::Identity()},
                            {{.name = "pendulum",
                              .pivot_m = {0.2, 0.1, -0.3},
                              .mass = {mass, Vector3d(0.2, 0.1, -0.3 - arm), inertia * Matrix3d::Identity()},
                              .armature_kg_m2 = armature}});
  for (double angle = -3.0; angle < 3.1; angle += 0.4) {
    LoadedState state;
    state.angles_rad = Eigen::VectorXd::Constant(1, angle);
    state.rates_rad_s = Eigen::VectorXd::Constant(1, 0.9);
    state.forces.push_back({-1, Vector3d::Zero(), {0.0, 0.0, base_mass * g}, Vector3d::Zero()});
    state.gravity_M = {0.0, 0.0, -g};
    const Accelerations found = accelerations(multibody, state);
    const double expected = -mass * g * arm * std::sin(angle) / (inertia + mass * arm * arm + armature);
    EXPECT_NEAR(found.joints[0], expected, 1e-9) << angle;
    EXPECT_NEAR(found.base.norm(), 0.0, 1e-9);
  }
}

TEST(Multibody, AnInfiniteArmatureWeldsAJoint) {
  const double forever = std::numeric_limits<double>::infinity();
  MassProperties base{5.0, Vector3d(0.1, 0.0, 0.2), Vector3d(1.0, 2.0, 3.0).asDiagonal()};
  const MassProperties arm{1.0, Vector3d(0.9, -0.2, 0.4), 0.1 * Matrix3d::Identity()};
  LoadedState state;
  state.base << 0.3, -0.2, 0.5, 1.0, 0.2, -0.4;
  state.gravity_M = {0.0, 0.0, -3.71};
  state.forces.push_back({-1, {1.0, 0.5, 0.0}, {3.0, 20.0, -7.0}, {1.0, 2.0, 3.0}});
  state.angles_rad = state.rates_rad_s = state.torques_nm = Eigen::VectorXd::Zero(1);
  const Multibody welded(
      base, {{.name = "arm", .pivot_m = {0.5, 0.0, 0.3}, .mass = arm, .armature_kg_m2 = forever}});
  const Accelerations found = accelerations(welded, state);
  EXPECT_EQ(found.joints[0], 0.0);
  MultibodyDynamics dynamics(welded);
  set(dynamics, state);
  EXPECT_TRUE(std::isfinite(dynamics.kinetic_energy_j()));
  // One body of both.
  MassProperties both{6.0, (5.0 * base.com_m + arm.com_m) / 6.0, Matrix3d::Zero()};
  for (const MassProperties& part : {base, arm}) {
    const Vector3d d = part.com_m - both.com_m;
    both.inertia_kg_m2 +=
        part.inertia_kg_m2 + part.mass_kg * (d.squaredNorm() * Matrix3d::Identity() - d * d.transpose());
  }
  state.angles_rad = state.rates_rad_s = state.torques_nm = Eigen::VectorXd();
  EXPECT_LT((accelerations(Multibody(both, {}), state).base - found.base).norm(), 1e-12 * found.base.norm());
}

TEST(Multibody, FallingFreelyNoJointMovesAndEveryPointFallsAlike) {
  const Multibody multibody = rocker_bogie_rover();
  LoadedState state = any_state(multibody, 0);
  state.base.setZero();
  state.rates_rad_s.setZero();
  state.torques_nm.setZero();
  state.forces.clear();
  const Accelerations found = accelerations(multibody, state);
  EXPECT_EQ(found.joints.norm(), 0.0);
  EXPECT_EQ(found.base.head<3>().norm(), 0.0);
  EXPECT_NEAR((state.R_MB * found.base.tail<3>() - state.gravity_M).norm(), 0.0, 1e-14);
}

// The state of a free tree: attitude and position of B, its velocity, and the joints.
struct Tumbling {
  Quaterniond q_MB;
  Vector3d p_M;
  SpatialVector base;
  Eigen::VectorXd angles_rad, rates_rad_s;
};

Tumbling moved(const Tumbling& from, const Tumbling& rate, double step) {
  return {Quaterniond(from.q_MB.coeffs() + step * rate.q_MB.coeffs()), from.p_M + step * rate.p_M,
          from.base + step * rate.base, from.angles_rad + step * rate.angles_rad,
          from.rates_rad_s + step * rate.rates_rad_s};
}

void set(MultibodyDynamics& dynamics, const Tumbling& state) {
  dynamics.set_state(state.q_MB.normalized().toRotationMatrix(), state.base, state.angles_rad.data(),
                     state.rates_rad_s.data());
}

Tumbling rate_of(MultibodyDynamics& dynamics, const Tumbling& state) {
  set(dynamics, state);
  const Vector3d omega = state.base.head<3>();
  Tumbling rate{Quaterniond(0.5 * (state.q_MB * Quaterniond(0.0, omega.x(), omega.y(), omega.z())).coeffs()),
                state.q_MB.normalized() * Vector3d(state.base.tail<3>()), SpatialVector::Zero(),
                state.rates_rad_s, state.rates_rad_s};
  dynamics.accelerations(Vector3d::Zero(), rate.base, rate.rates_rad_s.data());
  return rate;
}

Tumbling runge_kutta(MultibodyDynamics& dynamics, const Tumbling& now, double step) {
  const Tumbling k1 = rate_of(dynamics, now), k2 = rate_of(dynamics, moved(now, k1, 0.5 * step)),
                 k3 = rate_of(dynamics, moved(now, k2, 0.5 * step)),
                 k4 = rate_of(dynamics, moved(now, k3, step));
  return moved(moved(moved(moved(now, k1, step / 6.0), k2, step / 3.0), k3, step / 3.0), k4, step / 6.0);
}

struct Kept {
  double energy_j;
  Vector3d momentum_M, angular_momentum_M;  // about the map's origin
};

Kept kept(MultibodyDynamics& dynamics, const Tumbling& state) {
  set(dynamics, state);
  const SpatialVector momentum = dynamics.momentum();
  const Matrix3d R_MB = state.q_MB.normalized().toRotationMatrix();
  const Vector3d linear = R_MB * momentum.tail<3>();
  return {dynamics.kinetic_energy_j(), linear, R_MB * momentum.head<3>() + state.p_M.cross(linear)};
}

TEST(Multibody, TumblingFreelyKeepsEnergyAndBothMomenta) {
  const Multibody multibody = rocker_bogie_rover(4, 0.05);
  MultibodyDynamics dynamics(multibody);
  Symmetric any(5);
  Tumbling state{Quaterniond(any.rotation()), any.vector(), SpatialVector::Zero(),
                 any.numbers(multibody.joint_count()), any.numbers(multibody.joint_count())};
  state.base << 0.7 * any.vector(), any.vector();
  const Eigen::VectorXd first_rad = state.angles_rad;
  const Kept before = kept(dynamics, state);
  double energy = 0.0, momentum = 0.0, angular = 0.0;
  for (int i = 0; i < 10000; ++i) {
    state = runge_kutta(dynamics, state, 1e-3);
    if (i % 100 != 99) continue;
    const Kept now = kept(dynamics, state);
    energy = std::max(energy, std::abs(now.energy_j / before.energy_j - 1.0));
    momentum = std::max(momentum, (now.momentum_M - before.momentum_M).norm() / before.momentum_M.norm());
    angular = std::max(angular, (now.angular_momentum_M - before.angular_momentum_M).norm() /
                                    before.angular_momentum_M.norm());
  }
  EXPECT_GT((state.angles_rad - first_rad).cwiseAbs().minCoeff(), 0.1) << "every joint has turned";
  EXPECT_LT(energy, 1e-11) << "over 10 s";
  EXPECT_LT(momentum, 1e-11);
  EXPECT_LT(angular, 1e-11);
}

TEST(Multibody, EnergyChangesByThePowerOfTheForces) {
  const Multibody multibody = rocker_bogie_rover(6, 0.05);
  MultibodyDynamics dynamics(multibody);
  for (std::uint64_t trial = 0; trial < 20; ++trial) {
    const LoadedState state = any_state(multibody, trial);
    const Accelerations found = accelerations(dynamics, state);
    double power = state.torques_nm.dot(state.rates_rad_s);
    for (const LoadedState::Force& force : state.forces) {
      const SpatialVector v = dynamics.velocity(force.body);
      power +=
          dynamics.point_velocity(force.body, force.p_B).dot(force.force_B) + v.head<3>().dot(force.moment_B);
    }
    power += state.gravity_M.dot(state.R_MB * dynamics.momentum().tail<3>());
    const auto energy_after = [&](double time) {
      const Eigen::VectorXd angles = state.angles_rad + time * state.rates_rad_s;
      const Eigen::VectorXd rates = state.rates_rad_s + time * found.joints;
      dynamics.set_state(state.R_MB, state.base + time * found.base, angles.data(), rates.data());
      return dynamics.kinetic_energy_j();
    };
    const double step = 1e-5;
    const double change = (energy_after(step) - energy_after(-step)) / (2.0 * step);
    EXPECT_NEAR(change, power, 1e-5 * std::abs(power) + 1e-3) << trial;
  }
}

TEST(Multibody, TheCentreOfMassMovesWithTheMomentum) {
  const Multibody multibody = rocker_bogie_rover();
  MultibodyDynamics dynamics(multibody);
  const LoadedState state = any_state(multibody, 3);
  set(dynamics, state);
  const Vector3d com = dynamics.com_B(), momentum = dynamics.momentum().tail<3>();
  const double step = 1e-6;
  const auto com_after = [&](double time) -> Vector3d {
    const Eigen::VectorXd angles = state.angles_rad + time * state.rates_rad_s;
    dynamics.set_state(state.R_MB, state.base, angles.data(), state.rates_rad_s.data());
    return dynamics.com_B();
  };
  const Vector3d seen_from_B = (com_after(step) - com_after(-step)) / (2.0 * step);
  const Vector3d velocity = seen_from_B + state.base.tail<3>() + state.base.head<3>().cross(com);
  EXPECT_NEAR((multibody.mass_kg() * velocity - momentum).norm(), 0.0, 1e-6 * momentum.norm());
}

TEST(Multibody, NothingIsAllocatedOnceItIsBuilt) {
  const Multibody multibody = rocker_bogie_rover();
  MultibodyDynamics dynamics(multibody);
  const LoadedState state = any_state(multibody, 0);
  Accelerations found{SpatialVector::Zero(), Eigen::VectorXd(multibody.joint_count())};
  const long before = allocations;
  for (int i = 0; i < 10; ++i) {
    set(dynamics, state);
    dynamics.accelerations(state.gravity_M, found.base, found.joints.data());
  }
  EXPECT_EQ(allocations, before);
  EXPECT_GT(before, 0) << "they are counted";
}

TEST(Multibody, RefusesTreesThatCannotMoveAndWheelsThatAreNotRound) {
  const MassProperties some{1.0, Vector3d::Zero(), Matrix3d::Identity()};
  EXPECT_THROW(Multibody(some, {{.name = "a", .parent = 1, .mass = some}, {.name = "b", .mass = some}}),
               std::invalid_argument);
  EXPECT_THROW(Multibody(some, {{.name = "nothing"}}), std::invalid_argument);
  const MassProperties box{1.0, Vector3d::Zero(), Vector3d(1.0, 2.0, 2.5).asDiagonal()};
  EXPECT_THROW(Multibody(some, {{.name = "wheel", .mass = box, .round = true}}), std::invalid_argument);
  EXPECT_THROW(Multibody(some, {{.name = "wheel", .pivot_m = {0.1, 0.0, 0.0}, .mass = some, .round = true}}),
               std::invalid_argument);
  EXPECT_NO_THROW(Multibody(some, {{.name = "rotor", .armature_kg_m2 = 0.1}}));
}

}  // namespace
}  // namespace slipway::sim
