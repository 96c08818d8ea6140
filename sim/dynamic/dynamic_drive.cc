#include "sim/dynamic/dynamic_drive.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/angle.h"
#include "sim/dynamic/cvode_integrator.h"
#include "sim/dynamic/ground_with_laws.h"
#include "sim/dynamic/leg_driver.h"
#include "sim/dynamic/rover_dynamics.h"
#include "sim/rover/stance.h"

namespace slipway::sim {
namespace {

constexpr double kMaxSettling_s = 40.0;
constexpr double kAtRest_m_s = 2e-5;   // a slower rover counts as at rest
constexpr double kRestFor_s = 0.5;     // and must stay so for this time
constexpr double kSliding_m_s = 5e-4;  // a rover that drifts faster in the second half of settling slides
constexpr double kSlid_m = 0.2;        // a rover that drifts farther while settling slides too
// Progress is not judged before this length was commanded, in wheel radii: soil must shear before it grips.
constexpr double kMinCommanded_radii = 0.5;
constexpr double kMaxTravel_radii = 0.5;  // of a wheel within one step
constexpr double kBellyLook_m = 0.01;     // travel of the body's ends between two checks of the belly
constexpr double kNudge_s = 1e-6;
constexpr double kSameHeading_rad = rad_from_deg(1.0);  // a turn that overshot by less is not taken back
// A heading further from the one that leads back to a leg's line is turned in place before the leg: at the
// tightest correction, steering by so much takes two metres.
constexpr double kSteeredBack_rad = rad_from_deg(20.0);
constexpr long kMaxStepsPerSecond = 4000;  // a motion that needs more is too rough to follow

// The value to print with two decimals, so that no "-0.00" is printed.
double printed_m(double metres) {
  return std::abs(metres) < 0.005 ? 0.0 : metres;
}

class Drive {
 public:
  Drive(const RoverModel& rover, double gravity_m_s2, const Ground& ground, const DriveSoils& soils,
        std::span<const DriveLeg> legs, const DynamicOptions& options, const DriveSink& sink,
        Progress& progress)
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
                    options.relative_tolerance, dynamics_.tolerances(options.relative_tolerance),
                    kMaxTravel_radii * rover.smallest_wheel_radius_m() / rover.cruise_speed_m_s),
        between_(dynamics_.size()) {
    for (const DriveLeg& leg : legs) {
      out_.commanded_m += leg.command.turn_in_place ? 0.0 : leg.length_m;
      whole_s_ += commanded_duration_s(leg);
    }
  }

  Result<DynamicDrive> run(const Stance& stance) {
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

 private:
  const double* state() const { return integrator_.state().data(); }

  // Integrates until the rover stands still, and starts the drive's time then. A rover that slides instead
  // ends the drive with that answer. A rover that rocks on its wheels has speed but goes nowhere, so that its
  // drift decides.
  Result<void> settle() {
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

  double way_m(const Pose2& from) const {
    const Pose2 at = dynamics_.pose(state());
    return std::hypot(at.x_m - from.x_m, at.y_m - from.y_m);
  }

  // With pose feedback a leg's line is where the commanded drive has it, not where the one before it ended:
  // it is joined by turning in place where the heading is too far off to be steered back.
  Result<void> drive_leg(const DriveLeg& leg) {
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
  DriveLeg rest_of_turn(const DriveLeg& leg, Pose2& leg_start) const {
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

  bool is_past(const DriveLeg& leg, const Pose2& leg_start) const {
    const Pose2 now = dynamics_.pose(state());
    return place_on_leg(leg, leg_start, now, now.yaw_rad - leg_start.yaw_rad).share >= 1.0;
  }

  // Turns in place to the heading that leads back to the leg's line, where steering alone would need long.
  Result<void> turn_onto(const DriveLeg& leg, const Pose2& leg_start) {
    const Pose2 now = dynamics_.pose(state());
    const LegPlace place = place_on_leg(leg, leg_start, now, now.yaw_rad - leg_start.yaw_rad);
    const double turn_rad = wrapped_rad(heading_to_line_rad(rover_, place) - place.heading_rad);
    if (place.share >= 1.0 || std::abs(turn_rad) < kSteeredBack_rad) return {};
    DriveLeg turn{.command = leg.command, .turn_rad = std::abs(turn_rad)};
    turn.command.turn_in_place = true;
    turn.command.turn_rate_rad_s = std::copysign(rover_.turn_rate_rad_s, turn_rad);
    return drive_piece(turn, now);
  }

  Result<void> drive_piece(const DriveLeg& leg, const Pose2& leg_start) {
    // Following the driver changes only the third derivative of the motion, so that no restart is needed.
    LegDriver driver(rover_, leg, options_.feedback, now_s_, dynamics_.steered_rad(state()));
    // After a turn the ground falls away to another side.
    if (leg.command.turn_in_place) trim_rad_ = 0.0;
    driver.trim(trim_rad_);
    trimmed_share_.reset();
    dynamics_.follow(&driver, leg_start);
    driver_ = &driver;
    before_leg_m_ = out_.progress_m;
    checked_s_ = now_s_;
    checked_share_ = 0.0;
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
      check_progress(leg);
    }
    // With pose feedback a leg ends only where its length is done, so that there is nothing to check.
    if (!ended_ && options_.feedback != Feedback::kPose) check_leg(leg, share_before);
    const PerWheel<double> steered = dynamics_.steered_rad(state());
    add_progress(leg);
    driver_ = nullptr;
    dynamics_.halt(steered);
    return {};
  }

  // The event of a leg's end is a change of sign: a leg that begins behind that place would never end.
  void stop_where_done(LegDriver& driver) {
    if (options_.feedback != Feedback::kPose || std::isfinite(driver.cruised_s())) return;
    if (dynamics_.place(state()).share >= 1.0 - driver.stopping_share()) driver.stop(now_s_);
  }

  // Only while the rover gets on: one that spins on the spot learns nothing about its side slip.
  void trim(LegDriver& driver, const DriveLeg& leg) {
    if (options_.feedback != Feedback::kPose || leg.command.turn_in_place) return;
    const LegPlace place = dynamics_.place(state());
    const double driven_m = leg.length_m * (place.share - trimmed_share_.value_or(place.share));
    trimmed_share_ = place.share;
    trim_rad_ = trimmed_rad(rover_, place, std::max(0.0, driven_m), trim_rad_);
    driver.trim(trim_rad_);
  }

  void add_progress(const DriveLeg& leg) {
    if (!leg.command.turn_in_place)
      out_.progress_m = before_leg_m_ + leg.length_m * dynamics_.place(state()).share;
  }

  Result<CvodeIntegrator::Step> advance(double stop) {
    if (progress_.cancelled()) return fail(ErrorCode::kCancelled, "the drive was dismissed");
    auto step = integrator_.step(stop);
    if (!step) return fail(off_ground(std::move(step.error())));
    if (auto followed = check_pace(step->t); !followed) return fail(off_ground(std::move(followed.error())));
    if (began_s_ >= 0.0) emit_samples(step->t);
    now_s_ = step->t;
    dynamics_.after_step(now_s_, state());
    if (began_s_ >= 0.0) {
      raise_peaks();
      watch_belly();
    }
    if (step->event) take_events();
    if (driver_ && ++steps_ % 256 == 0) progress_.report("driving", done_share());
    return step;
  }

  // Refuses a motion that takes too many steps per second of motion, so that no drive hangs.
  Result<void> check_pace(double t) {
    if (t - pace_s_ >= 1.0) {
      pace_s_ = t;
      pace_steps_ = 0;
    }
    if (++pace_steps_ <= kMaxStepsPerSecond) return {};
    return fail(ErrorCode::kNotConverged,
                fmt::format("the motion is too rough to follow at {:.3f} s: more than {} steps in a second, "
                            "speed {:.3f} m/s, tilt {:.1f} deg",
                            t, kMaxStepsPerSecond, dynamics_.speed_m_s(state()),
                            deg_from_rad(dynamics_.tilt_rad(state()))));
  }

  double done_share() const {
    if (whole_s_ <= 0.0) return 1.0;
    return std::min(1.0, (now_s_ - began_s_) / whole_s_);
  }

  // Replaces the integrator's error, which cannot know why the derivative refused, where the ground was lost.
  Error off_ground(Error error) {
    const std::optional<Eigen::Vector2d>& lost = dynamics_.lost_ground();
    if (!lost) return error;
    const Pose2 at = dynamics_.pose(state());
    if (on_slip_curve(ground_, soils_, lost->x(), lost->y()))
      return {ErrorCode::kInvalidRequest, slip_curve_reason(*lost), {}};
    return {ErrorCode::kNoData,
            fmt::format("the drive leaves the known ground at ({:.2f}, {:.2f}) m, with the rover at ({:.2f}, "
                        "{:.2f}) m after {:.1f} s",
                        lost->x(), lost->y(), at.x_m, at.y_m, now_s_ - began_s_),
            {}};
  }

  void emit_samples(double until) {
    while (last_sample_s_ + options_.sample_interval_s <= until) {
      last_sample_s_ += options_.sample_interval_s;
      integrator_.interpolate(last_sample_s_, between_);
      record(last_sample_s_, between_.data());
    }
  }

  void record(double t, const double* y) {
    DriveSample sample = dynamics_.sample(t, y);
    sample.time_s = t - began_s_;
    sample.leg = std::min(leg_, std::max(0, static_cast<int>(legs_.size()) - 1));
    sample.progress_m = progress_m(y);
    if (sink_) sink_(sample);
    recorded_s_ = t;
  }

  double progress_m(const double* y) const {
    if (!driver_ || driver_->leg().command.turn_in_place) return out_.progress_m;
    return before_leg_m_ + driver_->leg().length_m * dynamics_.place(y).share;
  }

  // Called at the integrator's steps, so that the maxima do not depend on the sample interval.
  void raise_peaks() {
    const RoverDynamics::Figures& figures = dynamics_.figures();
    const double at_m = std::max(0.0, progress_m(state()));  // a rover that slid back is not on the way
    raise(out_.max_tilt_rad, dynamics_.tilt_rad(state()), at_m);
    raise(out_.max_current_a, figures.current_a, at_m);
    raise(out_.max_sinkage_m, figures.sinkage_m, at_m);
    if (figures.slip_ratio) raise(out_.max_slip_ratio, std::abs(*figures.slip_ratio), at_m);
  }

  // Checks the belly's clearance only where the rover has moved, since settling and sinking alone lower it
  // slowly.
  void watch_belly() {
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

  static void raise(Peak& peak, double value, double distance_m) {
    if (value > peak.value) peak = {value, distance_m};
  }

  void note(DriveEvent event) {
    if (out_.events.size() < kMaxEvents) out_.events.push_back(event);
  }

  void take_events() {
    const std::span<const int> direction = integrator_.event_directions();
    if (direction[0] < 0 && driver_) driver_->stop(now_s_);
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
      if (direction[j] < 0 && began_s_ >= 0.0)
        note({DriveEventKind::kJointStop, now_s_ - began_s_, -1, leg_});
  }

  // The commanded distance on a share of a leg; when turning in place, that of the outer wheels.
  double leg_way_m(const DriveLeg& leg, double share) const {
    return share * (leg.command.turn_in_place ? 0.5 * rover_.track_m() * leg.turn_rad : leg.length_m);
  }

  // Judges the progress on a leg that ended before give_up_s.
  void check_leg(const DriveLeg& leg, double share_before) {
    const double made = dynamics_.place(state()).share - share_before;
    if (made >= kMinProgress ||
        leg_way_m(leg, 1.0 - made) < kMinCommanded_radii * rover_.smallest_wheel_radius_m())
      return;
    end(DriveEnd::kImmobilised,
        stuck_text(fmt::format("no progress on leg {} of {}", leg_ + 1, legs_.size())));
  }

  // Judges the progress every give_up_s of cruise, or later where too little was commanded in that time.
  void check_progress(const DriveLeg& leg) {
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
      end(DriveEnd::kImmobilised, stuck_text(fmt::format("no progress for {:.0f} s", now_s_ - checked_s_)));
    checked_s_ = now_s_;
    checked_share_ = share;
  }

  std::string stuck_text(const std::string& what) {
    const DriveSample sample = dynamics_.sample(now_s_, state());
    std::size_t worst = 0;
    for (std::size_t k = 0; k < sample.wheels.size(); ++k)
      if (sample.wheels[k].sinkage_m > sample.wheels[worst].sinkage_m) worst = k;
    const WheelState& wheel = sample.wheels[worst];
    return fmt::format(
        "{} after {:.2f} m: tilt {:.1f} deg, slip {:.2f}, deepest wheel {} at {:.3f} m with slip {:.2f} and "
        "{:.2f} A",
        what, printed_m(progress_m(state())), deg_from_rad(sample.attitude.tilt_rad()), sample.slip_ratio,
        rover_.wheels[worst].name, wheel.sinkage_m, wheel.slip_ratio, wheel.current_a);
  }

  void end(DriveEnd how, std::string reason) {
    if (ended_) return;
    ended_ = true;
    out_.end = how;
    out_.reason = std::move(reason);
  }

  DynamicDrive finish() {
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

  static constexpr std::size_t kMaxEvents = 1000;

  const RoverModel& rover_;
  const Ground& ground_;
  const DriveSoils& soils_;
  std::span<const DriveLeg> legs_;
  const DynamicOptions& options_;
  const DriveSink& sink_;
  Progress& progress_;
  RoverDynamics dynamics_;
  CvodeIntegrator integrator_;
  std::vector<double> between_;
  DynamicDrive out_;
  LegDriver* driver_ = nullptr;
  Pose2 put_down_;
  std::optional<Pose2> next_start_, belly_looked_;
  int leg_ = 0;
  bool ended_ = false;
  long steps_ = 0, pace_steps_ = 0;
  double pace_s_ = 0.0;
  double whole_s_ = 0.0, now_s_ = 0.0, began_s_ = -1.0, last_sample_s_ = 0.0, recorded_s_ = -1.0;
  double trim_rad_ = 0.0;
  std::optional<double> trimmed_share_;  // of the leg, when the trim was last set
  double before_leg_m_ = 0.0, checked_s_ = 0.0, checked_share_ = 0.0;
};

Result<DynamicDrive> simulate_drive_on(const RoverModel& rover, double gravity_m_s2, const Ground& ground,
                                       const DriveSoils& soils, const Pose2& start,
                                       std::span<const DriveLeg> legs, const DynamicOptions& options,
                                       const DriveSink& sink, Progress& progress) {
  const double c = std::cos(start.yaw_rad), s = std::sin(start.yaw_rad);
  for (const WheelModel& wheel : rover.wheels) {
    const double x = start.x_m + c * wheel.position_m.x() - s * wheel.position_m.y();
    const double y = start.y_m + s * wheel.position_m.x() + c * wheel.position_m.y();
    if (!ground.at(x, y))
      return fail(
          ErrorCode::kNoData,
          fmt::format("no elevation under wheel {} at the start, ({:.2f}, {:.2f}) m", wheel.name, x, y));
  }
  const std::optional<Stance> stance = settle(rover, ground, start);
  if (!stance)
    return fail(ErrorCode::kInvalidRequest,
                "the suspension can't stand at the start: the ground is too uneven",
                {{"/start", fmt::format("no stance at ({:.2f}, {:.2f}) m", start.x_m, start.y_m)}});
  Drive drive(rover, gravity_m_s2, ground, soils, legs, options, sink, progress);
  return drive.run(*stance);
}

// Drives as far as the ground has soils with laws.
Result<DynamicDrive> simulate_drive_beside_slip_curves(const RoverModel& rover, double gravity_m_s2,
                                                       const Ground& ground, const DriveSoils& soils,
                                                       const Pose2& start, std::span<const DriveLeg> legs,
                                                       const DynamicOptions& options, const DriveSink& sink,
                                                       Progress& progress) {
  const double c = std::cos(start.yaw_rad), s = std::sin(start.yaw_rad);
  for (const WheelModel& wheel : rover.wheels) {
    const Eigen::Vector2d p(start.x_m + c * wheel.position_m.x() - s * wheel.position_m.y(),
                            start.y_m + s * wheel.position_m.x() + c * wheel.position_m.y());
    if (on_slip_curve(ground, soils, p.x(), p.y()))
      return fail(ErrorCode::kInvalidRequest, slip_curve_reason(p), {{"/start", slip_curve_reason(p)}});
  }
  return simulate_drive_on(rover, gravity_m_s2, GroundWithLaws(ground, soils), soils, start, legs, options,
                           sink, progress);
}

}  // namespace

Result<DynamicDrive> simulate_drive(const RoverModel& rover, double gravity_m_s2, const Ground& ground,
                                    const DriveSoils& soils, const Pose2& start,
                                    std::span<const DriveLeg> legs, const DynamicOptions& options,
                                    const DriveSink& sink, Progress& progress) {
  if (auto faults = faults_of(legs, options); !faults.empty())
    return fail(ErrorCode::kInvalidRequest, "the drive can't be simulated", std::move(faults));
  const auto has_curve = [](const Soil& soil) { return soil.slip_curve != nullptr; };
  if (std::any_of(soils.known.begin(), soils.known.end(), has_curve) || has_curve(soils.unknown))
    return simulate_drive_beside_slip_curves(rover, gravity_m_s2, ground, soils, start, legs, options, sink,
                                             progress);
  return simulate_drive_on(rover, gravity_m_s2, ground, soils, start, legs, options, sink, progress);
}

}  // namespace slipway::sim
