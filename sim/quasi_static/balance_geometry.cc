#include "sim/quasi_static/balance_geometry.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>

#include "core/pose.h"

namespace slipway::sim {
namespace {

// The speed scale where no wheel is commanded to turn and the rover not to move; any scale serves then.
constexpr double kMinSpeedScale_m_s = 1e-9;

double half_wheelbase(const RoverModel& rover) {
  double front = rover.wheels.front().position_m.x(), rear = front;
  for (const WheelModel& wheel : rover.wheels) {
    front = std::max(front, wheel.position_m.x());
    rear = std::min(rear, wheel.position_m.x());
  }
  return 0.5 * (front - rear);
}

// A force at p and a moment, in frame B.
struct Wrench {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();  // about the point where the force acts
};

}  // namespace

BalanceGeometry::BalanceGeometry(const RoverModel& rover_model, double g_m_s2, const Stance& at,
                                 const DriveCommand& commanded)
    : rover(&rover_model),
      stance(&at),
      command(commanded),
      gravity_m_s2(g_m_s2),
      joints(joint_count(rover_model.suspension.type)),
      undetermined(undetermined_loads(rover_model)),
      travel(travel_direction(commanded)),
      weight_n(rover_model.mass_kg * g_m_s2),
      half_wheelbase_m(half_wheelbase(rover_model)),
      attainable_share(sim::attainable_share(rover_model, commanded)),
      drive(at_temperature(rover_model.drive,
                           commanded.motor_temp_c.value_or(rover_model.drive.reference_temp_c))),
      wheels(rover_model.wheels.size()) {
  const PerWheel<WheelCommand> commands = wheel_commands(rover_model, commanded);
  double fastest = kMinSpeedScale_m_s;
  for (std::size_t k = 0; k < wheels.size(); ++k)
    fastest = std::max(fastest, std::abs(commands[k].rate_rad_s) * rover_model.wheels[k].radius_m);
  // Wheels that cannot roll in their commanded direction (a crab without steering) are dragged at that speed.
  if (fastest <= kMinSpeedScale_m_s && !commanded.turn_in_place)
    fastest = std::max(fastest, std::abs(commanded.speed_m_s));
  speed_scale_m_s = fastest;
  for (std::size_t k = 0; k < wheels.size(); ++k) {
    place_wheel(k, commands[k]);
    place_slices(k);
  }
  set_gravity();
  set_gaps();
}

void BalanceGeometry::set_gaps() {
  const auto count = static_cast<Eigen::Index>(wheels.size());
  gap_gradient.resize(count, 3 + joints);
  gap_m.resize(count);
  for (Eigen::Index k = 0; k < count; ++k) {
    const auto wheel = static_cast<std::size_t>(k);
    const Eigen::Vector3d& normal = stance->normal_B[wheel];
    const Eigen::Vector3d& p = stance->p_B_wheel[wheel];
    gap_m[k] = stance->gap_m[wheel] - wheels[wheel].highest_m;
    gap_gradient(k, 0) = normal.z();
    gap_gradient(k, 1) = normal.dot(Eigen::Vector3d::UnitX().cross(p)) / half_wheelbase_m;
    gap_gradient(k, 2) = normal.dot(Eigen::Vector3d::UnitY().cross(p)) / half_wheelbase_m;
    for (int j = 0; j < joints; ++j)
      gap_gradient(k, 3 + j) = normal.dot(wheels[wheel].joint[j].shift) / half_wheelbase_m;
  }
  using Normal = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxFreedoms, kMaxFreedoms>;
  using Turns = Eigen::Matrix<double, Eigen::Dynamic, 2, 0, kMaxFreedoms, 2>;
  const Normal normal = gap_gradient.transpose() * gap_gradient;
  Turns turns = Turns::Zero(normal.rows(), 2);
  turns(1, 0) = turns(2, 1) = 1.0 / half_wheelbase_m;
  lean_by_height = normal.ldlt().solve(turns).transpose() * gap_gradient.transpose();
}

// The body's weight acts at the rocker pivots, and the differential passes equal moments to both sides. On
// the joints therefore acts only the wheels' own weight.
void BalanceGeometry::set_gravity() {
  Attitude truth = stance->attitude;
  truth.roll_rad += rover->roll_bias_rad;
  truth.pitch_rad += rover->pitch_bias_rad;
  const bool biased = rover->roll_bias_rad != 0.0 || rover->pitch_bias_rad != 0.0;
  const Eigen::Matrix3d R_MB = biased ? rotation_MB(truth) : stance->R_MB;
  const Eigen::Vector3d g = -R_MB.row(2).transpose();  // per unit of weight, frame B
  gravity[0] = travel.x() * g.x() + travel.y() * g.y();
  gravity[1] = travel.x() * g.y() - travel.y() * g.x();
  gravity[2] = g.z();
  gravity.segment<3>(3) = rover->com_m.cross(g) / half_wheelbase_m;
  const double own = rover->wheel_weight * rover->wheel_mass_kg() / rover->mass_kg;
  if (own == 0.0) return;
  for (int j = 0; j < joints; ++j)
    for (std::size_t k = 0; k < wheels.size(); ++k)
      gravity[6 + j] += own * g.dot(wheels[k].joint[j].shift) / half_wheelbase_m;
}

void BalanceGeometry::add(const OutsideWrench& wrench) {
  const auto add_force = [&](const Eigen::Vector3d& force_n, const Eigen::Vector3d& moment_nm) {
    gravity[0] += (travel.x() * force_n.x() + travel.y() * force_n.y()) / weight_n;
    gravity[1] += (travel.x() * force_n.y() - travel.y() * force_n.x()) / weight_n;
    gravity[2] += force_n.z() / weight_n;
    gravity.segment<3>(3) += moment_nm / (half_wheelbase_m * weight_n);
  };
  add_force(wrench.force_n, wrench.moment_nm);
  for (std::size_t k = 0; k < wrench.at_wheel_n.size(); ++k) {
    const Eigen::Vector3d& force_n = wrench.at_wheel_n[k];
    add_force(force_n, stance->p_B_wheel[k].cross(force_n));
    for (int j = 0; j < joints; ++j)
      gravity[6 + j] += force_n.dot(wheels[k].joint[j].shift) / (half_wheelbase_m * weight_n);
  }
}

void BalanceGeometry::place_wheel(std::size_t k, const WheelCommand& commanded) {
  const WheelModel& wheel = rover->wheels[k];
  const Eigen::Vector3d& normal = stance->normal_B[k];
  Wheel& place = wheels[k];
  place.geometry = wheel.geometry();
  place.commanded_rim_speed_m_s = std::abs(commanded.rate_rad_s) * wheel.radius_m;
  place.is_free = wheel.drive == WheelDrive::kFree;
  place.is_sliced = !stance->slice_height_m.empty() && !place.is_free;
  place.motion = true_motion(wheel, commanded);
  place.direction = commanded.rate_rad_s < 0.0 ? -1.0 : 1.0;
  const double steer = place.motion.steer_rad;
  const Eigen::Vector3d heading(std::cos(steer), std::sin(steer), 0.0);
  const Eigen::Vector3d axle(-std::sin(steer), std::cos(steer), 0.0);
  const Eigen::Vector3d x = axle.cross(normal).normalized();
  const Eigen::Vector3d y = normal.cross(x);
  const Eigen::Vector3d& p = stance->p_B_wheel[k];
  for (int j = 0; j < joints; ++j) place.joint[j] = joint_motion(*rover, *stance, k, j);

  // The columns are for drawbar pull, lateral and vertical force, torque, and overturning moment. The pull
  // and the torque of a wheel that turns backwards point backwards. The lateral force acts at the rim's
  // lowest point.
  const std::array<Wrench, 5> unit{
      Wrench{.force = place.direction * x,
             .moment = -rover->pull_below_axle * wheel.radius_m * place.direction * y},
      Wrench{.force = y, .moment = wheel.radius_m * x}, Wrench{.force = normal},
      Wrench{.moment = -(1.0 - rover->pull_below_axle) * place.direction * y}, Wrench{.moment = x}};
  place.effect.setZero();
  for (int column = 0; column < 5; ++column) {
    const Wrench& w = unit[column];
    auto e = place.effect.col(column);
    e[0] = travel.x() * w.force.x() + travel.y() * w.force.y();
    e[1] = travel.x() * w.force.y() - travel.y() * w.force.x();
    e[2] = w.force.z();
    e.segment<3>(3) = (p.cross(w.force) + w.moment) / half_wheelbase_m;
    for (int j = 0; j < joints; ++j)
      e[6 + j] = (w.force.dot(place.joint[j].shift) + w.moment.y() * place.joint[j].turn) / half_wheelbase_m;
  }
  place.effect /= weight_n;

  // On sloping ground under one wheel the rim travels along its tangent while the body keeps its own speed.
  // A free wheel's motion is given per speed scale at first; its rim speed is found together with its forces.
  const double rim_speed = place.is_free ? speed_scale_m_s
                                         : std::max(std::abs(place.motion.rate_rad_s) * wheel.radius_m,
                                                    kMinRateRatio * speed_scale_m_s);
  const double along = place.direction * speed_scale_m_s / (rim_speed * std::max(0.2, x.dot(heading)));
  const double across = speed_scale_m_s / (rim_speed * std::max(0.2, y.dot(axle)));
  const Eigen::Vector3d d(travel.x(), travel.y(), 0.0), e(-travel.y(), travel.x(), 0.0);
  const Eigen::Vector3d turning = Eigen::Vector3d::UnitZ().cross(p) / half_wheelbase_m;
  place.forward_ratio << along * heading.dot(d), along * heading.dot(e), along * heading.dot(turning);
  place.leftward_ratio << across * axle.dot(d), across * axle.dot(e), across * axle.dot(turning);
}

void BalanceGeometry::place_slices(std::size_t k) {
  Wheel& place = wheels[k];
  if (!place.is_sliced) return;
  const SliceHeights& height = stance->slice_height_m[k];
  place.highest_m = *std::max_element(height.begin(), height.begin() + rover->wheel_slices);
  for (int s = 0; s < rover->wheel_slices; ++s) place.slice_height_m[s] = height[s] - place.highest_m;
}

}  // namespace slipway::sim
