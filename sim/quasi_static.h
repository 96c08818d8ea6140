#pragma once

#include <array>
#include <string_view>

#include "sim/drive_command.h"
#include "sim/rover_model.h"
#include "sim/soil.h"
#include "sim/stance.h"

namespace slipway::sim {

struct WheelState {
  double load_n = 0.0;          // along the ground's normal
  double slip_ratio = 0.0;      // [-1, 1], positive driving [ARTEMIS eq. 21]
  double slip_angle_rad = 0.0;  // of the wheel's velocity to its plane, positive to the left
  double entry_angle_rad = 0.0;
  double sinkage_m = 0.0;
  double drawbar_pull_n = 0.0;   // along the rolling direction
  double lateral_force_n = 0.0;  // to the left
  double torque_nm = 0.0;        // at the wheel, positive drives forward
  double current_a = 0.0;        // at the motor
};

enum class Outcome {
  kMoving,
  kNoTraction,    // all the thrust the soil gives does not hold the rover on the slope: it digs in or slides
                  // away
  kWheelLifted,   // the balance asks for a pulling wheel: the rover rears or tips
  kSunkToAxle,    // a wheel would sink to its axle
  kStalled,       // a motor would need more current or voltage than it has
  kNotConverged,  // the solver gave up: not a statement about the rover
};

// "no traction": for messages.
std::string_view describe(Outcome outcome);

// The balanced motion of the rover at one station.
struct StationState {
  Outcome outcome = Outcome::kMoving;
  int wheel = -1;             // the wheel that the outcome is about, where it is about one
  double forward_m_s = 0.0;   // of B along its x axis
  double leftward_m_s = 0.0;  // of B along its y axis: the side slip
  double yaw_rate_rad_s = 0.0;
  double slip_ratio = 0.0;        // of the rover: 1 - forward / commanded; turning in place: of the yaw rate
  double side_slip_rad = 0.0;     // direction of B's velocity to its x axis
  double electric_power_w = 0.0;  // of the six drive motors
  std::array<WheelState, kWheels> wheels{};

  bool moving() const { return outcome == Outcome::kMoving; }
};

// Solves for the motion (forward, leftward, yaw rate) and the six entry angles at which the wheels' forces,
// gravity and the commanded wheel rates balance: three equations for thrust, side force and yaw moment, and
// six for the loads (vertical force, roll and pitch moments, the two bogies, the differential).
//
// A workspace: one per thread. Each solve starts from the last one's answer and falls back to a cold start,
// so stations are best solved in order; the answer does not depend on the start beyond the solver's tolerance
// (1e-9 of the weight).
class QuasiStaticSolver {
 public:
  QuasiStaticSolver(const RoverModel& rover, double gravity_m_s2);

  // soils: the soil under each wheel.
  StationState solve(const Stance& stance, const std::array<Soil, kWheels>& soils,
                     const DriveCommand& command);
  StationState solve(const Stance& stance, const Soil& soil, const DriveCommand& command);
  // Forget the last answer, so that the next solve is a cold start.
  void reset() { warm_ = false; }

 private:
  using Unknowns = Eigen::Matrix<double, 9, 1>;

  const RoverModel& rover_;
  double gravity_m_s2_;
  bool warm_ = false;
  Unknowns last_ = Unknowns::Zero();
};

}  // namespace slipway::sim
