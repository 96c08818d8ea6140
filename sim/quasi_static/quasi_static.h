#pragma once

#include <Eigen/Core>
#include <optional>
#include <string_view>

#include "sim/rover/drive_command.h"
#include "sim/rover/rover_model.h"
#include "sim/rover/stance.h"
#include "sim/soil/soil.h"
#include "sim/wheel/per_wheel.h"

namespace slipway::sim {

struct WheelState {
  double load_n = 0.0;           // along the ground's normal
  double rate_rad_s = 0.0;       // that the wheel really turns at, positive rolls forward
  double slip_ratio = 0.0;       // [-1, 1], positive driving [ARTEMIS eq. 21]
  double slip_angle_rad = 0.0;   // of the wheel's velocity to its plane, positive to the left
  double entry_angle_rad = 0.0;  // into the soil that the wheel meets: in a track, from the rut's bottom
  double sinkage_m = 0.0;        // of the lowest point below the undisturbed surface
  double drawbar_pull_n = 0.0;   // along the rolling direction
  double lateral_force_n = 0.0;  // to the left
  double torque_nm = 0.0;        // that turns the wheel against the soil, positive drives forward; a driven
                                 // wheel's motor overcomes its drag besides
  double current_a = 0.0;        // at the motor; 0 of a wheel that is not driven
  bool in_air = false;           // carries nothing: hangs over a hollow
};

enum class Outcome {
  kMoving,
  kNoTraction,    // all the thrust the soil gives does not hold the rover on the slope: it digs in or slides
                  // away
  kWheelLifted,   // the balance asks for a pulling wheel: the rover rears or tips
  kSunkToAxle,    // a wheel would sink to its axle
  kStalled,       // a motor would need more current or voltage than it has
  kNotConverged,  // the solver gave up: not a statement about the rover
  kOutsideSlipCurve,  // the soil is known by a slip curve, which has no such slope
};

// "no traction": for messages.
std::string_view describe(Outcome outcome);

// The balanced motion of the rover at one station.
struct StationState {
  Outcome outcome = Outcome::kMoving;
  int wheel = -1;             // the wheel that the outcome is about, where it is about one
  double along_m_s = 0.0;     // of B along the commanded direction of travel
  double forward_m_s = 0.0;   // of B along its x axis
  double leftward_m_s = 0.0;  // of B along its y axis: without crab, the side slip
  double yaw_rate_rad_s = 0.0;
  double slip_ratio = 0.0;     // of the rover: 1 - along / commanded; turning in place: of the yaw rate
  double side_slip_rad = 0.0;  // direction of B's velocity to the commanded direction, positive to the left
  double electric_power_w = 0.0;  // of the drive motors
  // What a camera looking back would measure: depth of the track behind each side's last wheel.
  double left_rut_depth_m = 0.0, right_rut_depth_m = 0.0;
  PerWheel<WheelState> wheels;
  // A wheel stands on ground that is known by a slip curve: speeds and slip are known, while nothing is of what stands
  // in `wheels`, of ruts and of power, all of which are 0.
  bool by_slip_curve = false;

  bool moving() const { return outcome == Outcome::kMoving; }
};

// How long to look before there is said to be no balance.
enum class Thoroughness {
  kSure,   // until every sure way has failed
  kQuick,  // Newton's searches alone, which miss one balance in thousands; then the outcome is kNotConverged
};

// Solves for the motion (along and across the direction of travel, yaw rate) and the entry angles at which
// the wheels' forces, gravity and the commanded wheel rates balance: see RoverBalance for the equations.
// Rovers with more wheels than their suspension can keep on the ground may lift some of them.
//
// A workspace: one per thread. Each solve starts from the last one's answer and falls back to a cold start,
// so stations are best solved in order; the answer does not depend on the start beyond the solver's tolerance
// (1e-9 of the weight).
class QuasiStaticSolver {
 public:
  // A balance that was found and how the balance's equations change there: from it, the balances of the same
  // station with soils or a rover that differ a little are a few evaluations away.
  struct Start {
    Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 3 + kMostWheels, 1> unknowns;
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 3 + kMostWheels, 3 + kMostWheels>
        inverse_jacobian;
  };

  QuasiStaticSolver(const RoverModel& rover, double gravity_m_s2);

  // soils: the soil under each wheel. With a `start` it is in the last answer's place. Where a wheel stands on a soil
  // with a slip curve there is no balance: the motion is the slowest of those that the wheels' curves give and, where
  // other wheels stand on soils with laws, of the balance on these.
  StationState solve(const Stance& stance, const PerWheel<Soil>& soils, const DriveCommand& command,
                     const Start* start = nullptr, Thoroughness thoroughness = Thoroughness::kSure);
  StationState solve(const Stance& stance, const Soil& soil, const DriveCommand& command);
  // The last solve's balance, asked with what it was solved for, for others to start from; nothing where the
  // rover did not move on all of its wheels.
  std::optional<Start> start_of_last(const Stance& stance, const PerWheel<Soil>& soils,
                                     const DriveCommand& command) const;
  // Forget the last answer, so that the next solve is a cold start.
  void reset() { warm_ = false; }

 private:
  StationState solve_with_slip_curves(const Stance& stance, const PerWheel<Soil>& soils, const DriveCommand& command,
                                      Thoroughness thoroughness);

  const RoverModel& rover_;
  double gravity_m_s2_;
  bool warm_ = false;
  decltype(Start::unknowns) last_;
};

}  // namespace slipway::sim
