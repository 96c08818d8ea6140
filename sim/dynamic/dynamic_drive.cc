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

constexpr double kLongestSettling_s = 40.0;
constexpr double kAtRest_m_s = 2e-5;    // slower counts as at rest
constexpr double kRestFor_s = 0.5;      // and must last
constexpr double kSliding_m_s = 5e-4;   // faster drift, over the second half of kLongestSettling_s: slides
constexpr double kSlid_m = 0.2;         // farther than this while settling: the same
constexpr double kTelling_radii = 0.5;  // of a wheel: falling short by less says nothing, soil must give
constexpr double kLongestTravel_radii = 0.5;  // of a wheel within one step
constexpr double kBellyLook_m = 0.01;         // of way, or of a turn at the body's ends, between looks at it
constexpr double kNudge_s = 1e-6;
constexpr long kMostStepsPerSecond = 4000;  // more, over a second: the motion is too rough to follow

// To the centimetre, without a sign where that is 0.
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
                    kLongestTravel_radii * rover.smallest_wheel_radius_m() / rover.cruise_speed_m_s),
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
    out_.commanded = out_.start;
    for (const DriveLeg& leg : legs_) out_.commanded = commanded_pose(leg, out_.commanded, 1.0);
    for (leg_ = 0; leg_ < static_cast<int>(legs_.size()) && !ended_; ++leg_)
      if (auto driven = drive_leg(legs_[leg_]); !driven) return fail(std::move(driven.error()));
    return finish();
  }

 private:
  const double* state() const { return integrator_.state().data(); }

  // Until the rover stands still; time starts then. A rover that does not is an answer. One that rocks on its
  // wheels has speed but goes nowhere: its drift counts.
  Result<void> settle() {
    double still_since = 0.0, t = 0.0, half_t = 0.0;
    Pose2 half = put_down_;
    bool rests = false;
    while (t < kLongestSettling_s && !ended_) {
      auto step = advance(t < 0.5 * kLongestSettling_s ? 0.5 * kLongestSettling_s : kLongestSettling_s);
      if (!step) return fail(std::move(step.error()));
      t = step->t;
      if (t <= 0.5 * kLongestSettling_s) {
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

  Result<void> drive_leg(const DriveLeg& leg) {
    // A jump of the motion's third derivative only: no restart.
    const Pose2 leg_start = options_.feedback == Feedback::kNone
                                ? dynamics_.pose(state())
                                : next_start_.value_or(dynamics_.pose(state()));
    LegDriver driver(rover_, leg, options_.feedback, now_s_, dynamics_.steered_rad(state()));
    dynamics_.follow(&driver, leg_start);
    driver_ = &driver;
    before_leg_m_ = out_.progress_m;
    checked_s_ = now_s_;
    checked_share_ = 0.0;
    const double share_before = dynamics_.place(state()).share;
    // The profile's kinks are stops, so that no step smooths them over.
    while (!ended_ && now_s_ < driver.end_s()) {
      double stop = driver.end_s();
      for (const double kink : {driver.steered_s(), driver.ramped_s(), driver.cruised_s()})
        if (kink > now_s_ + kNudge_s) stop = std::min(stop, kink);
      if (!std::isfinite(stop)) stop = now_s_ + 10.0 * options_.give_up_s;
      auto step = advance(stop);
      if (!step) return fail(std::move(step.error()));
      check_progress(leg);
    }
    // With its pose fed back a leg ends where its way is done.
    if (!ended_ && options_.feedback != Feedback::kPose) check_leg(leg, share_before);
    note({.kind = DriveEventKind::kLegEnds, .time_s = now_s_ - began_s_, .leg = leg_});
    next_start_ = commanded_pose(leg, leg_start, 1.0);
    const PerWheel<double> steered = dynamics_.steered_rad(state());
    add_progress(leg);
    driver_ = nullptr;
    dynamics_.halt(steered);
    return {};
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

  // Never hangs: a motion that takes too many steps a second is refused.
  Result<void> check_pace(double t) {
    if (t - pace_s_ >= 1.0) {
      pace_s_ = t;
      pace_steps_ = 0;
    }
    if (++pace_steps_ <= kMostStepsPerSecond) return {};
    return fail(ErrorCode::kNotConverged,
                fmt::format("the motion is too rough to follow at {:.3f} s: more than {} steps in a second, "
                            "speed {:.3f} m/s, tilt {:.1f} deg",
                            t, kMostStepsPerSecond, dynamics_.speed_m_s(state()),
                            deg_from_rad(dynamics_.tilt_rad(state()))));
  }

  double done_share() const {
    if (whole_s_ <= 0.0) return 1.0;
    return std::min(1.0, (now_s_ - began_s_) / whole_s_);
  }

  // The integrator can't tell why the derivative refused.
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

  // By the integrator's steps: what is greatest does not depend on when samples are taken.
  void raise_peaks() {
    const RoverDynamics::Figures& figures = dynamics_.figures();
    const double at_m = std::max(0.0, progress_m(state()));  // slid back: no place on the way
    raise(out_.max_tilt_rad, dynamics_.tilt_rad(state()), at_m);
    raise(out_.max_current_a, figures.current_a, at_m);
    raise(out_.max_sinkage_m, figures.sinkage_m, at_m);
    if (figures.slip_ratio) raise(out_.max_slip_ratio, std::abs(*figures.slip_ratio), at_m);
  }

  // Settling and sinking alone bring it down slowly: where it moved is where to look.
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
    if (out_.events.size() < kMostEvents) out_.events.push_back(event);
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

  // The way of a share of a leg; of the wheels, when turning in place.
  double leg_way_m(const DriveLeg& leg, double share) const {
    return share * (leg.command.turn_in_place ? 0.5 * rover_.track_m() * leg.turn_rad : leg.length_m);
  }

  // A leg that is over before give_up_s.
  void check_leg(const DriveLeg& leg, double share_before) {
    const double made = dynamics_.place(state()).share - share_before;
    if (made >= kLeastProgress ||
        leg_way_m(leg, 1.0 - made) < kTelling_radii * rover_.smallest_wheel_radius_m())
      return;
    end(DriveEnd::kImmobilised,
        stuck_text(fmt::format("no progress on leg {} of {}", leg_ + 1, legs_.size())));
  }

  // Every give_up_s of cruise, or longer where too little was commanded in that time to tell.
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
    if (leg_way_m(leg, commanded) < kTelling_radii * rover_.smallest_wheel_radius_m()) return;
    if (share - checked_share_ < kLeastProgress * commanded)
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

  static constexpr std::size_t kMostEvents = 1000;

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
  double before_leg_m_ = 0.0, checked_s_ = 0.0, checked_share_ = 0.0;
};

std::vector<Fault> faults_of(std::span<const DriveLeg> legs, const DynamicOptions& options) {
  std::vector<Fault> faults;
  for (std::size_t i = 0; i < legs.size(); ++i) {
    const DriveLeg& leg = legs[i];
    const double duration = commanded_duration_s(leg);
    if (!(duration > 0.0) || !std::isfinite(duration))
      faults.push_back(
          {fmt::format("/legs/{}", i), "a leg needs a length or a turn, and a speed that is not 0"});
  }
  if (legs.empty()) faults.push_back({"/legs", "a drive needs a leg"});
  if (!(options.relative_tolerance >= 1e-10 && options.relative_tolerance <= 1e-2))
    faults.push_back(
        {"/relative_tolerance",
         fmt::format("relative_tolerance = {:g}, must be in [1e-10, 0.01]", options.relative_tolerance)});
  if (options.contact_points < 1 || options.contact_points > 9)
    faults.push_back(
        {"/contact_points", fmt::format("contact_points = {}, must be in [1, 9]", options.contact_points)});
  if (!(options.sample_interval_s > 0.0))
    faults.push_back({"/sample_interval_s", "sample_interval_s must be above 0"});
  return faults;
}

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
  return simulate_drive_on(rover, gravity_m_s2, GroundWithLaws(ground, soils), soils, start, legs, options, sink,
                           progress);
}

}  // namespace

DriveSoils mean_soils(const SoilBeliefs& beliefs) {
  DriveSoils soils;
  for (const SoilDistribution& belief : beliefs.known) soils.known.push_back(belief.mean);
  soils.unknown = beliefs.unknown.mean;
  return soils;
}

std::string_view describe(DriveEnd end) {
  switch (end) {
    case DriveEnd::kFinished:
      return "finished";
    case DriveEnd::kImmobilised:
      return "immobilised";
    case DriveEnd::kTipped:
      return "tipped";
    case DriveEnd::kSunkToAxle:
      return "sunk_to_axle";
    case DriveEnd::kSlid:
      return "slid";
  }
  return "unknown";
}

std::string_view describe(DriveEventKind kind) {
  switch (kind) {
    case DriveEventKind::kLegEnds:
      return "leg_ends";
    case DriveEventKind::kLiftOff:
      return "lift_off";
    case DriveEventKind::kTouchDown:
      return "touch_down";
    case DriveEventKind::kStall:
      return "stall";
    case DriveEventKind::kStallEnds:
      return "stall_ends";
    case DriveEventKind::kJointStop:
      return "joint_stop";
  }
  return "unknown";
}

double final_slip_ratio(const DynamicDrive& drive) {
  if (drive.commanded_m <= 0.0) return 0.0;
  return std::hypot(drive.final.x_m - drive.commanded.x_m, drive.final.y_m - drive.commanded.y_m) /
         drive.commanded_m;
}

Result<DynamicDrive> simulate_drive(const RoverModel& rover, double gravity_m_s2, const Ground& ground,
                                    const DriveSoils& soils, const Pose2& start,
                                    std::span<const DriveLeg> legs, const DynamicOptions& options,
                                    const DriveSink& sink, Progress& progress) {
  if (auto faults = faults_of(legs, options); !faults.empty())
    return fail(ErrorCode::kInvalidRequest, "the drive can't be simulated", std::move(faults));
  const auto has_curve = [](const Soil& soil) { return soil.slip_curve != nullptr; };
  if (std::any_of(soils.known.begin(), soils.known.end(), has_curve) || has_curve(soils.unknown))
    return simulate_drive_beside_slip_curves(rover, gravity_m_s2, ground, soils, start, legs, options, sink, progress);
  return simulate_drive_on(rover, gravity_m_s2, ground, soils, start, legs, options, sink, progress);
}

}  // namespace slipway::sim
