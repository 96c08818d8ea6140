#include "sim/prediction/drive_risk.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "core/normal_interval.h"
#include "core/parallel_for.h"
#include "core/random.h"
#include "sim/prediction/drawn_ground.h"
#include "sim/prediction/drive_outcome.h"

namespace slipway::sim {
namespace {

// Quantiles along the way are of the first draws where all of them at all stations would not fit in memory.
constexpr std::size_t kMaxStates = 4'000'000;
constexpr int kMinProfileDraws = 24;

// The results of one draw along a drive.
struct DrawnDrive {
  double weight = 1.0;
  std::vector<float> slip, current_a, sinkage_m;  // per station that was reached, where they are kept
  std::vector<bool> bad;  // per station: a limit is broken or the rover is immobilised
  bool any_bad = false;
  bool immobilised = false;
  double duration_s = 0.0, energy_j = 0.0;
  DriveOutcome outcome;
};

class LevelGround final : public Ground {
 public:
  std::optional<GroundPoint> at(double /*x_m*/, double /*y_m*/) const override { return GroundPoint{}; }
  std::optional<std::size_t> soil_at(double /*x_m*/, double /*y_m*/) const override { return std::nullopt; }
};

class DrawnDriver {
 public:
  DrawnDriver(const RoverModel& rover, double gravity_m_s2, const SoilBeliefs& beliefs,
              const PreparedDrive& drive, const DriveLimits& limits, const SlipChecks& checks)
      : rover_(rover),
        gravity_m_s2_(gravity_m_s2),
        beliefs_(beliefs),
        drive_(drive),
        limits_(limits),
        checks_(checks),
        level_(settle(rover, LevelGround(), {})) {}

  DrawnDrive run(std::uint64_t key, bool keep_states, const Progress& progress) const {
    DrawnDrive drawn;
    DrawnGround ground(beliefs_, key, [this](const Soil& soil) { return drives_level(soil); });
    QuasiStaticSolver solver(rover_, gravity_m_s2_, Precision::kDraws);
    OutcomeFollower follower(rover_, limits_, checks_);
    PerWheel<Soil> under(rover_.wheels.size());
    bool embedded = false;
    for (std::size_t s = 0; s < drive_.stations.size() && !(embedded && drawn.immobilised); ++s) {
      if (progress.cancelled()) break;
      const PreparedStation& station = drive_.stations[s];
      for (std::size_t k = 0; k < under.size(); ++k)
        under[k] = ground.at(station.soil[k], station.pose.x_m, station.pose.y_m);
      const StationState state = solver.solve(station.stance, under, station.command);
      if (!embedded) embedded = !follower.add(station, s, state);
      if (!drawn.immobilised) add(station, state, keep_states, drawn);
    }
    drawn.outcome = follower.finish();
    if (drive_.without_stance) {
      // The wheels meet ground that the suspension cannot follow: no draw of the soil passes there.
      drawn.any_bad = drawn.immobilised = true;
      drawn.outcome.embedded = true;
      drawn.outcome.rules[static_cast<std::size_t>(Rule::kEmbedding)].tripped = true;
    }
    return drawn;
  }

 private:
  bool drives_level(const Soil& soil) const {
    if (!level_) return true;
    QuasiStaticSolver solver(rover_, gravity_m_s2_, Precision::kDraws);
    return solver.solve(*level_, soil, {.speed_m_s = rover_.cruise_speed_m_s}).moving();
  }

  void add(const PreparedStation& station, const StationState& state, bool keep_states,
           DrawnDrive& drawn) const {
    const bool bad = !state.moving() || breaks(limits_, state) || breaks(limits_, station.stance);
    drawn.any_bad |= bad;
    drawn.bad.push_back(bad);
    if (keep_states) {
      drawn.slip.push_back(static_cast<float>(state.slip_ratio));
      drawn.current_a.push_back(static_cast<float>(largest_current_a(state)));
      drawn.sinkage_m.push_back(static_cast<float>(deepest_sinkage_m(state)));
    }
    if (!state.moving()) {
      drawn.immobilised = true;
      return;
    }
    const Effort effort = effort_of(station, state);
    drawn.duration_s += effort.duration_s;
    drawn.energy_j += effort.energy_j;
  }

  const RoverModel& rover_;
  double gravity_m_s2_;
  const SoilBeliefs& beliefs_;
  const PreparedDrive& drive_;
  const DriveLimits& limits_;
  const SlipChecks& checks_;
  std::optional<Stance> level_;
};

// Type 7 of Hyndman and Fan where all weigh the same. There must be a value.
double weighted_quantile(std::vector<std::pair<double, double>> values, double share) {
  std::sort(values.begin(), values.end());
  double sum = 0.0;
  for (const auto& [value, weight] : values) sum += weight;
  const double span = sum - values.back().second;
  if (span <= 0.0) return values.back().first;
  double before = 0.0;
  for (std::size_t k = 0; k + 1 < values.size(); ++k) {
    const double here = before / span, next = (before + values[k].second) / span;
    if (share <= next) {
      const double part = next > here ? (share - here) / (next - here) : 0.0;
      return values[k].first + part * (values[k + 1].first - values[k].first);
    }
    before += values[k].second;
  }
  return values.back().first;
}

// Sums over weighted draws.
class Weighted {
 public:
  explicit Weighted(const std::vector<DrawnDrive>& drives) : drives_(drives) {
    double squares = 0.0;
    for (const DrawnDrive& drive : drives) {
      sum_ += drive.weight;
      squares += drive.weight * drive.weight;
    }
    effective_ = sum_ * sum_ / squares;
  }

  double effective() const { return effective_; }

  template <class Of>
  double mean(Of of) const {
    double total = 0.0;
    for (const DrawnDrive& drive : drives_) total += drive.weight * static_cast<double>(of(drive));
    return total / sum_;
  }

  // Wilson's interval for a share of n, at 90 % [Wilson 1927].
  template <class Of>
  DrawnShare share(Of of) const {
    constexpr double z = kReach90;
    const double n = effective_, p = std::clamp(mean(of), 0.0, 1.0);
    const double centre = (p + z * z / (2.0 * n)) / (1.0 + z * z / n);
    const double half = z / (1.0 + z * z / n) * std::sqrt(p * (1.0 - p) / n + z * z / (4.0 * n * n));
    return {p, std::max(0.0, centre - half), std::min(1.0, centre + half)};
  }

  template <class Of>
  double quantile(Of of, double at) const {
    std::vector<std::pair<double, double>> values;
    for (const DrawnDrive& drive : drives_) values.emplace_back(of(drive), drive.weight);
    return weighted_quantile(std::move(values), at);
  }

 private:
  const std::vector<DrawnDrive>& drives_;
  double sum_ = 0.0, effective_ = 0.0;
};

// Quantiles over the draws that reached a station.
void fill_station(const std::vector<DrawnDrive>& drives, std::size_t s, StationPrediction& station) {
  std::vector<std::pair<double, double>> slip, current, sinkage;
  double bad = 0.0, all = 0.0;
  for (const DrawnDrive& drive : drives) {
    all += drive.weight;
    if (s < drive.bad.size() && drive.bad[s]) bad += drive.weight;
    if (s >= drive.slip.size()) continue;
    slip.emplace_back(drive.slip[s], drive.weight);
    current.emplace_back(drive.current_a[s], drive.weight);
    sinkage.emplace_back(drive.sinkage_m[s], drive.weight);
  }
  station.risk = bad / all;
  if (slip.empty()) return;  // no draw came this far, so that the values on the mean soils remain
  station.slip_ratio_p05 = weighted_quantile(slip, 0.05);
  station.slip_ratio_p50 = weighted_quantile(slip, 0.50);
  station.slip_ratio_p95 = weighted_quantile(slip, 0.95);
  station.current_a_p95 = weighted_quantile(current, 0.95);
  station.sinkage_m_p95 = weighted_quantile(sinkage, 0.95);
}

double limit_of(Rule rule, const DriveLimits& limits) {
  switch (rule) {
    case Rule::kSlipCheck:
      return limits.max_slip_ratio;
    case Rule::kTilt:
      return limits.max_tilt_rad;
    case Rule::kCurrent:
      return limits.max_current_a;
    case Rule::kSinkage:
      return limits.max_sinkage_m;
    case Rule::kClearance:
      return limits.min_clearance_m;
    case Rule::kEmbedding:
      break;
  }
  return 1.0;
}

RuleRisk rule_risk(Rule rule, const std::vector<DrawnDrive>& drives, const Weighted& weighted,
                   const DriveLimits& limits) {
  const auto value = [&](const DrawnDrive& d) { return d.outcome.of(rule).value; };
  RuleRisk risk{.rule = rule,
                .limit = limit_of(rule, limits),
                .value_p05 = weighted.quantile(value, 0.05),
                .value_p50 = weighted.quantile(value, 0.50),
                .value_p95 = weighted.quantile(value, 0.95),
                .trips = weighted.share([&](const DrawnDrive& d) { return d.outcome.of(rule).tripped; })};
  std::map<std::pair<std::size_t, int>, double> places;
  bool first = true;
  for (const DrawnDrive& drive : drives) {
    const RuleTrace& trace = drive.outcome.of(rule);
    if (drive.weight <= 0.0) continue;
    places[{trace.station, trace.wheel}] += drive.weight;
    if (!trace.tripped) continue;
    risk.from_m = first ? trace.first_m : std::min(risk.from_m, trace.first_m);
    risk.to_m = first ? trace.last_m : std::max(risk.to_m, trace.last_m);
    first = false;
  }
  double most = 0.0;
  for (const auto& [place, weight] : places) {
    if (weight <= most) continue;
    most = weight;
    risk.station = place.first;
    risk.wheel = place.second;
  }
  return risk;
}

// The ground that a station stands for: unknown where any wheel is on unknown ground.
std::optional<std::size_t> ground_of(const PreparedStation& station) {
  std::optional<std::size_t> soil = station.soil[0];
  for (std::size_t k = 0; k < station.soil.size(); ++k)
    if (!station.soil[k]) soil.reset();
  return soil;
}

// Stops and embeddings by ground and by stretch.
void locate(const std::vector<DrawnDrive>& drives, const std::vector<PreparedStation>& stations,
            DriveOutcomes& out) {
  constexpr double kMinStretch_m = 10.0;
  constexpr double kMaxStretches = 100.0;
  if (stations.empty()) return;
  const double length = stations.back().distance_m;
  const double pieces = std::clamp(std::ceil(length / kMinStretch_m - 1e-9), 1.0, kMaxStretches);
  for (int k = 0; k < static_cast<int>(pieces); ++k)
    out.stretches.push_back({length * k / pieces, length * (k + 1) / pieces, 0.0, 0.0});
  std::map<std::optional<std::size_t>, GroundRisk> grounds;
  for (const PreparedStation& station : stations) {
    GroundRisk& ground = grounds[ground_of(station)];
    ground.soil = ground_of(station);
    ground.length_m += station.drive_m;
  }
  double sum = 0.0;
  for (const DrawnDrive& drive : drives) sum += drive.weight;
  for (const DrawnDrive& drive : drives) {
    for (const OutcomeEvent& event : drive.outcome.events) {
      const PreparedStation& station = stations[event.station];
      const auto piece = static_cast<std::size_t>(
          length > 0.0 ? std::min(pieces - 1.0, std::floor(station.distance_m / length * pieces)) : 0.0);
      GroundRisk& ground = grounds[ground_of(station)];
      const bool embeds = event.rule == Rule::kEmbedding;
      (embeds ? ground.embedding : ground.expected_stops) += drive.weight / sum;
      (embeds ? out.stretches[piece].embedding : out.stretches[piece].expected_stops) += drive.weight / sum;
    }
  }
  for (const auto& [soil, ground] : grounds) out.grounds.push_back(ground);
}

DriveOutcomes outcomes_of(const std::vector<DrawnDrive>& drives, const Weighted& weighted,
                          const std::vector<PreparedStation>& stations, const DriveLimits& limits) {
  DriveOutcomes out;
  out.effective_draws = weighted.effective();
  out.stop = weighted.share([](const DrawnDrive& d) { return d.outcome.stops > 0; });
  out.embedding = weighted.share([](const DrawnDrive& d) { return d.outcome.embedded; });
  out.completed =
      weighted.share([](const DrawnDrive& d) { return d.outcome.stops == 0 && !d.outcome.embedded; });
  const double mean = weighted.mean([](const DrawnDrive& d) { return d.outcome.stops; });
  const double square = weighted.mean([](const DrawnDrive& d) { return d.outcome.stops * d.outcome.stops; });
  const double error = std::sqrt(std::max(0.0, square - mean * mean) / weighted.effective());
  // Where hardly any draw stops, their scatter says little: the share of draws with a stop bounds the mean.
  out.expected_stops = mean;
  out.expected_stops_low = std::max({0.0, mean - kReach90 * error, std::min(mean, out.stop.low)});
  out.expected_stops_high = std::max(mean + kReach90 * error, mean > 0.0 ? mean : out.stop.high);
  const auto on_known = [&](const DrawnDrive& d, bool embeddings) {
    return static_cast<double>(
        std::count_if(d.outcome.events.begin(), d.outcome.events.end(), [&](const OutcomeEvent& event) {
          return (event.rule == Rule::kEmbedding) == embeddings && ground_of(stations[event.station]);
        }));
  };
  out.embedding_on_known = weighted.share([&](const DrawnDrive& d) { return on_known(d, true); });
  out.expected_stops_on_known = weighted.mean([&](const DrawnDrive& d) { return on_known(d, false); });
  locate(drives, stations, out);
  for (std::size_t rule = 0; rule < kRules; ++rule)
    out.rules.push_back(rule_risk(static_cast<Rule>(rule), drives, weighted, limits));
  return out;
}

void summarise(const std::vector<DrawnDrive>& drives, const std::vector<PreparedStation>& stations,
               const DriveLimits& limits, DrivePrediction& prediction) {
  const Weighted weighted(drives);
  const DrawnShare risk = weighted.share([](const DrawnDrive& d) { return d.any_bad; });
  prediction.draws = static_cast<int>(drives.size());
  prediction.risk = risk.share;
  prediction.risk_low = risk.low;
  prediction.risk_high = risk.high;
  prediction.risk_immobilised = weighted.mean([](const DrawnDrive& d) { return d.immobilised; });
  prediction.outcomes = outcomes_of(drives, weighted, stations, limits);
  std::vector<std::pair<double, double>> duration, energy;
  for (const DrawnDrive& drive : drives) {
    if (drive.immobilised || drive.weight <= 0.0) continue;
    duration.emplace_back(drive.duration_s, drive.weight);
    energy.emplace_back(drive.energy_j, drive.weight);
  }
  prediction.duration_s_p95 = duration.empty() ? prediction.duration_s : weighted_quantile(duration, 0.95);
  prediction.energy_j_p95 = energy.empty() ? prediction.energy_j : weighted_quantile(energy, 0.95);
}

// Both bars have their interval on one side, or one of them is passed for sure.
bool decided(const DriveOutcomes& outcomes, const OutcomeBars& bars) {
  if (outcomes.embedding.low > bars.max_embedding || outcomes.expected_stops_low > bars.max_expected_stops)
    return true;
  return outcomes.embedding.high < bars.max_embedding &&
         outcomes.expected_stops_high < bars.max_expected_stops;
}

// The number of draws after each look at them.
std::size_t next_batch(std::size_t drawn, const RiskOptions& options) {
  const auto first = static_cast<std::size_t>(options.draws);
  if (drawn == 0) return first;
  // 272 without an embedding are the fewest that show less than 1 %.
  constexpr std::size_t kClean = 272;
  const std::size_t next = drawn < kClean ? std::min(2 * drawn, kClean) : 2 * drawn;
  return std::min(next, static_cast<std::size_t>(options.max_draws));
}

// The draws from drives.size() to `count`. False where it was cancelled.
bool draw_more(const DrawnDriver& driver, std::size_t count, std::size_t stations, const RiskOptions& options,
               std::size_t threads, const Progress& progress, std::vector<DrawnDrive>& drives) {
  const std::size_t before = drives.size();
  const std::size_t kept =
      std::max<std::size_t>(kMinProfileDraws, kMaxStates / std::max<std::size_t>(stations, 1));
  drives.resize(count);
  parallel_for(count - before, threads, [&](std::size_t k) {
    const std::size_t draw = before + k;
    drives[draw] = driver.run(random_key(options.seed, draw), draw < kept, progress);
    if (!options.weights) return;
    drives[draw].weight = draw < options.weights->size() ? (*options.weights)[draw] : 0.0;
  });
  return !progress.cancelled();
}

}  // namespace

double largest_current_a(const StationState& state) {
  double largest = 0.0;
  for (const WheelState& wheel : state.wheels) largest = std::max(largest, std::abs(wheel.current_a));
  return largest;
}

double deepest_sinkage_m(const StationState& state) {
  double deepest = 0.0;
  for (const WheelState& wheel : state.wheels) deepest = std::max(deepest, wheel.sinkage_m);
  return deepest;
}

bool breaks(const DriveLimits& limits, const StationState& state) {
  return std::abs(state.slip_ratio) > limits.max_slip_ratio ||
         largest_current_a(state) > limits.max_current_a || deepest_sinkage_m(state) > limits.max_sinkage_m;
}

bool breaks(const DriveLimits& limits, const Stance& stance) {
  return stance.attitude.tilt_rad() > limits.max_tilt_rad ||
         stance.belly_clearance_m < limits.min_clearance_m;
}

Effort effort_of(const PreparedStation& station, const StationState& state) {
  Effort effort;
  if (station.command.turn_in_place) {
    effort.duration_s = station.turn_rad / std::abs(state.yaw_rate_rad_s);
  } else if (station.drive_m > 0.0) {
    // Distances are horizontal, as those of paths.
    const Eigen::Vector2d d = travel_direction(station.command);
    const double rise = station.stance.R_MB(2, 0) * d.x() + station.stance.R_MB(2, 1) * d.y();
    const double over_ground = std::abs(state.along_m_s) * std::sqrt(1.0 - rise * rise);
    effort.duration_s = station.drive_m / over_ground;
  }
  effort.energy_j = effort.duration_s * state.electric_power_w;
  return effort;
}

std::vector<DrawnOutcome> outcomes_of_draws(const RoverModel& rover, double gravity_m_s2,
                                            const SoilBeliefs& beliefs, const PreparedDrive& drive,
                                            const DriveLimits& limits, const RiskOptions& options,
                                            std::size_t threads, Progress& progress) {
  const DrawnDriver driver(rover, gravity_m_s2, beliefs, drive, limits, options.checks);
  std::vector<DrawnOutcome> outcomes(static_cast<std::size_t>(options.draws));
  parallel_for(outcomes.size(), threads, [&](std::size_t draw) {
    const DrawnDrive drawn = driver.run(random_key(options.seed, draw), false, progress);
    outcomes[draw] = {drawn.outcome.stops > 0, drawn.outcome.embedded};
  });
  if (progress.cancelled()) outcomes.clear();
  return outcomes;
}

bool assess_risk(const RoverModel& rover, double gravity_m_s2, const SoilBeliefs& beliefs,
                 const PreparedDrive& drive, const DriveLimits& limits, const RiskOptions& options,
                 std::size_t threads, Progress& progress, DrivePrediction& prediction) {
  const DrawnDriver driver(rover, gravity_m_s2, beliefs, drive, limits, options.checks);
  std::vector<DrawnDrive> drives;
  const auto most = static_cast<std::size_t>(std::max(options.draws, options.max_draws));
  do {
    if (!draw_more(driver, next_batch(drives.size(), options), drive.stations.size(), options, threads,
                   progress, drives))
      return false;
    summarise(drives, drive.stations, limits, prediction);
  } while (drives.size() < most && !decided(prediction.outcomes, options.bars));

  for (std::size_t k = 0; k < prediction.stations.size(); ++k) {
    StationPrediction& station = prediction.stations[k];
    fill_station(drives, k, station);
    if (station.risk > prediction.worst_place.value)
      prediction.worst_place = {station.risk, station.station.distance_m};
  }
  if (drive.without_stance && prediction.immobilised)
    prediction.worst_place = {1.0, prediction.immobilised->distance_m};
  return true;
}

}  // namespace slipway::sim
