#pragma once

#include <Eigen/Core>
#include <optional>
#include <string_view>

#include "sim/quasi_static/rover_balance.h"
#include "sim/rover/drive_command.h"
#include "sim/rover/rover_model.h"
#include "sim/rover/stance.h"
#include "sim/soil/soil.h"
#include "sim/wheel/per_wheel.h"

namespace slipway::sim {

struct WheelState {
  double load_n = 0.0;           // along the ground's normal
  double rate_rad_s = 0.0;       // true rotation rate, positive rolls forward
  double slip_ratio = 0.0;       // [-1, 1], positive driving [ARTEMIS eq. 21]
  double slip_angle_rad = 0.0;   // of the wheel's velocity to its plane, positive to the left
  double entry_angle_rad = 0.0;  // into the soil that the wheel meets; in a track, from the rut's bottom
  double sinkage_m = 0.0;        // of the lowest point below the undisturbed surface
  double drawbar_pull_n = 0.0;   // along the rolling direction
  double lateral_force_n = 0.0;  // to the left
  // About the axle, that turns the wheel against the soil; positive drives forward. A driven wheel's motor
  // overcomes the wheel's drag in addition.
  double torque_nm = 0.0;
  double current_a = 0.0;  // at the motor; 0 for a wheel that is not driven
  bool in_air = false;     // true where the wheel has no contact and no load
};

enum class Outcome {
  kMoving,
  kNoTraction,    // the soil's whole thrust cannot hold the rover on the slope, which digs in or slides away
  kWheelLifted,   // the balance would need a wheel that pulls on the ground: the rover rears or tips
  kSunkToAxle,    // a wheel would sink to its axle
  kStalled,       // a motor would need more current or voltage than it has
  kNotConverged,  // the solver gave up, which is no statement about the rover
  kOutsideSlipCurve,  // the soil is known by a slip curve, which has no such slope
};

// The outcome as words for messages: "no traction".
std::string_view describe(Outcome outcome);

// The balanced motion of the rover at one station.
struct StationState {
  Outcome outcome = Outcome::kMoving;
  int wheel = -1;             // index of the wheel that the outcome concerns, -1 where it concerns none
  double along_m_s = 0.0;     // of B along the commanded direction of travel
  double forward_m_s = 0.0;   // of B along its x axis
  double leftward_m_s = 0.0;  // of B along its y axis; without crab, the speed of side slip
  double yaw_rate_rad_s = 0.0;
  // Slip of the rover, by the ratio of `along` and the speed it would have without slip (slip_ratio.h): where
  // it skids downhill, that speed over `along` less 1. When turning in place, of the yaw rate. [-1, 1]
  double slip_ratio = 0.0;
  double side_slip_rad = 0.0;  // direction of B's velocity to the commanded direction, positive to the left
  // Of the body on its sunk wheels: the stance's, leant by what the wheels' unequal sinkages turn body and
  // joints. The stance's own where the sinkages are not known: without a balance, and on slip curves.
  Attitude attitude;
  double electric_power_w = 0.0;  // of the drive motors
  // Depth of the track behind each side's last wheel, as a camera that looks back would measure it.
  double left_rut_depth_m = 0.0, right_rut_depth_m = 0.0;
  PerWheel<WheelState> wheels;
  // A wheel stands on ground that is known by a slip curve: speeds and slip are known, while nothing is of
  // what stands in `wheels`, of ruts and of power, all of which are 0.
  bool by_slip_curve = false;

  bool moving() const { return outcome == Outcome::kMoving; }
};

// Slip as drives are measured: 1 less the speed along the commanded direction over the commanded one; when
// turning in place, of the yaw rate. Below StationState::slip_ratio where the rover skids, and unbounded.
double measured_slip(const StationState& state, const DriveCommand& command);

// How much is tried before the solver reports that there is no balance.
enum class Thoroughness {
  kSure,   // every method, bracketing included
  kQuick,  // Newton's searches alone, which miss one balance in thousands; the outcome is then kNotConverged
};

// How exactly a balance is solved.
enum class Precision {
  kExact,  // to 1e-9 of the weight
  // To 1e-5 of the weight, with the slopes of the wheels' loads from the solve before: for draws of the
  // ground. Slip is then within 0.001 of the exact
  // one, where draws scatter by a hundredth and more.
  kDraws,
};

// Solves for the motion (along and across the direction of travel, yaw rate) and the entry angles at which
// the wheels' forces, gravity and the commanded wheel rates balance: see RoverBalance for the equations.
// Rovers with more wheels than their suspension can keep on the ground may lift some of them.
//
// This is a workspace for one thread. Each solve starts from the last one's answer and falls back to a cold
// start, so stations are best solved in order; the answer does not depend on the start beyond the solver's
// tolerance (1e-9 of the weight).
class QuasiStaticSolver {
 public:
  // A balance and its inverse Jacobian. From it, the balances of the same station with slightly different
  // soils or rovers take a few evaluations.
  struct Start {
    Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 3 + kMaxWheels, 1> unknowns;
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 3 + kMaxWheels, 3 + kMaxWheels> inverse_jacobian;
  };

  QuasiStaticSolver(const RoverModel& rover, double gravity_m_s2, Precision precision = Precision::kExact);

  // soils has the soil under each wheel. A `start` replaces the last answer as the starting point.
  // Where a wheel stands on a soil with a slip curve there is no balance: the motion is the slowest of those
  // that the wheels' curves give and, where other wheels stand on soils with laws, of the balance on these.
  StationState solve(const Stance& stance, const PerWheel<Soil>& soils, const DriveCommand& command,
                     const Start* start = nullptr, Thoroughness thoroughness = Thoroughness::kSure);
  StationState solve(const Stance& stance, const Soil& soil, const DriveCommand& command);
  // On a geometry that was made of this solver's rover and gravity, for a station that is solved often. What
  // acts from outside is what was added to the geometry.
  StationState solve(const BalanceGeometry& geometry, const PerWheel<Soil>& soils,
                     const Start* start = nullptr, Thoroughness thoroughness = Thoroughness::kSure);
  // The unknowns of the last solve (see RoverBalance); empty where the rover did not move.
  std::optional<RoverBalance::Vector> unknowns_of_last() const {
    return warm_ ? std::optional(last_) : std::nullopt;
  }
  // Moves the start of the next solve by as much as another rover's unknowns have changed, which came the
  // same way on other soil: speeds by the difference, entry angles by the ratio. Where this one did not move,
  // the next solve starts as the other's.
  void follow(const RoverBalance::Vector& from, const RoverBalance::Vector& to);
  // The balance of the last solve as a starting point for others; the arguments must be those of that solve.
  // Empty where the rover did not move on all of its wheels.
  std::optional<Start> start_of_last(const Stance& stance, const PerWheel<Soil>& soils,
                                     const DriveCommand& command) const;
  // What acts besides weight and ground in the solves that follow; nothing, unless it is set.
  void set_outside(const std::optional<OutsideWrench>& wrench) { outside_ = wrench; }
  // Forgets the last answer, so that the next solve is a cold start.
  void reset() {
    warm_ = false;
    last_slopes_.reset();
  }

 private:
  StationState solve_with_slip_curves(const Stance& stance, const PerWheel<Soil>& soils,
                                      const DriveCommand& command, Thoroughness thoroughness);
  StationState solve(RoverBalance& balance, const DriveCommand& command, const Start* start,
                     Thoroughness thoroughness);

  const RoverModel& rover_;
  double gravity_m_s2_;
  Precision precision_;
  std::optional<OutsideWrench> outside_;
  bool warm_ = false;
  decltype(Start::unknowns) last_;
  std::optional<RoverBalance::WheelSlopes> last_slopes_;  // of draws
};

}  // namespace slipway::sim
