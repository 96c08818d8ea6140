#include "drive_simulation.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "along_field.h"
#include "soil_contact_model.h"
#include "wheel_tracks.h"

namespace slipway::gap_benchmark {
namespace {

constexpr double kStep_s = 2.0, kSurveyEvery = 5;
constexpr double kHeating_k = 8.0, kHeatingTime_s = 300.0;
constexpr int kFirstPasses = 3;  // repeats after which the rear wheels stand in the ruts of those ahead
constexpr double kRutLeft = 0.4;
constexpr double kReferenceTemp_c = 20.0, kReferenceSpeed_m_s = 0.04;

std::unique_ptr<const WheelLaw> wheel_law(const World& world) {
  const double radius = world.rover.radius_m * (1.0 + world.hidden.radius_scale), width = world.rover.width_m;
  if (world.soil_contact_model) return std::make_unique<SoilContactModel>(radius, width);
  return std::make_unique<ArcLaw>(radius, width, world.closure, world.hidden);
}

struct Attitude {
  double roll = 0.0, pitch = 0.0, height = 0.0;
};

class Drive {
 public:
  Drive(const World& world, const TerrainGrid& ground, const DriveOrder& order, RandomStream& random)
      : world_(world),
        hidden_(world.hidden),
        ground_(ground),
        order_(order),
        law_(wheel_law(world)),
        stiffness_(random, world.scatter.length_m),
        friction_(random, world.scatter.length_m),
        modulus_(random, world.scatter.length_m) {
    drive_stiffness_ = world.scatter.stiffness * random.bounded();
    drive_friction_ = world.scatter.friction * random.bounded();
    drive_modulus_ = world.scatter.shear_modulus * random.bounded();
    hub_phase_ = random.uniform(0.0, 2.0 * std::numbers::pi);
    told_ = commanded_wheels(world.rover, order);
    x_ = order.start_x_m;
    y_ = order.start_y_m;
    yaw_ = order.start_yaw_rad;
    state_ = first_guess();
  }

  SimulatedDrive run() {
    SimulatedDrive drive;
    const int steps = static_cast<int>(std::lround(order_.duration_s / kStep_s));
    for (int i = 0; i <= steps; ++i) {
      time_s_ = i * kStep_s;
      if (!ground_.inside(x_, y_, 1.2)) {
        drive.complete = false;
        break;
      }
      const Attitude attitude = attitude_here();
      bool stepped = true;
      for (int pass = i == 0 && world_.soil_contact_model ? kFirstPasses : 1; stepped && pass > 0; --pass)
        stepped = step(attitude);
      if (!stepped) {
        drive.complete = false;
        break;
      }
      drive.rows.push_back(row(attitude, i % static_cast<int>(kSurveyEvery) == 0));
      advance(attitude);
    }
    return drive;
  }

  std::vector<std::optional<DriveRow>> replay(std::span<const DriveRow> at) {
    std::vector<std::optional<DriveRow>> rows(at.size());
    for (std::size_t i = 0; i < at.size(); ++i) {
      time_s_ = at[i].time_s;
      x_ = at[i].x_m;
      y_ = at[i].y_m;
      yaw_ = at[i].motion.heading_rad;
      way_m_ = at[i].motion.way_m;
      const Attitude attitude = attitude_here();
      bool stepped = true;
      for (int pass = i == 0 && world_.soil_contact_model ? kFirstPasses : 1; stepped && pass > 0; --pass)
        stepped = step(attitude);
      if (stepped)
        rows[i] = row(attitude, at[i].surveyed);
      else
        state_ = first_guess();
    }
    return rows;
  }

 private:
  BalanceState first_guess() const {
    BalanceState state;
    state.forward_m_s = order_.turn_in_place ? 0.0 : 0.95 * order_.speed_m_s;
    state.yaw_rate_rad_s = 0.95 * order_.turn_rate_rad_s();
    return state;
  }

  double ground_under(double ahead, double left) const {
    const double c = std::cos(yaw_), s = std::sin(yaw_);
    return ground_.height_at(x_ + c * ahead - s * left, y_ + s * ahead + c * left);
  }

  // Of the body on its rockers and differential: the mean of both sides.
  Attitude attitude_here() {
    std::array<double, kWheels> z;
    for (int k = 0; k < kWheels; ++k)
      z[k] = ground_under(world_.rover.wheel_m[k].x(), world_.rover.wheel_m[k].y());
    const double bogie_x = 0.5 * (world_.rover.wheel_m[1].x() + world_.rover.wheel_m[2].x());
    const double base = world_.rover.wheel_m[0].x() - bogie_x;
    std::array<double, 2> grade, pivot;
    for (int side = 0; side < 2; ++side) {
      const double rear = 0.5 * (z[3 * side + 1] + z[3 * side + 2]);
      grade[side] = (z[3 * side] - rear) / base;
      pivot[side] = rear + grade[side] * (world_.rover.rocker_pivot_m.x() - bogie_x);
    }
    Attitude attitude;
    const double slope = 0.5 * (grade[0] + grade[1]);
    attitude.pitch = -std::atan(slope);
    const double middle_y = 0.5525;  // of the wheels that carry a pivot, by their shares
    attitude.roll = std::atan((pivot[0] - pivot[1]) / (2.0 * middle_y) * std::cos(attitude.pitch));
    attitude.height = ground_.height_at(x_, y_);
    place_z_ = z;
    return attitude;
  }

  bool step(const Attitude& attitude) {
    BalanceTask task;
    const Eigen::Matrix3d turn = rotation(attitude);
    Eigen::Vector3d down(0.0, 0.0, -world_.gravity_m_s2);
    Attitude felt = attitude;
    if (hidden_.bias_of_gravity) {
      felt.roll += hidden_.roll_bias_rad;
      felt.pitch += hidden_.pitch_bias_rad;
    }
    task.gravity_m_s2 = rotation(felt).transpose() * down;
    if (hidden_.tether_n != 0.0) {
      const double back = order_.speed_m_s < 0.0 && !order_.turn_in_place ? 1.0 : -1.0;
      task.pull_n += Eigen::Vector3d(back * hidden_.tether_n, 0.0, 0.0);
      task.pull_at_m = Eigen::Vector3d(back * 0.7, 0.0, 0.3);
    }
    if (hidden_.wind_n != 0.0) {
      task.pull_n += turn.transpose() * (hidden_.wind_n * Eigen::Vector3d(std::cos(hidden_.wind_rad),
                                                                          std::sin(hidden_.wind_rad), 0.0));
      task.pull_at_m = Eigen::Vector3d(0.0, 0.0, 0.6);
    }
    add_body_forces(turn, task);
    const Tracks tracks = tracks_of(world_.rover, state_);
    const double slope_x = -std::tan(attitude.pitch),
                 slope_y = std::tan(attitude.roll) / std::cos(attitude.pitch);
    for (int k = 0; k < kWheels; ++k) {
      WheelPlace& place = task.wheels[static_cast<std::size_t>(k)];
      const double wx = world_.rover.wheel_m[k].x(), wy = world_.rover.wheel_m[k].y();
      constexpr double kReach = 0.08;
      place.height_m =
          (place_z_[k] - attitude.height - slope_x * wx - slope_y * wy) * std::cos(attitude.pitch);
      place.grade_x =
          (ground_under(wx + kReach, wy) - ground_under(wx - kReach, wy)) / (2.0 * kReach) - slope_x;
      place.grade_y =
          (ground_under(wx, wy + kReach) - ground_under(wx, wy - kReach)) / (2.0 * kReach) - slope_y;
      const double c = std::cos(attitude.pitch);
      place.grade_x *= c * c;
      place.grade_y *= c * c;
      place.rate_rad_s = true_rate(k);
      if (hidden_.dragged_axle == k % 3) place.pull_n -= travel_sense() * hidden_.axle_drag_n;
      if (hidden_.snagged_wheel == k) place.pull_n -= travel_sense() * hidden_.wheel_drag_n;
      place.steer_rad = told_[k].steer_rad;
      const bool steers = k % 3 != 1;
      if (steers && (hidden_.steered < 0 || hidden_.steered == k)) place.steer_rad += hidden_.steering_rad;
      place.soil = soil_under(k, std::cos(yaw_) * wx - std::sin(yaw_) * wy + x_,
                              std::sin(yaw_) * wx + std::cos(yaw_) * wy + y_, tracks);
      met_level_m_[k] = highest_level(place.soil.met);
    }
    if (!balance_rover(world_.rover, task, *law_, world_.closure, hidden_, state_)) return false;
    for (int k = 0; k < kWheels; ++k) ruts_[k] = law_->rut(state_.depth_m[k], task.wheels[k].soil);
    return true;
  }

  // 1 forward, -1 backward, 0 in place.
  double travel_sense() const { return order_.turn_in_place ? 0.0 : order_.speed_m_s < 0.0 ? -1.0 : 1.0; }

  // Of the causes that are no more than a force with a point where it acts; `turn` is from body to map.
  void add_body_forces(const Eigen::Matrix3d& turn, BalanceTask& task) const {
    constexpr double kReferenceClimb = 0.17364817766693033;  // sine of 10 deg
    const Eigen::Vector3d push(hidden_.push_forward_n, hidden_.push_left_n, 0.0);
    const double drag =
        travel_sense() * hidden_.speed_drag_n * std::abs(order_.speed_m_s) / kReferenceSpeed_m_s +
        hidden_.slope_drag_n * turn(2, 0) / kReferenceClimb;
    if (push.isZero() && drag == 0.0) return;
    task.pull_n += push - Eigen::Vector3d(drag, 0.0, 0.0);
    task.pull_at_m = Eigen::Vector3d(0.1, 0.0, 0.35);
  }

  double true_rate(int k) const {
    double rate = told_[k].rate_rad_s;
    if (hidden_.dragging == k) rate *= hidden_.dragging_rate_share;
    if (hidden_.slipping_hub == k) {
      const double turned = std::abs(told_[k].rate_rad_s) * time_s_ + hub_phase_;
      rate *= 1.0 - hidden_.hub_share * 0.5 * (1.0 + std::sin(turned));
    }
    return rate;
  }

  ContactSoil soil_under(int k, double x, double y, const Tracks& tracks) {
    const TrueSoil& soil = world_.soil;
    const double along = world_.scatter.along;
    const double s = way_m_ + world_.rover.wheel_m[k].x();
    const double stiffness = std::exp(drive_stiffness_ + along * world_.scatter.stiffness * stiffness_.at(s));
    const double friction = std::exp(drive_friction_ + along * world_.scatter.friction * friction_.at(s));
    const double modulus = std::exp(drive_modulus_ + along * world_.scatter.shear_modulus * modulus_.at(s));
    ContactSoil out;
    out.stiffness = (soil.k_c / world_.rover.width_m + soil.k_phi) * stiffness;
    out.n = soil.n;
    out.cohesion_pa = soil.cohesion_pa;
    out.tan_phi = std::tan(soil.friction_rad * friction);
    out.shear_modulus_m = soil.shear_modulus_m * modulus;
    out.weight_n_m3 = soil.density_kg_m3 * world_.gravity_m_s2;
    out.c1 = world_.soil.c1;
    out.c2 = world_.soil.c2;
    out.modulus_ratio_m = soil.k_c / soil.k_phi;
    if (!order_.turn_in_place) {
      harden_in_tracks(k, tracks, out);
      out.met = soil_met(k, tracks, ruts_, world_.rover.width_m);
    }
    weaken_in_patch(x, y, out);
    if (hidden_.rate_exponent != 0.0) {
      const double v = std::max(std::abs(told_[k].rate_rad_s) * world_.rover.radius_m, 1e-3),
                   v0 = kReferenceSpeed_m_s;
      out.shear_modulus_m *= hidden_.other_equations
                                 ? std::max(1.0 + 2.0 * hidden_.rate_exponent * (v - v0) / (v + v0), 0.1)
                                 : std::pow(v / v0, hidden_.rate_exponent);
    }
    if (hidden_.solar_softening > 0.0) {
      const double left = 1.0 - hidden_.solar_softening * std::sin(std::numbers::pi * order_.share_of_day);
      out.tan_phi *= left;
      out.cohesion_pa *= left;
    }
    return out;
  }

  // The deepest rut in which this wheel runs, less the part that springs back and caves in. The sinkage is
  // measured from the undisturbed surface.
  double rut_under(int k) const {
    double rut = 0.0;
    for (int i = 0; i < kWheels && hidden_.multipass > 0.0; ++i)
      rut = std::max(rut, kRutLeft * overlap_[k][i] * state_.depth_m[i]);
    return rut;
  }

  // Wheels ahead of this one whose track it runs in, each counted by how far the tracks overlap.
  void harden_in_tracks(int k, const Tracks& tracks, ContactSoil& soil) {
    if (hidden_.multipass == 0.0) return;
    double passes = 0.0;
    for (int i = 0; i < kWheels; ++i) {
      double& overlap = overlap_[k][i];
      overlap = 0.0;
      if (!tracks.is_ahead(i, k)) continue;
      overlap = std::max(0.0, 1.0 - std::abs(tracks.lane_m[i] - tracks.lane_m[k]) / world_.rover.width_m);
      passes += overlap;
    }
    if (passes <= 0.0) return;
    if (hidden_.other_equations) {
      // Stiffness by the root of the number of passes, denser and shorter in shear (after Holm).
      const double more = hidden_.multipass * std::sqrt(passes);
      soil.stiffness *= 1.0 + 0.8 * more;
      soil.cohesion_pa *= 1.0 + 0.1 * more;
      soil.shear_modulus_m /= 1.0 + 0.15 * more;
    } else {
      soil.stiffness *= 1.0 + hidden_.multipass * std::min(passes, 1.0);
    }
  }

  void weaken_in_patch(double x, double y, ContactSoil& soil) const {
    if (hidden_.patch_weakening == 0.0) return;
    const double distance = std::hypot(x - hidden_.patch_x_m, y - hidden_.patch_y_m) / hidden_.patch_radius_m;
    // A sharp disc, or one whose edge fades over a third of its radius.
    double inside = distance <= 1.0 ? 1.0 : 0.0;
    if (hidden_.other_equations) inside = std::clamp(0.5 - (distance - 1.0) * 3.0, 0.0, 1.0);
    const double left = 1.0 - hidden_.patch_weakening * inside;
    soil.stiffness *= hidden_.other_equations ? std::pow(left, 1.2) : left;
    soil.cohesion_pa *= left;
    soil.tan_phi *= hidden_.other_equations ? std::pow(left, 0.8) : left;
  }

  double current(int k) const {
    const RoverOnFile& rover = world_.rover;
    const double sense = told_[k].rate_rad_s < 0.0 ? -1.0 : 1.0;
    double torque = sense * state_.loads[k].torque_nm;
    const double speed = std::abs(told_[k].rate_rad_s);
    if (hidden_.gear_torque_nm != 0.0) {
      // Dry friction, or Stribeck's: more of it the slower.
      torque += hidden_.other_equations ? hidden_.gear_torque_nm * (0.9 + 0.4 * std::exp(-speed / 0.15))
                                        : hidden_.gear_torque_nm;
    }
    torque += hidden_.gear_viscous_nms_rad * speed;
    if (hidden_.dragging == k) torque += hidden_.dragging_nm;
    double constant = rover.torque_constant_nm_a, idle = rover.no_load_a;
    const double warmer = motor_temp() - kReferenceTemp_c;
    if (hidden_.kt_per_k != 0.0)
      constant *=
          hidden_.other_equations ? 1.0 / (1.0 + hidden_.kt_per_k * warmer) : 1.0 - hidden_.kt_per_k * warmer;
    if (hidden_.friction_per_k != 0.0)
      idle *= hidden_.other_equations ? std::exp(-hidden_.friction_per_k * warmer)
                                      : 1.0 - hidden_.friction_per_k * warmer;
    return torque / (constant * rover.gear_ratio * rover.gear_efficiency) + idle;
  }

  double motor_temp() const {
    return order_.motor_temp_c + kHeating_k * (1.0 - std::exp(-time_s_ / kHeatingTime_s));
  }

  DriveRow row(const Attitude& attitude, bool surveyed) const {
    DriveRow row;
    row.time_s = time_s_;
    row.x_m = x_;
    row.y_m = y_;
    row.z_m = attitude.height;
    row.yaw_rad = order_.start_yaw_rad + (1.0 + hidden_.odometry_yaw_scale) * (yaw_ - order_.start_yaw_rad);
    const double known = hidden_.bias_of_gravity ? 0.0 : 1.0;
    row.roll_rad = attitude.roll - known * hidden_.roll_bias_rad;
    row.pitch_rad = attitude.pitch - known * hidden_.pitch_bias_rad;
    row.motor_temp_c = motor_temp();
    row.surveyed = surveyed;
    row.motion = {yaw_,
                  way_m_,
                  state_.forward_m_s,
                  state_.left_m_s,
                  (1.0 + hidden_.odometry_yaw_scale) * state_.yaw_rate_rad_s * std::cos(attitude.roll) /
                      std::cos(attitude.pitch),
                  attitude.roll,
                  attitude.pitch};
    for (int k = 0; k < kWheels; ++k) {
      WheelRow& wheel = row.wheels[static_cast<std::size_t>(k)];
      wheel = told_[k];
      if (hidden_.dragging == k) wheel.rate_rad_s *= hidden_.dragging_rate_share;
      wheel.current_a = current(k) * (1.0 + hidden_.current_gain_drift * order_.share_of_day) *
                        (hidden_.gained_wheel == k ? 1.0 + hidden_.wheel_current_gain : 1.0);
      wheel.sinkage_m = state_.depth_m[k] + rut_under(k) - met_level_m_[k];
    }
    return row;
  }

  void advance(const Attitude& attitude) {
    const Eigen::Vector3d velocity =
        rotation(attitude) * Eigen::Vector3d(state_.forward_m_s, state_.left_m_s, 0.0);
    x_ += kStep_s * velocity.x();
    y_ += kStep_s * velocity.y();
    yaw_ += kStep_s * state_.yaw_rate_rad_s * std::cos(attitude.roll) / std::cos(attitude.pitch);
    way_m_ += kStep_s * state_.forward_m_s;
  }

  Eigen::Matrix3d rotation(const Attitude& attitude) const {
    return (Eigen::AngleAxisd(yaw_, Eigen::Vector3d::UnitZ()) *
            Eigen::AngleAxisd(attitude.pitch, Eigen::Vector3d::UnitY()) *
            Eigen::AngleAxisd(attitude.roll, Eigen::Vector3d::UnitX()))
        .toRotationMatrix();
  }

  const World& world_;
  const HiddenTruth& hidden_;
  const TerrainGrid& ground_;
  const DriveOrder& order_;
  std::unique_ptr<const WheelLaw> law_;
  AlongField stiffness_, friction_, modulus_;
  double drive_stiffness_ = 0.0, drive_friction_ = 0.0, drive_modulus_ = 0.0, hub_phase_ = 0.0;
  std::array<WheelRow, kWheels> told_;
  std::array<double, kWheels> place_z_{};
  std::array<std::array<double, kWheels>, kWheels> overlap_{};
  std::array<Rut, kWheels> ruts_;
  std::array<double, kWheels> met_level_m_{};
  double time_s_ = 0.0, x_ = 0.0, y_ = 0.0, yaw_ = 0.0, way_m_ = 0.0;
  BalanceState state_;
};

}  // namespace

World without_hidden_causes(const World& world) {
  World bare = world;
  bare.hidden = {};
  bare.hidden.other_equations = world.hidden.other_equations;
  return bare;
}

std::array<WheelRow, kWheels> commanded_wheels(const RoverOnFile& rover, const DriveOrder& order) {
  std::array<WheelRow, kWheels> commands;
  for (int k = 0; k < kWheels; ++k) {
    const double x = rover.wheel_m[k].x(), y = rover.wheel_m[k].y();
    WheelRow& wheel = commands[static_cast<std::size_t>(k)];
    const double turn = order.turn_rate_rad_s();
    const double along = order.turn_in_place ? -turn * y : order.speed_m_s - turn * y, across = turn * x;
    const bool steers = k % 3 != 1;
    const double sense = along < 0.0 ? -1.0 : 1.0;
    wheel.steer_rad = steers ? std::atan(across / along) : 0.0;
    wheel.rate_rad_s = sense * (steers ? std::hypot(along, across) : std::abs(along)) / rover.radius_m;
  }
  return commands;
}

SimulatedDrive simulate_drive(const World& world, const TerrainGrid& ground, const DriveOrder& order,
                              RandomStream& random) {
  return Drive(world, ground, order, random).run();
}

std::vector<std::optional<DriveRow>> replay_drive(const World& world, const TerrainGrid& ground,
                                                  const DriveOrder& order, RandomStream& random,
                                                  std::span<const DriveRow> at) {
  return Drive(world, ground, order, random).replay(at);
}

}  // namespace slipway::gap_benchmark
