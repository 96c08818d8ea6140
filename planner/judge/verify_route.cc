#include "planner/judge/verify_route.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>

#include "core/angle.h"
#include "planner/judge/drive_legs.h"
#include "planner/problem/keep_out.h"
#include "planner/problem/terrain_ground.h"
#include "planner/search/overlap.h"
#include "sim/dynamic/dynamic_drive.h"
#include "sim/prediction/drive_risk.h"

namespace slipway::planner {
namespace {

// Keeps every k-th sample, k doubled whenever they become too many: even in time, whatever the drive lasts.
class ThinnedSamples {
 public:
  void add(const sim::DriveSample& sample) {
    last_ = sample;
    if (count_++ % every_ != 0) return;
    // Room for the last one besides.
    if (kept_.size() + 1 >= kMaxVerificationSamples) {
      for (std::size_t i = 0; 2 * i < kept_.size(); ++i) kept_[i] = kept_[2 * i];
      kept_.resize((kept_.size() + 1) / 2);
      every_ *= 2;
      if ((count_ - 1) % every_ != 0) return;
    }
    kept_.push_back(sample);
  }

  std::vector<sim::DriveSample> take() {
    if (!kept_.empty() && kept_.back().time_s < last_.time_s) kept_.push_back(last_);
    return std::move(kept_);
  }

 private:
  std::vector<sim::DriveSample> kept_;
  sim::DriveSample last_;
  std::size_t count_ = 0, every_ = 1;
};

double largest_current_a(const sim::DriveSample& sample) {
  double largest = 0.0;
  for (const sim::WheelState& wheel : sample.wheels) largest = std::max(largest, std::abs(wheel.current_a));
  return largest;
}

double deepest_sinkage_m(const sim::DriveSample& sample) {
  double deepest = 0.0;
  for (const sim::WheelState& wheel : sample.wheels) deepest = std::max(deepest, wheel.sinkage_m);
  return deepest;
}

// The rover's slip averaged back over a while, never over a halt.
class SteadySlip {
 public:
  explicit SteadySlip(double window_s) : window_s_(window_s) {}

  // Nothing until the rover has driven for so long.
  std::optional<double> add(const sim::DriveSample& sample) {
    if (!sample.driving || (!recent_.empty() && recent_.back().leg != sample.leg)) recent_.clear();
    if (!sample.driving) return std::nullopt;
    recent_.push_back({sample.time_s, sample.slip_ratio, sample.leg});
    double sum = 0.0;
    while (recent_.size() > 1 && recent_[1].time_s <= sample.time_s - window_s_) recent_.pop_front();
    if (sample.time_s - recent_.front().time_s < window_s_) return std::nullopt;
    for (const Slip& slip : recent_) sum += slip.ratio;
    return sum / static_cast<double>(recent_.size());
  }

 private:
  struct Slip {
    double time_s, ratio;
    int leg;
  };
  double window_s_;
  std::deque<Slip> recent_;
};

// The three quantities that are compared: slip of the rover, deepest sinkage, largest current.
using Compared = Eigen::Array3d;

// The quasi-static stations of the driven parts, looked up by distance.
class PredictedAlong {
 public:
  explicit PredictedAlong(const sim::DrivePrediction& prediction) {
    for (const sim::StationPrediction& s : prediction.stations) {
      const double distance = s.station.distance_m;
      if (s.station.turning_in_place || !s.state.moving()) continue;
      if (!distance_m_.empty() && distance <= distance_m_.back()) continue;
      distance_m_.push_back(distance);
      values_.emplace_back(s.state.slip_ratio, sim::deepest_sinkage_m(s.state),
                           sim::largest_current_a(s.state));
    }
  }

  // Linear between stations; nothing beyond them.
  std::optional<Compared> at(double distance_m) const {
    const auto after = std::lower_bound(distance_m_.begin(), distance_m_.end(), distance_m);
    if (after == distance_m_.end() || after == distance_m_.begin()) return std::nullopt;
    const auto k = static_cast<std::size_t>(after - distance_m_.begin());
    const double share = (distance_m - distance_m_[k - 1]) / (distance_m_[k] - distance_m_[k - 1]);
    return (1.0 - share) * values_[k - 1] + share * values_[k];
  }

 private:
  std::vector<double> distance_m_;
  std::vector<Compared> values_;
};

// Averages over the way, not over time: a rover that spins on the spot counts once.
class Comparison {
 public:
  Comparison(const sim::DrivePrediction& quasi_static, const std::vector<sim::DriveLeg>& legs)
      : predicted_(quasi_static), legs_(legs) {}

  void add(const sim::DriveSample& sample, std::optional<double> slip_ratio) {
    const double way = sample.progress_m - last_m_;
    last_m_ = std::max(last_m_, sample.progress_m);
    if (!slip_ratio || legs_[static_cast<std::size_t>(sample.leg)].command.turn_in_place || way <= 0.0)
      return;
    const std::optional<Compared> other = predicted_.at(sample.progress_m);
    if (!other) return;
    const Compared here(*slip_ratio, deepest_sinkage_m(sample), largest_current_a(sample));
    const Compared difference = here - *other;
    way_m_ += way;
    sum_ += way * difference;
    sum_abs_ += way * difference.abs();
    for (int q = 0; q < 3; ++q) largest_[q].raise(std::abs(difference[q]), sample.progress_m);
  }

  void finish(DynamicVerification& out) const {
    out.compared_m = way_m_;
    if (way_m_ <= 0.0) return;
    const auto of = [&](int q) {
      return LevelDifference{sum_[q] / way_m_, sum_abs_[q] / way_m_, largest_[q]};
    };
    out.slip_ratio = of(0);
    out.sinkage_m = of(1);
    out.current_a = of(2);
  }

 private:
  PredictedAlong predicted_;
  const std::vector<sim::DriveLeg>& legs_;
  double last_m_ = 0.0, way_m_ = 0.0;
  Compared sum_ = Compared::Zero(), sum_abs_ = Compared::Zero();
  std::array<sim::Peak, 3> largest_;
};

// How far the rover is from the line of its route.
class RouteLine {
 public:
  explicit RouteLine(const std::vector<Motion>& motions) : line_(centreline(motions, kLineSpacing_m)) {}

  double distance_m(const Eigen::Vector2d& place) const {
    double least = (place - line_.front()).norm();
    for (std::size_t i = 1; i < line_.size(); ++i)
      least = std::min(least, distance_to_segment_m(place, line_[i - 1], line_[i]));
    return least;
  }

 private:
  static constexpr double kLineSpacing_m = 0.25;
  std::vector<Eigen::Vector2d> line_;
};

// Ends the simulation too where the rover has left its route.
class UntilOffRoute final : public Progress {
 public:
  explicit UntilOffRoute(Progress& progress) : progress_(progress) {}
  void report(std::string_view stage, double fraction) override { progress_.report(stage, fraction); }
  bool cancelled() const override { return left_ || progress_.cancelled(); }
  void leave() { left_ = true; }
  bool left() const { return left_; }

 private:
  Progress& progress_;
  bool left_ = false;
};

// Figures of a drive as its samples come.
class Watch {
 public:
  Watch(const PlanProblem& problem, const std::vector<Motion>& motions,
        const std::vector<sim::DriveLeg>& legs, const sim::DrivePrediction& quasi_static,
        UntilOffRoute& progress, DynamicVerification& out)
      : line_(motions),
        max_off_route_m_(max_off_route_m(*problem.rover)),
        comparison_(quasi_static, legs),
        steady_(sim::max_station_spacing_m(*problem.rover) / problem.rover->cruise_speed_m_s),
        progress_(progress),
        out_(out) {}

  void operator()(const sim::DriveSample& sample) {
    if (progress_.left()) return;
    samples_.add(sample);
    const std::optional<double> slip_ratio = steady_.add(sample);
    const double at_m = std::max(0.0, sample.progress_m);  // slid back: no place on the way
    const Eigen::Vector2d place = sample.p_MB.head<2>();
    const double off_m = line_.distance_m(place);
    if (off_m > out_.max_distance_from_route.distance_m)
      out_.max_distance_from_route = {off_m, at_m, place.x(), place.y()};
    if (off_m > max_off_route_m_) {
      leave(sample);
      return;
    }
    if (slip_ratio) out_.extremes.max_slip_ratio.raise(std::abs(*slip_ratio), at_m);
    out_.extremes.max_tilt_rad.raise(sample.attitude.tilt_rad(), at_m);
    out_.extremes.max_current_a.raise(largest_current_a(sample), at_m);
    out_.extremes.max_sinkage_m.raise(deepest_sinkage_m(sample), at_m);
    comparison_.add(sample, slip_ratio);
  }

  void finish() {
    out_.samples = samples_.take();
    comparison_.finish(out_);
  }

 private:
  void leave(const sim::DriveSample& sample) {
    progress_.leave();
    out_.left_the_route = true;
    const OffRoute& off = out_.max_distance_from_route;
    out_.reason = fmt::format(
        "the drive is {:.2f} m off its route at ({:.2f}, {:.2f}) after {:.1f} m, where {:.2f} m are the "
        "most: "
        "slip {:.2f}, tilt {:.1f} deg",
        off.distance_m, off.x_m, off.y_m, off.at_m, max_off_route_m_, sample.slip_ratio,
        deg_from_rad(sample.attitude.tilt_rad()));
  }

  RouteLine line_;
  double max_off_route_m_;
  ThinnedSamples samples_;
  Comparison comparison_;
  SteadySlip steady_;
  UntilOffRoute& progress_;
  DynamicVerification& out_;
};

// What is known of a drive that the simulation gave up on.
void end_without_answer(const Error& error, const Pose2& start, DynamicVerification& out) {
  if (!out.left_the_route) {
    out.reason = error.detail;
    for (const Fault& fault : error.faults) out.reason += fmt::format(" ({})", fault.message);
  }
  out.pose = start;
  if (out.samples.empty()) return;
  const sim::DriveSample& last = out.samples.back();
  out.distance_m = std::max(0.0, last.progress_m);
  out.pose = {last.p_MB.x(), last.p_MB.y(), wrapped_rad(last.attitude.yaw_rad)};
  out.duration_s = last.time_s;
}

void take_drive(sim::DynamicDrive drive, DynamicVerification& out) {
  out.end = drive.end;
  out.reason = std::move(drive.reason);
  out.distance_m = std::max(0.0, out.samples.empty() ? drive.progress_m : out.samples.back().progress_m);
  out.pose = {drive.final.x_m, drive.final.y_m, wrapped_rad(drive.final.yaw_rad)};
  out.duration_s = drive.duration_s;
  out.energy_j = drive.energy_j;
  out.events = std::move(drive.events);
  out.work = drive.work;
}

}  // namespace

std::string_view end_in_words(const DynamicVerification& verification) {
  if (verification.left_the_route) return "left_the_route";
  return verification.end ? sim::describe(*verification.end) : "no_answer";
}

double max_off_route_m(const sim::RoverModel& rover) {
  return 0.5 * rover.body_width_m + kMaxBesideBody_m;
}

Result<DynamicVerification> verify_route(const PlanProblem& problem, const std::vector<Motion>& motions,
                                         const Manner& manner, const sim::DrivePrediction& quasi_static,
                                         Progress& progress) {
  const std::vector<sim::DriveLeg> legs = drive_legs(motions, *problem.rover, manner);
  const Pose2 start = drive_start(motions, manner);
  DynamicVerification out;
  for (const sim::WheelModel& wheel : problem.rover->wheels) out.wheel_names.push_back(wheel.name);
  if (legs.empty()) {  // it is there already
    out.end = sim::DriveEnd::kFinished;
    out.pose = start;
    out.energy_j = 0.0;
    return out;
  }
  UntilOffRoute until(progress);
  Watch watch(problem, motions, legs, quasi_static, until, out);
  const auto drive = sim::simulate_drive(
      *problem.rover, problem.gravity_m_s2, TerrainGround(problem.terrain, problem.soil_map),
      sim::mean_soils(problem.beliefs), start, legs,
      {.feedback = sim::Feedback::kPose, .motor_temp_c = problem.conditions.motor_temp_c},
      [&](const sim::DriveSample& sample) { watch(sample); }, until);
  if (progress.cancelled() || (!drive && drive.error().code == ErrorCode::kCancelled && !until.left()))
    return fail(ErrorCode::kCancelled, "the verification was dismissed");
  watch.finish();
  for (const sim::DriveLeg& leg : legs) out.commanded_m += leg.command.turn_in_place ? 0.0 : leg.length_m;
  out.broken_limits = broken_limits(out.extremes, problem.limits);
  if (drive && !until.left()) {
    take_drive(*drive, out);
  } else {
    end_without_answer(drive ? Error{} : drive.error(), start, out);
  }
  return out;
}

}  // namespace slipway::planner
