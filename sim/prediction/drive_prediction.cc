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
#include "sim/prediction/drive_outcome.h"
#include "sim/prediction/drive_risk.h"
#include "sim/prediction/path_refinement.h"
#include "sim/prediction/telemetry.h"

namespace slipway::sim {
namespace {

// The share by which peaks must be exceeded: of places that are alike but for their last bits the first is
// told, however the draws were dealt into packs.
constexpr double kAlike = 1e-9;

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
            const DriveLimits& limits, const RiskOptions& risk, const DriveConditions& conditions)
      : rover_(rover),
        ground_(ground),
        beliefs_(beliefs),
        limits_(limits),
        conditions_(conditions),
        solver_(rover, gravity_m_s2),
        rules_(rover, limits),
        follower_(rover, limits, risk.checks, risk.segment_m) {
    for (const WheelModel& wheel : rover.wheels) prediction_.wheel_names.push_back(wheel.name);
    prepared_.ground = &ground;
  }

  // Without the stations of the prediction on the mean soils: for what is asked of the draws alone.
  void draws_alone() { draws_alone_ = true; }

  // Adds the station, and others on the way to it where a limit may be broken between the two. Returns false
  // where the rover has no stance, so that no draw of the soil takes it further. Where the mean soils
  // immobilise it, the prediction on them ends, while draws of better soils drive on.
  bool add(const PathStation& station, int halvings = 0) {
    std::optional<Balanced> next = balance(station);
    if (!next) return no_stance(station);
    if (last_ && !draws_alone_ && halvings < kMaxHalvings &&
        may_pass_a_limit(rules_, *last_, *next, halvings)) {
      const auto [halfway, rest] = halved(last_->path, station);
      if (wheel_without_ground(rover_, ground_, halfway.pose)) return take(std::move(*next));
      return add(halfway, halvings + 1) && add(rest, halvings + 1);
    }
    return take(std::move(*next));
  }

  const PreparedDrive& prepared() const { return prepared_; }

  DrivePrediction finish() {
    DrivePrediction& p = prediction_;
    p.mean_slip_ratio = p.length_m > 0.0 ? slip_length_ / p.length_m : p.max_slip_ratio.value;
    p.mean_slip_ratio_p05 = p.mean_slip_ratio_p50 = p.mean_slip_ratio_p95 = p.mean_slip_ratio;
    find_broken_limits();
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

  std::optional<Balanced> balance(const PathStation& station) {
    std::optional<Stance> stance = settle(rover_, ground_, station.pose);
    if (!stance) return std::nullopt;
    Balanced next{.path = station, .ready = {}, .state = {}};
    PreparedStation& ready = next.ready;
    ready.stance = *std::move(stance);
    ready.command = command_at(rover_, station, conditions_);
    ready.pose = station.pose;
    ready.distance_m = station.distance_m;
    if (!prepared_.stations.empty())
      ready.drive_m = station.distance_m - prepared_.stations.back().distance_m;
    ready.turn_rad = std::abs(station.turned_rad);
    if (station.turning_in_place && station.turned_rad == 0.0) ready.command.turn_in_place = false;
    ready.soil = PerWheel<std::optional<std::size_t>>(rover_.wheels.size());
    for (std::size_t k = 0; k < ready.soil.size(); ++k) {
      const Eigen::Vector3d p_M = ready.stance.p_MB + ready.stance.R_MB * ready.stance.p_B_wheel[k];
      ready.soil[k] = ground_.soil_at(p_M.x(), p_M.y());
    }
    if (!prediction_.immobilised) next.state = drive_on_means(next);
    return next;
  }

  bool take(Balanced next) {
    if (!prediction_.immobilised) {
      StationPrediction predicted = stand(next);
      predict(next.ready, predicted);
      if (!draws_alone_) prediction_.stations.push_back(std::move(predicted));
    }
    prepared_.stations.push_back(next.ready);
    last_ = std::move(next);
    return true;
  }

  StationPrediction stand(const Balanced& at) const {
    StationPrediction predicted;
    predicted.station = at.path;
    predicted.height_m = at.ready.stance.p_MB.z();
    predicted.attitude = at.state.attitude;
    predicted.clearance_m = at.ready.stance.belly_clearance_m;
    predicted.soil = ground_.soil_at(at.path.pose.x_m, at.path.pose.y_m);
    for (std::size_t k = 0; k < at.ready.soil.size(); ++k)
      if (!at.ready.soil[k]) predicted.on_unknown_ground = true;
    predicted.state = at.state;
    return predicted;
  }

  // Where the solver gives up, the drive is taken to go on as it came.
  StationState drive_on_means(Balanced& next) {
    PreparedStation& ready = next.ready;
    PerWheel<Soil> soils(ready.soil.size());
    for (std::size_t k = 0; k < soils.size(); ++k) soils[k] = beliefs_.of(ready.soil[k]).mean;
    StationState state = solver_.solve(ready.stance, soils, ready.command);
    if (state.outcome == Outcome::kNotConverged) {
      solver_.reset();
      state = solver_.solve(ready.stance, soils, ready.command);
    }
    if (state.outcome != Outcome::kNotConverged) {
      if (!state.by_slip_curve) ready.on_means = solver_.unknowns_of_last();
      return state;
    }
    if (!prediction_.unsolved)
      prediction_.unsolved = {ready.distance_m, ready.pose,
                              fmt::format("the solver found no balance at {:.1f} m, which says nothing of "
                                          "the ground",
                                          ready.distance_m)};
    return last_ && last_->state.moving() ? last_->state : undisturbed(rover_, ready.stance, ready.command);
  }

  void predict(const PreparedStation& ready, StationPrediction& predicted) {
    const StationState& state = predicted.state;
    const double s = ready.distance_m;
    DrivePrediction& p = prediction_;
    p.by_slip_curve |= state.by_slip_curve;
    p.max_tilt_rad.raise(state.attitude.tilt_rad(), s, kAlike);
    if (!ready.command.turn_in_place) p.max_slip_ratio.raise(std::abs(state.slip_ratio), s, kAlike);
    p.max_current_a.raise(largest_current_a(state), s, kAlike);
    p.max_sinkage_m.raise(deepest_sinkage_m(state), s, kAlike);
    if (!embedded_) embedded_ = !follower_.add(ready, prepared_.stations.size(), state);
    predicted.aside_m = predicted.aside_m_p05 = predicted.aside_m_p95 = follower_.aside_m();
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

  // The slip limit holds at each station by itself, the others as along a draw. Where the ground holds the
  // rover, that is the fault, and not the slip of 1 there.
  void find_broken_limits() {
    DrivePrediction& p = prediction_;
    const DriveOutcome& outcome = follower_.finish();
    for (const RuleRow& row : rule_catalogue()) {
      const RuleTrace& trace = outcome.of(row.rule);
      if (row.rule == Rule::kSlipCheck) {
        if (p.max_slip_ratio.value >= limits_.max_slip_ratio && !p.immobilised)
          p.broken_limits.push_back(
              {row.rule, p.max_slip_ratio.value, limits_.max_slip_ratio, p.max_slip_ratio.distance_m, -1});
      } else if (trace.tripped && (row.limit || row.rule == Rule::kEmbedding)) {
        const double limit = row.limit ? limits_.*row.limit : trace.value;
        p.broken_limits.push_back(
            {row.rule, trace.value, limit, prepared_.stations[trace.station].distance_m, trace.wheel});
      }
    }
  }

  const RoverModel& rover_;
  const Ground& ground_;
  const SoilBeliefs& beliefs_;
  const DriveLimits& limits_;
  const DriveConditions& conditions_;
  QuasiStaticSolver solver_;
  StationRules rules_;
  OutcomeFollower follower_;  // on the mean soils
  DrivePrediction prediction_;
  PreparedDrive prepared_;
  std::optional<Balanced> last_;
  double slip_length_ = 0.0;
  bool embedded_ = false, draws_alone_ = false;
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
                              const DriveLimits& limits, const RiskOptions& risk, const Progress& progress,
                              const DriveConditions& conditions) {
  if (path.empty()) throw std::invalid_argument("a path needs a station");
  if (auto error = ground_faults(rover, ground, path, progress)) return fail(std::move(*error));
  Predictor predictor(rover, gravity_m_s2, ground, beliefs, limits, risk, conditions);
  predictor.draws_alone();
  for (const PathStation& station : path)
    if (!predictor.add(station)) break;
  return predictor.prepared();
}

}  // namespace

bool OutcomeBars::are_kept(const OutcomeShares& shares) const {
  return shares.stop.high < max_stop && shares.immobilised.high < max_immobilised &&
         shares.embedding.high < max_embedding;
}

bool OutcomeBars::are_passed(const OutcomeShares& shares) const {
  return shares.stop.low > no_go_stop || shares.immobilised.low > max_immobilised ||
         shares.embedding.low > max_embedding;
}

bool OutcomeBars::are_kept(const DriveOutcomes& outcomes) const {
  if (outcomes.segments.empty()) return are_kept(static_cast<const OutcomeShares&>(outcomes));
  return std::all_of(outcomes.segments.begin(), outcomes.segments.end(),
                     [this](const OutcomeShares& segment) { return are_kept(segment); });
}

bool OutcomeBars::are_passed(const DriveOutcomes& outcomes) const {
  if (outcomes.segments.empty()) return are_passed(static_cast<const OutcomeShares&>(outcomes));
  return std::any_of(outcomes.segments.begin(), outcomes.segments.end(),
                     [this](const OutcomeShares& segment) { return are_passed(segment); });
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
  Predictor predictor(rover, gravity_m_s2, ground, beliefs, limits, risk, conditions);
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
    prediction.closures =
        closure_reach(rover, gravity_m_s2, beliefs, predictor.prepared(), limits, threads, progress);
  if (progress.cancelled()) return fail(ErrorCode::kCancelled, "the prediction was dismissed");
  return prediction;
}

Result<std::vector<DrawnOutcome>> drawn_outcomes(const RoverModel& rover, double gravity_m_s2,
                                                 const Ground& ground, const SoilBeliefs& beliefs,
                                                 std::span<const PathStation> path, const DriveLimits& limits,
                                                 const RiskOptions& risk, std::size_t threads,
                                                 Progress& progress, const DriveConditions& conditions) {
  const auto drive = prepare(rover, gravity_m_s2, ground, beliefs, path, limits, risk, progress, conditions);
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
  const auto drive = prepare(rover, gravity_m_s2, ground, beliefs, path, limits, risk, progress, conditions);
  if (!drive) return fail(drive.error());
  RiskOptions on_the_map = risk;
  on_the_map.relief = nullptr;
  const DrawnDriver driver(rover, gravity_m_s2, beliefs, *drive, limits, on_the_map);
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
  const auto drive = prepare(rover, gravity_m_s2, ground, beliefs, path, {}, risk, progress, conditions);
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
  forecast.effective_draws = effective_draws(draws);
  return forecast;
}

}  // namespace slipway::sim
