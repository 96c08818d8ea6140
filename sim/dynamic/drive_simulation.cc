#include "sim/dynamic/drive_simulation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/angle.h"

namespace slipway::sim {
namespace {

constexpr double kMaxSettling_s = 40.0;
constexpr double kAtRest_m_s = 2e-5;      // a slower rover counts as at rest
constexpr double kRestFor_s = 0.5;        // and must stay so for this time
constexpr double kSliding_m_s = 5e-4;     // a rover that drifts faster in the second half of settling slides
constexpr double kSlid_m = 0.2;           // a rover that drifts farther while settling slides too
constexpr double kMaxTravel_radii = 0.5;  // of a wheel within one step
constexpr double kNudge_s = 1e-6;
constexpr double kSameHeading_rad = rad_from_deg(1.0);  // a turn that overshot by less is not taken back
// A heading further from the one that leads back to a leg's line is turned in place before the leg: at the
// tightest correction, steering by so much takes two metres.
constexpr double kSteeredBack_rad = rad_from_deg(20.0);

}  // namespace

DriveSimulation::DriveSimulation(const RoverModel& rover, double gravity_m_s2, const Ground& ground,
                                 const DriveSoils& soils, std::span<const DriveLeg> legs,
                                 const DynamicOptions& options, const DriveSink& sink, Progress& progress)
    : rover_(rover),
      ground_(ground),
      soils_(soils),
      legs_(legs),
      options_(options),
      sink_(sink),
      progress_(progress),
      dynamics_(rover, gravity_m_s2, ground, soils, options),
      integrator_({.size = dynamics_.size(),
                   .absolute_only = dynamics_.pose_size(),
                   .derivative = [this](double t, const double* y,
                                        double* rate) { return dynamics_.derivative(t, y, rate); },
                   .event_count = dynamics_.event_count(),
                   .events = [this](double t, const double* y,
                                    double* value) { return dynamics_.events(t, y, value); }},
                  options.relative_tolerance, dynamics_.tolerances(options.relative_tolerance, false),
                  kMaxTravel_radii * rover.smallest_wheel_radius_m() / rover.cruise_speed_m_s),
      between_(dynamics_.size()) {
  for (const DriveLeg& leg : legs) {
    out_.commanded_m += leg.command.turn_in_place ? 0.0 : leg.length_m;
    whole_s_ += commanded_duration_s(leg);
  }
}

Result<DynamicDrive> DriveSimulation::run(const Stance& stance) {
  const std::vector<double> y = dynamics_.at_rest(stance);
  dynamics_.halt(PerWheel<double>(rover_.wheels.size()));
  dynamics_.after_step(0.0, y.data());
  integrator_.start(0.0, y);
  put_down_ = dynamics_.pose(state());
  if (auto settled = settle(); !settled) return fail(std::move(settled.error()));
  out_.start = dynamics_.pose(state());
  // The rover's software knows where it was to start, also where it slides a little as it settles.
  if (options_.feedback == Feedback::kPose) next_start_ = put_down_;
  out_.commanded = next_start_.value_or(out_.start);
  for (const DriveLeg& leg : legs_) out_.commanded = commanded_pose(leg, out_.commanded, 1.0);
  for (leg_ = 0; leg_ < static_cast<int>(legs_.size()) && !ended_; ++leg_)
    if (auto driven = drive_leg(legs_[leg_]); !driven) return fail(std::move(driven.error()));
  return finish();
}

// Integrates until the rover stands still, and starts the drive's time then. A rover that slides instead
// ends the drive with that answer. A rover that rocks on its wheels has speed but goes nowhere, so that its
// drift decides.
Result<void> DriveSimulation::settle() {
  double still_since = 0.0, t = 0.0, half_t = 0.0;
  Pose2 half = put_down_;
  bool rests = false;
  while (t < kMaxSettling_s && !ended_) {
    auto step = advance(t < 0.5 * kMaxSettling_s ? 0.5 * kMaxSettling_s : kMaxSettling_s);
    if (!step) return fail(std::move(step.error()));
    t = step->t;
    if (t <= 0.5 * kMaxSettling_s) {
      half_t = t;
      half = dynamics_.pose(state());
    }
    if (dynamics_.speed_m_s(state()) > kAtRest_m_s) still_since = t;
    rests = t - still_since > kRestFor_s;
    if (rests || way_m(put_down_) > kSlid_m) break;
  }
  const bool far = way_m(put_down_) > kSlid_m;
  const double drift_m_s = !rests && t > half_t ? way_m(half) / (t - half_t) : 0.0;
  if (!ended_ && (far || drift_m_s > kSliding_m_s))
    end(DriveEnd::kSlid,
        fmt::format("does not come to rest at its start: slides at {:.1f} mm/s on a tilt of {:.1f} deg",
                    1e3 * (far ? way_m(put_down_) / t : drift_m_s),
                    deg_from_rad(dynamics_.tilt_rad(state()))));
  began_s_ = t;
  last_sample_s_ = t;
  checked_s_ = t;
  dynamics_.reset_counts();
  raise_peaks();
  watch_belly();
  record(t, state());
  return {};
}

double DriveSimulation::way_m(const Pose2& from) const {
  const Pose2 at = dynamics_.pose(state());
  return std::hypot(at.x_m - from.x_m, at.y_m - from.y_m);
}

// With pose feedback a leg's line is where the commanded drive has it, not where the one before it ended:
// it is joined by turning in place where the heading is too far off to be steered back.
Result<void> DriveSimulation::drive_leg(const DriveLeg& leg) {
  Pose2 leg_start = options_.feedback == Feedback::kNone ? dynamics_.pose(state())
                                                         : next_start_.value_or(dynamics_.pose(state()));
  next_start_ = commanded_pose(leg, leg_start, 1.0);
  const double before_m = out_.progress_m;
  const bool by_pose = options_.feedback == Feedback::kPose;
  const DriveLeg piece = by_pose ? rest_of_turn(leg, leg_start) : leg;
  if (by_pose && !piece.command.turn_in_place)
    if (auto turned = turn_onto(piece, leg_start); !turned) return turned;
  if (!ended_ && !(by_pose && is_past(piece, leg_start)))
    if (auto driven = drive_piece(piece, leg_start); !driven) return driven;
  note({.kind = DriveEventKind::kLegEnds, .time_s = now_s_ - began_s_, .leg = leg_});
  // How far the rover rolled past a leg's end is no progress on the next.
  if (by_pose && !ended_) out_.progress_m = before_m + (leg.command.turn_in_place ? 0.0 : leg.length_m);
  return {};
}

// What is left of a turn from the rover's true heading to the commanded one: the other way round where it
// has turned too far already. Other legs are left alone. Headings are counted from the nearest to the true
// one of those that differ by whole turns.
DriveLeg DriveSimulation::rest_of_turn(const DriveLeg& leg, Pose2& leg_start) const {
  const double yaw = dynamics_.pose(state()).yaw_rad;
  leg_start.yaw_rad = yaw - wrapped_rad(yaw - leg_start.yaw_rad);
  if (!leg.command.turn_in_place) return leg;
  const double left = leg_start.yaw_rad + std::copysign(leg.turn_rad, leg.command.turn_rate_rad_s) - yaw;
  if (left * leg.command.turn_rate_rad_s >= 0.0) return leg;
  DriveLeg back = leg;
  back.command.turn_rate_rad_s = -leg.command.turn_rate_rad_s;
  back.turn_rad = std::abs(left) > kSameHeading_rad ? std::abs(left) : 0.0;
  leg_start.yaw_rad = yaw;
  return back;
}

bool DriveSimulation::is_past(const DriveLeg& leg, const Pose2& leg_start) const {
  const Pose2 now = dynamics_.pose(state());
  return place_on_leg(leg, leg_start, now, now.yaw_rad - leg_start.yaw_rad).share >= 1.0;
}

// Turns in place to the heading that leads back to the leg's line, where steering alone would need long.
Result<void> DriveSimulation::turn_onto(const DriveLeg& leg, const Pose2& leg_start) {
  const Pose2 now = dynamics_.pose(state());
  const LegPlace place = place_on_leg(leg, leg_start, now, now.yaw_rad - leg_start.yaw_rad);
  const double turn_rad = wrapped_rad(heading_to_line_rad(rover_, place) - place.heading_rad);
  if (place.share >= 1.0 || std::abs(turn_rad) < kSteeredBack_rad) return {};
  DriveLeg turn{.command = leg.command, .turn_rad = std::abs(turn_rad)};
  turn.command.turn_in_place = true;
  turn.command.turn_rate_rad_s = std::copysign(rover_.turn_rate_rad_s, turn_rad);
  return drive_piece(turn, now);
}

Result<void> DriveSimulation::drive_piece(const DriveLeg& leg, const Pose2& leg_start) {
  // Following the driver changes only the third derivative of the motion, so that no restart is needed.
  LegDriver driver(rover_, leg, options_.feedback, now_s_, dynamics_.steered_rad(state()));
  // After a turn the ground falls away to another side.
  if (leg.command.turn_in_place) trim_rad_ = 0.0;
  driver.trim(trim_rad_);
  trimmed_share_.reset();
  dynamics_.follow(&driver, leg_start);
  integrator_.set_tolerances(dynamics_.tolerances(options_.relative_tolerance, true));
  driver_ = &driver;
  before_leg_m_ = out_.progress_m;
  checked_s_ = now_s_;
  checked_share_ = 0.0;
  half_share_.reset();
  before_halt_.reset();
  const double share_before = dynamics_.place(state()).share;
  // The steps stop at the kinks of the rates' profile, so that no step smooths one over.
  while (!ended_ && now_s_ < driver.end_s()) {
    double stop = driver.end_s();
    for (const double kink : {driver.steered_s(), driver.ramped_s(), driver.cruised_s()})
      if (kink > now_s_ + kNudge_s) stop = std::min(stop, kink);
    if (!std::isfinite(stop)) stop = now_s_ + 10.0 * options_.give_up_s;
    auto step = advance(stop);
    if (!step) return fail(std::move(step.error()));
    stop_where_done(driver);
    trim(driver, leg);
    if (!half_share_ && now_s_ >= 0.5 * (driver.ramped_s() + driver.cruised_s()))
      half_share_ = dynamics_.place(state()).share;
    if (!before_halt_ && now_s_ >= driver.cruised_s()) before_halt_ = dynamics_.sample(now_s_, state());
    check_progress(leg);
  }
  // With pose feedback a leg ends only where its length is done, so that there is nothing to check.
  if (!ended_ && options_.feedback != Feedback::kPose) check_leg(leg, share_before);
  const PerWheel<double> steered = dynamics_.steered_rad(state());
  add_progress(leg);
  driver_ = nullptr;
  dynamics_.halt(steered);
  integrator_.set_tolerances(dynamics_.tolerances(options_.relative_tolerance, false));
  return {};
}

// The event of a leg's end is a change of sign: a leg that begins behind that place would never end.
void DriveSimulation::stop_where_done(LegDriver& driver) {
  if (options_.feedback != Feedback::kPose || std::isfinite(driver.cruised_s())) return;
  if (dynamics_.place(state()).share >= 1.0 - driver.stopping_share()) {
    driver.stop(now_s_);
    integrator_.end_at_event();
  }
}

// Only while the rover gets on: one that spins on the spot learns nothing about its side slip.
void DriveSimulation::trim(LegDriver& driver, const DriveLeg& leg) {
  if (options_.feedback != Feedback::kPose || leg.command.turn_in_place) return;
  const LegPlace place = dynamics_.place(state());
  const double driven_m = leg.length_m * (place.share - trimmed_share_.value_or(place.share));
  trimmed_share_ = place.share;
  trim_rad_ = trimmed_rad(rover_, place, std::max(0.0, driven_m), trim_rad_);
  driver.trim(trim_rad_);
}

void DriveSimulation::add_progress(const DriveLeg& leg) {
  if (!leg.command.turn_in_place)
    out_.progress_m = before_leg_m_ + leg.length_m * dynamics_.place(state()).share;
}

DynamicDrive DriveSimulation::finish() {
  if (recorded_s_ < now_s_) record(now_s_, state());
  out_.duration_s = now_s_ - began_s_;
  out_.energy_j = dynamics_.energy_j();
  out_.final = dynamics_.pose(state());
  const CvodeIntegrator::Work work = integrator_.work();
  out_.work = {work.steps, work.evaluations, work.jacobians, 0};
  out_.ruts = std::move(dynamics_.ruts());
  progress_.report("driving", 1.0);
  return std::move(out_);
}

}  // namespace slipway::sim
