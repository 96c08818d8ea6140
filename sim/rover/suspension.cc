#include "sim/rover/suspension.h"

#include <Eigen/Geometry>

namespace slipway::sim {
namespace {

// Pivots are given for the left side.
Eigen::Vector3d on_side(const Eigen::Vector3d& left, Side side) {
  return side == Side::kLeft ? left : Eigen::Vector3d(left.x(), -left.y(), left.z());
}

bool hangs_on_bogie(const RoverModel& rover, const WheelModel& wheel) {
  return rover.suspension.type == SuspensionType::kRockerBogie && wheel.on_bogie;
}

}  // namespace

int joint_count(SuspensionType type) {
  switch (type) {
    case SuspensionType::kRockerBogie:
      return 3;
    case SuspensionType::kAveraging:
      return 1;
    case SuspensionType::kRigid:
      return 0;
  }
  return 0;
}

int undetermined_loads(const RoverModel& rover) {
  return static_cast<int>(rover.wheels.size()) - 3 - joint_count(rover.suspension.type);
}

void place_wheels(const RoverModel& rover, Stance& stance) {
  if (stance.p_B_wheel.size() != rover.wheels.size())
    stance.p_B_wheel = PerWheel<Eigen::Vector3d>(rover.wheels.size());
  if (rover.suspension.type == SuspensionType::kRigid) {
    for (std::size_t k = 0; k < rover.wheels.size(); ++k) stance.p_B_wheel[k] = rover.wheels[k].position_m;
    return;
  }
  for (const Side side : {Side::kLeft, Side::kRight}) {
    const bool left = side == Side::kLeft;
    const Eigen::Vector3d rocker = on_side(rover.suspension.rocker_pivot_m, side);
    const Eigen::Vector3d bogie = on_side(rover.suspension.bogie_pivot_m, side);
    const Eigen::AngleAxisd turn_rocker(left ? stance.rocker_rad : -stance.rocker_rad,
                                        Eigen::Vector3d::UnitY());
    const Eigen::AngleAxisd turn_bogie(stance.bogie_rad[left ? 0 : 1], Eigen::Vector3d::UnitY());
    const Eigen::Vector3d pivot = rocker + turn_rocker * (bogie - rocker);
    (left ? stance.p_B_left_bogie : stance.p_B_right_bogie) = pivot;
    for (std::size_t k = 0; k < rover.wheels.size(); ++k) {
      const WheelModel& wheel = rover.wheels[k];
      if (wheel.side != side) continue;
      stance.p_B_wheel[k] =
          hangs_on_bogie(rover, wheel)
              ? Eigen::Vector3d(pivot + turn_rocker * (turn_bogie * (wheel.position_m - bogie)))
              : Eigen::Vector3d(rocker + turn_rocker * (wheel.position_m - rocker));
    }
  }
}

JointMotion joint_motion(const RoverModel& rover, const Stance& stance, std::size_t k, int joint) {
  const WheelModel& wheel = rover.wheels[k];
  const bool left = wheel.side == Side::kLeft;
  const auto turning_about = [&](const Eigen::Vector3d& pivot, double turn) {
    return JointMotion{turn * Eigen::Vector3d::UnitY().cross(stance.p_B_wheel[k] - pivot), turn};
  };
  if (joint == 0)
    return turning_about(on_side(rover.suspension.rocker_pivot_m, wheel.side), left ? 1.0 : -1.0);
  if (!hangs_on_bogie(rover, wheel) || left != (joint == 1)) return {};
  return turning_about(left ? stance.p_B_left_bogie : stance.p_B_right_bogie, 1.0);
}

}  // namespace slipway::sim
