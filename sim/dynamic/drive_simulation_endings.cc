// What ends a drive before its last leg: the belly, the events, and a lack of progress.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/angle.h"
#include "sim/dynamic/drive_simulation.h"

namespace slipway::sim {
namespace {

// Progress is not judged before this length was commanded, in wheel radii: soil must shear before it grips.
constexpr double kMinCommanded_radii = 0.5;
constexpr double kBellyLook_m = 0.01;  // travel of the body's ends between two checks of the belly

// The value to print with two decimals, so that no "-0.00" is printed.
double printed_m(double metres) {
  return std::abs(metres) < 0.005 ? 0.0 : metres;
}

}  // namespace

// Checks the belly's clearance only where the rover has moved, since settling and sinking alone lower it
// slowly.
void DriveSimulation::watch_belly() {
  const Pose2 at = dynamics_.pose(state());
  if (belly_looked_ &&
      way_m(*belly_looked_) + 0.5 * rover_.body_length_m * std::abs(at.yaw_rad - belly_looked_->yaw_rad) <
          kBellyLook_m)
    return;
  belly_looked_ = at;
  const BellyClearance belly = dynamics_.belly(state());
  if (belly.least_m <= 0.0)
    end(DriveEnd::kImmobilised,
        fmt::format("belly on the ground at ({:.2f}, {:.2f}) m after {:.2f} m: tilt {:.1f} deg",
                    belly.place.x(), belly.place.y(), printed_m(progress_m(state())),
                    deg_from_rad(dynamics_.tilt_rad(state()))));
}

void DriveSimulation::take_events() {
  const std::span<const int> direction = integrator_.event_directions();
  if (direction[0] < 0 && driver_) {
    driver_->stop(now_s_);
    integrator_.end_at_event();
  }
  if (direction[1] < 0)
    end(DriveEnd::kTipped,
        fmt::format("tips over: tilt {:.0f} deg", deg_from_rad(dynamics_.tilt_rad(state()))));
  for (int k = 0; k < dynamics_.wheels(); ++k) {
    const int sunk = direction[2 + 3 * k], lifted = direction[3 + 3 * k], stalled = direction[4 + 3 * k];
    if (sunk < 0)
      end(DriveEnd::kSunkToAxle, fmt::format("wheel {} sinks to its axle", rover_.wheels[k].name));
    if (began_s_ < 0.0) continue;
    const double t = now_s_ - began_s_;
    if (lifted != 0) note({lifted < 0 ? DriveEventKind::kLiftOff : DriveEventKind::kTouchDown, t, k, leg_});
    if (stalled != 0) note({stalled < 0 ? DriveEventKind::kStall : DriveEventKind::kStallEnds, t, k, leg_});
  }
  for (std::size_t j = 2 + 3 * dynamics_.wheels(); j < direction.size(); ++j)
    if (direction[j] < 0 && began_s_ >= 0.0) note({DriveEventKind::kJointStop, now_s_ - began_s_, -1, leg_});
}

// The commanded distance on a share of a leg; when turning in place, that of the outer wheels.
double DriveSimulation::leg_way_m(const DriveLeg& leg, double share) const {
  return share * (leg.command.turn_in_place ? 0.5 * rover_.track_m() * leg.turn_rad : leg.length_m);
}

// Judges the progress on a leg that ended before give_up_s: on the whole of it, and on its second half, so
// that a rover that dug itself in on the way has not arrived.
void DriveSimulation::check_leg(const DriveLeg& leg, double share_before) {
  const double share = dynamics_.place(state()).share;
  const auto stuck = [&](double from, double commanded) {
    return share - from < kMinProgress * commanded &&
           leg_way_m(leg, commanded - (share - from)) >=
               kMinCommanded_radii * rover_.smallest_wheel_radius_m();
  };
  const std::string of_leg = fmt::format("leg {} of {}", leg_ + 1, legs_.size());
  if (stuck(share_before, 1.0)) {
    end(DriveEnd::kImmobilised, stuck_text("no progress on " + of_leg, *before_halt_));
  } else if (half_share_ && stuck(*half_share_, 0.5)) {
    end(DriveEnd::kImmobilised, stuck_text("no progress on the second half of " + of_leg, *before_halt_));
  }
}

// Judges the progress every give_up_s of cruise, or later where too little was commanded in that time.
void DriveSimulation::check_progress(const DriveLeg& leg) {
  if (now_s_ < driver_->ramped_s()) {
    checked_s_ = now_s_;
    checked_share_ = dynamics_.place(state()).share;
    return;
  }
  if (ended_ || now_s_ - checked_s_ < options_.give_up_s) return;
  const double share = dynamics_.place(state()).share;
  const double commanded =
      (now_s_ - checked_s_) / commanded_duration_s(leg) * attainable_share(rover_, leg.command);
  if (leg_way_m(leg, commanded) < kMinCommanded_radii * rover_.smallest_wheel_radius_m()) return;
  if (share - checked_share_ < kMinProgress * commanded)
    end(DriveEnd::kImmobilised, stuck_text(fmt::format("no progress for {:.0f} s", now_s_ - checked_s_),
                                           dynamics_.sample(now_s_, state())));
  checked_s_ = now_s_;
  checked_share_ = share;
}

std::string DriveSimulation::stuck_text(const std::string& what, const DriveSample& sample) const {
  std::size_t worst = 0;
  for (std::size_t k = 0; k < sample.wheels.size(); ++k)
    if (sample.wheels[k].sinkage_m > sample.wheels[worst].sinkage_m) worst = k;
  const WheelState& wheel = sample.wheels[worst];
  return fmt::format(
             "{} after {:.2f} m: tilt {:.1f} deg, slip {:.2f}, deepest wheel {} at {:.3f} m with slip {:.2f} "
             "and {:.2f} A",
             what, printed_m(progress_m(state())), deg_from_rad(sample.attitude.tilt_rad()),
             sample.slip_ratio, rover_.wheels[worst].name, wheel.sinkage_m, wheel.slip_ratio,
             wheel.current_a) +
         stall_text();
}

// Names the motor and its limit where that is what stops the wheels.
std::string DriveSimulation::stall_text() const {
  const std::optional<RoverDynamics::Stall>& stall = dynamics_.stall();
  if (!stall) return "";
  const std::string& wheel = rover_.wheels[stall->wheel].name;
  if (stall->limit == MotorLimit::kCurrent)
    return fmt::format("; the motor of wheel {} stalls at its current limit of {:.2f} A", wheel,
                       rover_.drive.max_current_a.value_or(0.0));
  return fmt::format("; the motor of wheel {} stalls at the bus voltage of {:.1f} V, with {:.2f} A", wheel,
                     rover_.drive.bus_voltage_v, stall->current_a);
}

void DriveSimulation::end(DriveEnd how, std::string reason) {
  if (ended_) return;
  ended_ = true;
  out_.end = how;
  out_.reason = std::move(reason);
}

}  // namespace slipway::sim
