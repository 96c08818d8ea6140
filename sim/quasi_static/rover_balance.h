#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

#include "sim/quasi_static/balance_geometry.h"
#include "sim/rover/multipass.h"
#include "sim/soil/soil.h"
#include "sim/soil/soil_in_force.h"
#include "sim/wheel/wheel_kernel.h"

namespace slipway::sim {

// The 3 + N equations of a rover on N wheels and J joints in quasi-static motion, frame B, moments about B's
// origin, d the direction of travel and e the one to its left:
//
//   0, 1, 2     force   sum F_k + m g = 0                                          along d, e, z
//   3, 4, 5     moment  sum (p_k x F_k + M_k) + p_com x m g = 0                    about x, y, z
//   6 .. 5 + J  joints  sum ((F_k + m_k g) . dp_k/dq_j + M_k . y dturn_k/dq_j) = 0  see suspension.h
//   the rest    compatibility   Z^T (z + gap) / z_ref = 0
//
// F_k is the soil's force at wheel k's centre. M_k is -T_k about its axle and r L_k about its heading, since
// the lateral force L_k acts at the rim's lowest point. m_k is the mass that acts at the wheel itself
// (RoverModel::wheel_weight; none by default); the suspension has no other mass of its own. Gravity is that
// of the true attitude, which is the stance's plus the rover's attitude bias. Forces are divided by the
// weight, and moments by the weight and half the wheelbase.
//
// Compatibility: the depths z_k of the wheels in contact below the undisturbed surface and the stance's gaps
// must be reachable by the body's heave, roll and pitch and by the joints, z + gap = -A q with A the gaps'
// gradient (N x (3 + J)); Z is the null space of A^T. There are N - 3 - J such equations: none for six wheels
// on a rocker-bogie or four on an averaging suspension, and one for four rigid wheels. A wheel in the air is
// not part of A; its equation says that its entry angle is kMinEntryAngleRad. z_ref is of the order of the
// wheels' sinkage, so that an error in depth weighs about as much as the load that it causes.
//
// Where soils remember tracks, a wheel's soil is that of a track for the share of its width that stands in
// one (multipass.h), in the motion of the unknowns.
//
// The 3 + N unknowns are the speeds of B along d and e over `speed_scale`, the yaw rate times half the
// wheelbase over the same, and the N entry angles.
class RoverBalance {
 public:
  static constexpr int kMotions = 3;
  static constexpr int kMaxEquations = kMotions + kMaxWheels;
  using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxEquations, 1>;
  using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxEquations, kMaxEquations>;
  using Loads = BalanceGeometry::Loads;

  // The forces of the ground on one wheel, and the wheel's motion over it.
  struct WheelContact {
    WheelForces forces;
    WheelMotion motion;           // per rim speed
    double rate_rad_s = 0.0;      // positive rolls forward
    double overturning_nm = 0.0;  // moment about a sliced wheel's heading; positive presses its left side up
  };

  static constexpr double kMinEntryAngleRad = 1e-3;

  // `soils` has the undisturbed soil at each wheel's place; the balance turns it into the soil in force.
  // Rover and stance must outlive the balance. `outside`: what acts besides weight and ground, if anything.
  RoverBalance(const RoverModel& rover, double gravity_m_s2, const Stance& stance,
               const PerWheel<Soil>& soils, const DriveCommand& command,
               const OutsideWrench* outside = nullptr);
  // On a geometry that others may share; it must outlive the balance.
  RoverBalance(const BalanceGeometry& geometry, const PerWheel<Soil>& soils);
  RoverBalance(const RoverBalance&) = delete;
  RoverBalance& operator=(const RoverBalance&) = delete;

  const Vector& residual(const Vector& unknowns);

  using WheelLoads = Eigen::Matrix<double, 5, 1>;  // pull, lateral, vertical, torque, overturning moment
  using WheelSlope = Eigen::Matrix<double, 5, 3>;  // of the loads by entry angle, motion along and across
  // A wheel's loads and what they depend on.
  struct WheelPoint {
    WheelLoads loads = WheelLoads::Zero();
    Eigen::Vector3d arguments = Eigen::Vector3d::Zero();  // entry angle, motion along and across
    double share_in_track = 0.0;                          // of its width
  };
  // The slope of each wheel's loads, with the vertical load and the entry angle at which it was taken.
  struct WheelSlopes {
    PerWheel<WheelSlope> of;
    PerWheel<WheelLoads> by_share;  // slope by the share of the width that stands in a track
    PerWheel<double> vertical_n, entry_angle_rad;
  };
  // Of every wheel at the unknowns of the last residual.
  PerWheel<WheelPoint> points(const Vector& unknowns) const;
  // At the unknowns of the last residual, by one-sided differences.
  WheelSlopes slopes(const Vector& unknowns) const;
  // The same from slopes that were taken at another place on much the same soil: a wheel's loads are taken to
  // grow by equal shares with its load and its entry angle.
  WheelSlopes carried_over(const WheelSlopes& from, const Vector& unknowns) const;
  // Corrects each wheel's slope by what its loads have changed since `before`, which was one step ago
  // [Broyden 1965, for each wheel by itself].
  void correct(const PerWheel<WheelPoint>& before, const Vector& unknowns, WheelSlopes& slopes) const;
  // Goes to unknowns near those of the last residual: the wheels' loads change by their slopes, and the
  // balance is taken to hold there.
  void move_along(const WheelSlopes& slopes, const Vector& unknowns);
  // The Jacobian at the unknowns of the last residual, with such slopes.
  Matrix jacobian(const Vector& unknowns, const WheelSlopes& slopes) const;
  Matrix jacobian(const Vector& unknowns) const { return jacobian(unknowns, slopes(unknowns)); }

  const BalanceGeometry& geometry() const { return geometry_; }
  int wheel_count() const { return static_cast<int>(soils_.size()); }
  // The contact at the last residual; a wheel in the air has a rate and no forces.
  const WheelContact& contact(int wheel) const { return contacts_[wheel]; }
  // The commanded direction of rolling, 1 or -1; forward where the commanded rate is 0.
  double direction(int wheel) const { return place(wheel).direction; }
  const WheelGeometry& wheel_geometry(int wheel) const { return place(wheel).geometry; }
  // In force on fresh ground.
  const Soil& soil(int wheel) const { return soils_[wheel]; }
  // Whether any wheel, or every wheel, has a motor that turns it.
  bool any_driven() const;
  bool all_driven() const;
  // Whether a wheel may stand in a track that differs from fresh soil.
  bool follows_tracks() const { return follows_tracks_; }
  // Holds the wheels' shares in tracks whatever the motion, until they are released: a share of the way from
  // where they were held last to those of this motion.
  void hold_tracks(const Vector& unknowns, double way);
  void release_tracks();
  double speed_scale_m_s() const { return geometry_.speed_scale_m_s; }
  double half_wheelbase_m() const { return geometry_.half_wheelbase_m; }
  double weight_n() const { return geometry_.weight_n; }

  // At first all wheels are in contact. Only a statically undetermined vehicle can have wheels in the air.
  bool in_air(int wheel) const { return in_air_[wheel]; }
  bool all_in_contact() const { return in_contact_ == wheel_count(); }
  bool can_spare_a_wheel() const { return in_contact_ > wheel_count() - geometry_.undetermined; }
  void set_in_air(int wheel, bool in_air);
  // Wheel loads without forces along the ground, on springs that sink z_ref under the mean load; a solve
  // starts from them. For a statically determined vehicle the springs do not matter. Sets the wheels in the
  // air that carry no load so.
  Loads resting_loads_n();
  // Depths of the wheels below the undisturbed surface.
  PerWheel<double> total_sinkages_m(const Vector& unknowns) const;
  // What the depths of the wheels in contact turn the body by against the stance, about its x and y axes
  // [rad]. To first order: the joints, the heave and the wheels' forces are those of the stance, which is
  // turned by a degree at most where wheels sink as the laws know them.
  struct Lean {
    double roll_rad = 0.0, pitch_rad = 0.0;
  };
  Lean lean(const Vector& unknowns) const;
  // The height of a wheel in the air over the ground under it; negative where it cuts into the ground.
  double height_in_air_m(int wheel, const Vector& unknowns) const;

 private:
  static constexpr int kMaxFreedoms = BalanceGeometry::kMaxFreedoms;
  using GapGradient = BalanceGeometry::GapGradient;
  using Freedoms = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxFreedoms, 1>;

  const BalanceGeometry::Wheel& place(int wheel) const {
    return geometry_.wheels[static_cast<std::size_t>(wheel)];
  }
  void set_soils(const PerWheel<Soil>& soils);
  void follow_tracks(const Vector& unknowns);
  void set_tracks(const TrackShares& tracks);
  TrackShares tracks_in(const Vector& unknowns) const;
  using Motions = Eigen::Matrix<double, BalanceGeometry::kPaddedEquilibrium, kMotions>;
  Motions slopes_by_tracks(const Vector& unknowns, const WheelSlopes& slopes, Matrix& jacobian) const;
  PerWheel<double> total_sinkages_m(const Vector& unknowns, const TrackShares& tracks) const;
  void set_sinkage_scale();
  void set_compatibility();
  void set_compatibility_of_sinkages();
  // A wheel at an entry angle and in a motion at which its contact is to be evaluated.
  struct Trial {
    int wheel = 0;
    double entry_angle_rad = 0.0;
    WheelMotion motion;
    double share_in_track = 0.0;
  };
  static constexpr int kMaxTrials = 4 * kMaxWheels;  // as many as a Jacobian needs
  // Evaluates all trials at once, which costs about half of one by one.
  void contacts_of(std::span<const Trial> trials, std::span<WheelContact> contacts) const;
  void find_contacts(const Vector& unknowns);
  void find_contacts_in_kernel(const Vector& unknowns);
  Soil soil_under(const Trial& trial) const;
  WheelContact free_contact(const Trial& trial) const;
  bool all_in_kernel() const;
  WheelContact sliced_contact(const Trial& trial) const;
  WheelMotion motion_of(int wheel, const Vector& unknowns) const;
  // The motion q of heave, roll, pitch and joints that lifts the wheels in contact by these heights, by least
  // squares with `push` = 0 (for another use see resting_loads_n).
  Freedoms body_motion(const Loads& height_m, const Freedoms& push) const;
  int equilibrium_count() const { return geometry_.equilibrium_count(); }
  const RoverModel& rover() const { return *geometry_.rover; }
  const Stance& stance() const { return *geometry_.stance; }

  std::optional<BalanceGeometry> own_geometry_;  // where it is not another's
  const BalanceGeometry& geometry_;
  PerWheel<Soil> soils_;  // in force on fresh ground
  // Of wheel and soil; angle, motion and track are those of the last residual.
  PerWheel<WheelNumbers> numbers_;
  PerWheel<WheelContact> contacts_;
  PerWheel<bool> in_air_;
  bool follows_tracks_ = false, holds_tracks_ = false;  // see follows_tracks() and hold_tracks()
  TrackShares tracks_, held_tracks_;                    // at the last residual; where they were held last
  PerWheel<WheelNumbers> fresh_;                        // outside all tracks, where any is followed
  PerWheel<double> share_in_track_, rut_shares_;
  int in_contact_;
  double sinkage_scale_m_ = 1.0;  // z_ref; without meaning where all loads are determined
  Vector at_, residual_at_;       // unknowns and values of the last residual; empty once the contacts change
  // The compatibility equations as rows over the wheels' depths and over their own sinkages.
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxWheels, kMaxWheels>;
  Rows compatibility_of_depth_, compatibility_;
  Loads compatibility_of_gap_;
};

}  // namespace slipway::sim
