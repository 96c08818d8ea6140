// The steps of a drive: the integrator's step, its pace, the samples and the maxima along the way.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/angle.h"
#include "sim/dynamic/drive_simulation.h"
#include "sim/dynamic/ground_with_laws.h"

namespace slipway::sim {
namespace {

constexpr long kMaxStepsPerSecond = 4000;  // a motion that needs more is too rough to follow
constexpr std::size_t kMaxEvents = 1000;

}  // namespace

Result<CvodeIntegrator::Step> DriveSimulation::advance(double stop) {
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
Result<void> DriveSimulation::check_pace(double t) {
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

double DriveSimulation::done_share() const {
  if (whole_s_ <= 0.0) return 1.0;
  return std::min(1.0, (now_s_ - began_s_) / whole_s_);
}

// Replaces the integrator's error, which cannot know why the derivative refused, where the ground was lost.
Error DriveSimulation::off_ground(Error error) {
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

void DriveSimulation::emit_samples(double until) {
  while (last_sample_s_ + options_.sample_interval_s <= until) {
    last_sample_s_ += options_.sample_interval_s;
    integrator_.interpolate(last_sample_s_, between_);
    record(last_sample_s_, between_.data());
  }
}

void DriveSimulation::record(double t, const double* y) {
  DriveSample sample = dynamics_.sample(t, y);
  sample.time_s = t - began_s_;
  sample.leg = std::min(leg_, std::max(0, static_cast<int>(legs_.size()) - 1));
  sample.progress_m = progress_m(y);
  if (sink_) sink_(sample);
  recorded_s_ = t;
}

double DriveSimulation::progress_m(const double* y) const {
  if (!driver_ || driver_->leg().command.turn_in_place) return out_.progress_m;
  return before_leg_m_ + driver_->leg().length_m * dynamics_.place(y).share;
}

// Called at the integrator's steps, so that the maxima do not depend on the sample interval.
void DriveSimulation::raise_peaks() {
  const RoverDynamics::Figures& figures = dynamics_.figures();
  const double at_m = std::max(0.0, progress_m(state()));  // a rover that slid back is not on the way
  out_.max_tilt_rad.raise(dynamics_.tilt_rad(state()), at_m);
  out_.max_current_a.raise(figures.current_a, at_m);
  out_.max_sinkage_m.raise(figures.sinkage_m, at_m);
  if (figures.slip_ratio) out_.max_slip_ratio.raise(std::abs(*figures.slip_ratio), at_m);
}

void DriveSimulation::note(DriveEvent event) {
  if (out_.events.size() < kMaxEvents) out_.events.push_back(event);
}

}  // namespace slipway::sim
