#include "sim/prediction/drive_prediction.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/angle.h"
#include "core/parallel_for.h"
#include "core/random.h"
#include "sim/prediction/closure_reach.h"
#include "sim/prediction/conditioned_draw.h"
#include "sim/prediction/drawn_drive.h"
#include "sim/prediction/drawn_statistics.h"
#include "sim/prediction/drive_risk.h"
#include "sim/prediction/telemetry.h"

namespace slipway::sim {
namespace {

constexpr std::size_t kMaxFaults = 20;

DriveCommand command_at(const RoverModel& rover, const PathStation& station,
                        const DriveConditions& conditions) {
  DriveCommand command;
  command.turn_in_place = station.turning_in_place;
  command.turn_rate_rad_s = std::copysign(rover.turn_rate_rad_s, station.turned_rad);
  command.speed_m_s = station.backwards ? -rover.cruise_speed_m_s : rover.cruise_speed_m_s;
  command.curvature_1_m = station.curvature_1_m;
  command.crab_rad = station.crab_rad;
  command.motor_temp_c = conditions.motor_temp_c;
  return command;
}

// A wheel that has no ground under it when the rover is level at this pose.
std::optional<std::string> wheel_without_ground(const RoverModel& rover, const Ground& ground,
                                                const Pose2& pose) {
  const double c = std::cos(pose.yaw_rad), s = std::sin(pose.yaw_rad);
  for (const WheelModel& wheel : rover.wheels) {
    const double x = pose.x_m + c * wheel.position_m.x() - s * wheel.position_m.y();
    const double y = pose.y_m + s * wheel.position_m.x() + c * wheel.position_m.y();
    if (!ground.at(x, y)) return wheel.name;
  }
  return std::nullopt;
}

std::string reason_text(const RoverModel& rover, const SoilBeliefs& beliefs, const StationPrediction& at) {
  const StationState& state = at.state;
  const std::string_view soil =
      at.on_unknown_ground ? std::string_view("unknown ground") : std::string_view(beliefs.of(at.soil).name);
  std::string text =
      fmt::format("{} at {:.1f} m on {}: tilt {:.1f} deg (pitch {:.1f}, roll {:.1f})",
                  describe(state.outcome), at.station.distance_m, soil, deg_from_rad(at.attitude.tilt_rad()),
                  deg_from_rad(at.attitude.pitch_rad), deg_from_rad(at.attitude.roll_rad));
  if (state.by_slip_curve) {
    text += fmt::format(", slip {:.2f} (the soil is known by its slip curve alone)", state.slip_ratio);
  } else if (state.wheel >= 0) {
    const WheelState& wheel = state.wheels[state.wheel];
    text += fmt::format(", wheel {}: slip {:.2f}, sinkage {:.3f} m, {:.2f} A", rover.wheels[state.wheel].name,
                        wheel.slip_ratio, wheel.sinkage_m, wheel.current_a);
  } else {
    text += fmt::format(", slip {:.2f}, deepest wheel {:.3f} m", state.slip_ratio, deepest_sinkage_m(state));
  }
  return text;
}

class Predictor {
 public:
  Predictor(const RoverModel& rover, double gravity_m_s2, const Ground& ground, const SoilBeliefs& beliefs,
            const DriveLimits& limits, const DriveConditions& conditions)
      : rover_(rover),
        ground_(ground),
        beliefs_(beliefs),
        limits_(limits),
        conditions_(conditions),
        solver_(rover, gravity_m_s2) {
    for (const WheelModel& wheel : rover.wheels) prediction_.wheel_names.push_back(wheel.name);
    prepared_.ground = &ground;
  }

  // Without the stations of the prediction on the mean soils: for what is asked of the draws alone.
  void draws_alone() { draws_alone_ = true; }

  // Returns false where the rover has no stance, so that no draw of the soil takes it further. Where the mean
  // soils immobilise it, the prediction on them ends, while draws of better soils drive on.
  bool add(const PathStation& station) {
    const std::optional<Stance> stance = settle(rover_, ground_, station.pose);
    if (!stance) return no_stance(station);
    PreparedStation ready;
    ready.stance = *stance;
    ready.command = command_at(rover_, station, conditions_);
    ready.pose = station.pose;
    ready.distance_m = station.distance_m;
    if (!prepared_.stations.empty())
      ready.drive_m = station.distance_m - prepared_.stations.back().distance_m;
    ready.turn_rad = std::abs(station.turned_rad);
    if (station.turning_in_place && station.turned_rad == 0.0) ready.command.turn_in_place = false;
    StationPrediction predicted = stand(station, ready);
    if (!prediction_.immobilised) {
      predicted.state = drive_on_means(ready);
      predict(ready, predicted);
      if (!draws_alone_) prediction_.stations.push_back(predicted);
    }
    prepared_.stations.push_back(std::move(ready));
    return true;
  }

  const PreparedDrive& prepared() const { return prepared_; }

  DrivePrediction finish() {
    DrivePrediction& p = prediction_;
    p.mean_slip_ratio = p.length_m > 0.0 ? slip_length_ / p.length_m : p.max_slip_ratio.value;
    p.mean_slip_ratio_p05 = p.mean_slip_ratio_p50 = p.mean_slip_ratio_p95 = p.mean_slip_ratio;
    p.broken_limits = broken_limits(
        {p.max_slip_ratio, p.max_tilt_rad, p.max_current_a, p.max_sinkage_m, least_clearance_}, limits_);
    return std::move(prediction_);
  }

 private:
  // Every wheel has ground under it (predict_drive checked this), but the suspension cannot follow its shape.
  bool no_stance(const PathStation& station) {
    prepared_.without_stance = true;
    prediction_.without_stance = {
        station.distance_m, station.pose,
        fmt::format("no stance at {:.1f} m: the ground is too uneven for the suspension",
                    station.distance_m)};
    if (!prediction_.immobilised) prediction_.immobilised = prediction_.without_stance;
    return false;
  }

  StationPrediction stand(const PathStation& station, PreparedStation& ready) const {
    StationPrediction predicted;
    predicted.station = station;
    predicted.height_m = ready.stance.p_MB.z();
    predicted.attitude = ready.stance.attitude;
    predicted.clearance_m = ready.stance.belly_clearance_m;
    predicted.soil = ground_.soil_at(station.pose.x_m, station.pose.y_m);
    ready.soil = PerWheel<std::optional<std::size_t>>(rover_.wheels.size());
    for (std::size_t k = 0; k < ready.soil.size(); ++k) {
      const Eigen::Vector3d p_M = ready.stance.p_MB + ready.stance.R_MB * ready.stance.p_B_wheel[k];
      ready.soil[k] = ground_.soil_at(p_M.x(), p_M.y());
      if (!ready.soil[k]) predicted.on_unknown_ground = true;
    }
    return predicted;
  }

  StationState drive_on_means(PreparedStation& ready) {
    PerWheel<Soil> soils(ready.soil.size());
    for (std::size_t k = 0; k < soils.size(); ++k) soils[k] = beliefs_.of(ready.soil[k]).mean;
    StationState state = solver_.solve(ready.stance, soils, ready.command);
    if (!state.by_slip_curve) ready.on_means = solver_.unknowns_of_last();
    return state;
  }

  void predict(const PreparedStation& ready, StationPrediction& predicted) {
    const StationState& state = predicted.state;
    predicted.attitude = state.attitude;
    const double s = ready.distance_m;
    DrivePrediction& p = prediction_;
    p.by_slip_curve |= state.by_slip_curve;
    p.max_tilt_rad.raise(state.attitude.tilt_rad(), s);
    p.max_slip_ratio.raise(std::abs(state.slip_ratio), s);
    p.max_current_a.raise(largest_current_a(state), s);
    p.max_sinkage_m.raise(deepest_sinkage_m(state), s);
    if (ready.stance.belly_clearance_m < least_clearance_.value)
      least_clearance_ = {ready.stance.belly_clearance_m, s};
    predicted.slip_ratio_p05 = predicted.slip_ratio_p50 = predicted.slip_ratio_p95 = state.slip_ratio;
    predicted.current_a_p95 = largest_current_a(state);
    predicted.sinkage_m_p95 = deepest_sinkage_m(state);
    predicted.tilt_rad_p05 = predicted.tilt_rad_p95 = state.attitude.tilt_rad();
    predicted.clearance_m_p05 = predicted.clearance_m_p95 = predicted.clearance_m;
    if (!state.moving()) {
      predicted.elapsed_s = p.duration_s;
      p.immobilised = {s, predicted.station.pose, reason_text(rover_, beliefs_, predicted)};
      return;
    }
    const Effort effort = effort_of(ready, state);
    p.duration_s += effort.duration_s;
    p.energy_j += effort.energy_j;
    p.length_m += ready.drive_m;
    p.turned_rad += ready.command.turn_in_place ? ready.turn_rad : 0.0;
    slip_length_ += std::abs(state.slip_ratio) * ready.drive_m;
    if (predicted.on_unknown_ground) p.unknown_length_m += ready.drive_m;
    if (state.by_slip_curve) p.slip_curve_length_m += ready.drive_m;
    predicted.elapsed_s = p.duration_s;
  }

  const RoverModel& rover_;
  const Ground& ground_;
  const SoilBeliefs& beliefs_;
  const DriveLimits& limits_;
  const DriveConditions& conditions_;
  QuasiStaticSolver solver_;
  DrivePrediction prediction_;
  PreparedDrive prepared_;
  Peak least_clearance_{1e9, 0.0};
  double slip_length_ = 0.0;
  bool draws_alone_ = false;
};

// The whole path is checked first, since missing ground is a fault even behind a place of immobilisation.
std::optional<Error> ground_faults(const RoverModel& rover, const Ground& ground,
                                   std::span<const PathStation> path, const Progress& progress) {
  std::vector<Fault> faults;
  for (std::size_t k = 0; k < path.size() && faults.size() < kMaxFaults; ++k) {
    if (progress.cancelled()) return Error{ErrorCode::kCancelled, "the prediction was dismissed", {}};
    if (const auto wheel = wheel_without_ground(rover, ground, path[k].pose))
      faults.push_back(
          {fmt::format("/stations/{}", k),
           fmt::format("no elevation under wheel {} at ({:.2f}, {:.2f}), {:.1f} m along the path", *wheel,
                       path[k].pose.x_m, path[k].pose.y_m, path[k].distance_m)});
  }
  if (faults.empty()) return std::nullopt;
  return Error{ErrorCode::kNoData, "the path leaves the ground that is known", std::move(faults)};
}

// For the draws alone, without a prediction on the mean soils.
Result<PreparedDrive> prepare(const RoverModel& rover, double gravity_m_s2, const Ground& ground,
                              const SoilBeliefs& beliefs, std::span<const PathStation> path,
                              const DriveLimits& limits, const Progress& progress,
                              const DriveConditions& conditions) {
  if (path.empty()) throw std::invalid_argument("a path needs a station");
  if (auto error = ground_faults(rover, ground, path, progress)) return fail(std::move(*error));
  Predictor predictor(rover, gravity_m_s2, ground, beliefs, limits, conditions);
  predictor.draws_alone();
  for (const PathStation& station : path)
    if (!predictor.add(station)) break;
  return predictor.prepared();
}

}  // namespace

bool OutcomeBars::are_kept(const SegmentRisk& segment) const {
  return segment.embedding.high < max_embedding && segment.expected_stops_high < max_expected_stops;
}

bool OutcomeBars::are_passed(const SegmentRisk& segment) const {
  return segment.embedding.low > max_embedding || segment.expected_stops_low > max_expected_stops;
}

bool OutcomeBars::are_kept(const DriveOutcomes& outcomes) const {
  if (!outcomes.segments.empty())
    return std::all_of(outcomes.segments.begin(), outcomes.segments.end(),
                       [this](const SegmentRisk& segment) { return are_kept(segment); });
  return outcomes.embedding.high < max_embedding && outcomes.expected_stops_high < max_expected_stops;
}

bool OutcomeBars::are_passed(const DriveOutcomes& outcomes) const {
  if (!outcomes.segments.empty())
    return std::any_of(outcomes.segments.begin(), outcomes.segments.end(),
                       [this](const SegmentRisk& segment) { return are_passed(segment); });
  return outcomes.embedding.low > max_embedding || outcomes.expected_stops_low > max_expected_stops;
}

double max_station_spacing_m(const RoverModel& rover) {
  return 2.0 * rover.smallest_wheel_radius_m();
}

Result<DrivePrediction> predict_drive(const RoverModel& rover, double gravity_m_s2, const Ground& ground,
                                      const SoilBeliefs& beliefs, std::span<const PathStation> path,
                                      const DriveLimits& limits, const RiskOptions& risk, std::size_t threads,
                                      Progress& progress, const DriveConditions& conditions,
                                      DrawsSoFar* so_far) {
  if (path.empty()) throw std::invalid_argument("predict_drive: a path needs a station");
  if (auto error = ground_faults(rover, ground, path, progress)) return fail(std::move(*error));
  Predictor predictor(rover, gravity_m_s2, ground, beliefs, limits, conditions);
  for (std::size_t k = 0; k < path.size(); ++k) {
    if (k % 64 == 0 && progress.cancelled())
      return fail(ErrorCode::kCancelled, "the prediction was dismissed");
    if (!predictor.add(path[k])) break;
  }
  DrivePrediction prediction = predictor.finish();
  if (risk.draws > 0 && !assess_risk(rover, gravity_m_s2, beliefs, predictor.prepared(), limits, risk,
                                     threads, progress, prediction, so_far))
    return fail(ErrorCode::kCancelled, "the prediction was dismissed");
  if (risk.draws > 0)
    prediction.closures = closure_reach(rover, gravity_m_s2, beliefs, predictor.prepared(), limits, threads);
  return prediction;
}

Result<std::vector<DrawnOutcome>> drawn_outcomes(const RoverModel& rover, double gravity_m_s2,
                                                 const Ground& ground, const SoilBeliefs& beliefs,
                                                 std::span<const PathStation> path, const DriveLimits& limits,
                                                 const RiskOptions& risk, std::size_t threads,
                                                 Progress& progress, const DriveConditions& conditions) {
  const auto drive = prepare(rover, gravity_m_s2, ground, beliefs, path, limits, progress, conditions);
  if (!drive) return fail(drive.error());
  auto outcomes = outcomes_of_draws(rover, gravity_m_s2, beliefs, *drive, limits, risk, threads, progress);
  if (progress.cancelled()) return fail(ErrorCode::kCancelled, "the prediction was dismissed");
  return outcomes;
}

Result<void> condition_draws(const RoverModel& rover, double gravity_m_s2, const Ground& ground,
                             const SoilBeliefs& beliefs, std::span<const PathStation> path,
                             const DriveLimits& limits, const RiskOptions& risk,
                             const PastDriveReport& report, std::size_t threads, Progress& progress,
                             std::vector<ConditionedDraw>& draws, const DriveConditions& conditions) {
  const auto drive = prepare(rover, gravity_m_s2, ground, beliefs, path, limits, progress, conditions);
  if (!drive) return fail(drive.error());
  const DrawnDriver driver(rover, gravity_m_s2, beliefs, *drive, limits, risk.checks);
  parallel_for(draws.size(), threads, [&](std::size_t d) {
    condition(driver, random_key(risk.seed, draws[d].number.value_or(d)), report, progress, draws[d]);
  });
  if (progress.cancelled()) return fail(ErrorCode::kCancelled, "the prediction was dismissed");
  return {};
}

Result<StretchForecast> condition_on_stretch(const RoverModel& rover, double gravity_m_s2,
                                             const Ground& ground, const SoilBeliefs& beliefs,
                                             std::span<const PathStation> path,
                                             const MeasuredStretch& measured, const TelemetryErrors& errors,
                                             const RiskOptions& risk, int tries, std::size_t threads,
                                             Progress& progress, std::vector<ConditionedDraw>& draws,
                                             const DriveConditions& conditions) {
  const auto drive = prepare(rover, gravity_m_s2, ground, beliefs, path, {}, progress, conditions);
  if (!drive) return fail(drive.error());
  StretchForecast forecast;
  if (drive->stations.empty()) return forecast;  // no stance: nothing of the soil is learnt there
  const StretchDriver driver(rover, gravity_m_s2, beliefs, *drive);
  std::vector<std::pair<double, double>> slips(draws.size());
  parallel_for(draws.size(), threads, [&](std::size_t d) {
    slips[d].second = draws[d].weight;
    slips[d].first = condition(driver, random_key(risk.seed, draws[d].number.value_or(d)), measured, errors,
                               tries, progress, draws[d]);
  });
  if (progress.cancelled()) return fail(ErrorCode::kCancelled, "the prediction was dismissed");
  forecast.slip_ratio = spread_of(slips);
  double sum = 0.0, squares = 0.0;
  for (const ConditionedDraw& draw : draws) {
    sum += draw.weight;
    squares += draw.weight * draw.weight;
  }
  forecast.effective_draws = sum * sum / squares;
  return forecast;
}

}  // namespace slipway::sim
