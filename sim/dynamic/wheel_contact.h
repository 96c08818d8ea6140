#pragma once

#include <Eigen/Core>
#include <optional>

#include "sim/dynamic/rut_map.h"
#include "sim/rover/ground.h"
#include "sim/rover/rover_model.h"
#include "sim/rover/stance.h"
#include "sim/wheel/per_wheel.h"
#include "sim/wheel/sliced_wheel.h"
#include "sim/wheel/wheel_kernel.h"

namespace slipway::sim {

// The motion of one wheel, in frame M.
struct WheelKinematics {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  Eigen::Vector3d axle = Eigen::Vector3d::UnitY();     // unit, to the left
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  // of the centre, m/s
  double rate_rad_s = 0.0;
  bool braked = false;  // it does not roll, however its brake gives way
  // Of a braked wheel: what is left of its rate when it halted, over standstill.
  double halted_turning = 0.0;
  double slip_x = 0.0, slip_y = 0.0;  // the contact's own states, see below
};

// The contact of one wheel with the ground, in frame M.
struct ContactState {
  double depth_m = 0.0;    // of the rim below the ground that it meets; <= 0 in the air
  double rut_m = 0.0;      // depth of that ground below the undisturbed surface
  double driven_on = 0.0;  // share of the wheel's width that stands in a track
  double entry_angle_rad = 0.0;
  SliceHeights slice_height_m{};  // of each slice below the deepest one, to which depth_m belongs; <= 0
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   // on the wheel at its centre
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();  // on the wheel, N m
  WheelMotion motion;                                // that the law was given, in the direction of rolling
  double load_n = 0.0, drawbar_pull_n = 0.0,
         lateral_n = 0.0;  // along normal, rolling direction forward, left
  double torque_nm = 0.0;  // that drives the wheel forward against the soil
  double slip_x_rate = 0.0, slip_y_rate = 0.0;
};

// clang-format off
// Compliant contact of rigid wheels with soil. It extends the laws of wheel_forces.h to motion by two states for
// each wheel, without another law [ROAMS section 2.7: a normal and a two-dimensional tangential compliance].
//
// Normal: the depth z of the rim below the ground gives the entry angle, the law gives the force W, and
//
//   N = W(theta_f, ...) max(0, 1 + chi dz/dt)       damping as Hunt and Crossley's: none without contact
//
// Tangential: the slip s = (s_x, s_y) of the rim against the soil relaxes over a contact's length L,
//
//   L ds_x/dt = r w - v_x - V s_x       L ds_y/dt = -v_y - V s_y       V = max(r |w|, |v| / 100)
//   u = 1 - sign(w) s_x,  v_y / (r |w|) = -s_y     to the law;        F_x += c L ds_x/dt,  F_y += c L ds_y/dt
//
// In steady motion s equals the slip, the dampings vanish and the forces are those of the quasi-static level at
// any speed. At rest s is an elastic displacement, so that a braked rover stands on a slope. Where w passes
// through 0 the two directions of rolling blend over `standstill_rad_s`. A braked wheel keeps the
// blend that it halted with and forgets it, whichever way its brake gives, or each swing of the brake would turn the
// soil's resistance round and be fed by it. A locked wheel has its commanded direction.
//
//   L    r theta_f of the wheel at rest       chi, c   damping ratios kNormalDamping and kTangentialDamping of
//        under an equal share of the weight            that wheel's mass on that soil
//
// The laws do not cover a wheel that slides back against its rolling direction (u < 0). Its soil lies behind it:
// from u = 0 to -1/4 the forces blend into those of a wheel that is dragged that way, whose shear acts the same and
// whose compaction resists the slide instead of helping it.
//
// The ground's height and tangent plane are read at some points along the rolling direction. The depth is the smooth
// maximum over these planes, and the normal is the mean with the same weights. This is exact on planes, and a rock
// in front of the wheel acts before the axle is above it. With RoverModel::wheel_slices > 1 the heights across the
// wheel differ (sliced_wheel.h). Ruts of earlier wheels lower the ground and stiffen it (multipass.h), by the share
// of the wheel's width that stands in them.
// clang-format on
class WheelContacts {
 public:
  static constexpr double kNormalDamping = 0.7, kTangentialDamping = 0.7;

  WheelContacts(const RoverModel& rover, double gravity_m_s2, int points, double standstill_rad_s);

  // From now on the wheel is on this soil, with the strength that it has at this rim speed.
  void set_soil(std::size_t wheel, const Soil& soil, double rim_speed_m_s);
  // The direction in which a locked wheel is dragged, -1 or 1.
  void set_commanded_direction(std::size_t wheel, double direction) {
    places_[wheel].commanded_direction = direction;
  }
  double relaxation_m(std::size_t wheel) const { return places_[wheel].relaxation_m; }

  // Finds depth, rut and normal of one wheel. Returns false where there is no ground.
  bool find_ground(const Ground& ground, const RutMap& ruts, std::size_t wheel,
                   const WheelKinematics& kinematics, ContactState& contact) const;
  // Finds the whole contact of all wheels at once. Returns false where one of them has no ground.
  bool find(const Ground& ground, const RutMap& ruts, const PerWheel<WheelKinematics>& wheels,
            PerWheel<ContactState>& contacts) const;

 private:
  struct Place {
    WheelGeometry geometry;
    Soil soil;                   // in force on fresh ground
    WheelNumbers numbers;        // of wheel and soil
    double rebound_share = 0.0;  // of a track, see multipass.h
    bool remembers = false;      // true where a track differs from fresh soil
    double relaxation_m = 0.1, normal_damping_s_m = 0.0, tangential_damping_ns_m = 0.0;
    double commanded_direction = 1.0;
    bool locked = false;
  };
  // One evaluation of the law for one wheel in one direction of rolling.
  struct Trial {
    std::size_t wheel = 0;
    double direction = 1.0, weight = 1.0;
  };
  static constexpr std::size_t kMaxTrials = std::size_t{4} * kMaxWheels;

  // Adds at most four trials of one wheel, and returns their number.
  std::size_t add_trials(std::size_t wheel, const WheelKinematics& kinematics, const ContactState& contact,
                         Trial* trials, WheelNumbers* numbers) const;
  void find_rut(const RutMap& ruts, std::size_t wheel, const WheelKinematics& kinematics,
                ContactState& contact) const;
  void add_sliced(const Trial& trial, const WheelNumbers& numbers, const WheelKinematics& kinematics,
                  ContactState& contact) const;
  void find_slices(const Ground& ground, std::size_t wheel, const WheelKinematics& kinematics,
                   ContactState& contact) const;
  void finish(std::size_t wheel, const WheelKinematics& kinematics, ContactState& contact) const;

  const RoverModel& rover_;
  double gravity_m_s2_;
  int points_;
  double standstill_rad_s_;
  PerWheel<Place> places_;
};

}  // namespace slipway::sim
