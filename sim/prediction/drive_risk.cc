#include "sim/prediction/drive_risk.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "core/parallel_for.h"
#include "core/random.h"
#include "sim/prediction/drawn_drive.h"
#include "sim/prediction/drawn_statistics.h"
#include "sim/prediction/scout_drive.h"

namespace slipway::sim {
namespace {

// Quantiles along the way are of the first draws where all of them at all stations would not fit in memory.
constexpr std::size_t kMaxStates = 4'000'000;
constexpr int kMinProfileDraws = 24;

// The number of draws after each look at them.
std::size_t next_batch(std::size_t drawn, const RiskOptions& options) {
  const auto first = static_cast<std::size_t>(options.draws);
  if (drawn < first) return first;
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
    const ConditionedDraw* conditioned =
        options.conditioned && draw < options.conditioned->size() ? &(*options.conditioned)[draw] : nullptr;
    const DrawnRun how{.keep_states = draw < kept, .redrawn = conditioned ? &conditioned->redrawn : nullptr};
    const std::size_t number = conditioned ? conditioned->number.value_or(draw) : draw;
    drives[draw] = driver.run(random_key(options.seed, number), how, progress);
    if (options.conditioned) drives[draw].weight = conditioned ? conditioned->weight : 0.0;
  });
  return !progress.cancelled();
}

// The probability of a halt lies between its bars, on the way or on a segment, and the others keep theirs:
// more draws make neither a GO of it nor a NO-GO.
bool stays_open(const OutcomeBars& bars, const DriveOutcomes& outcomes) {
  const auto is_between = [&](const OutcomeShares& shares) {
    return shares.stop.low > bars.max_stop && shares.stop.high < bars.no_go_stop &&
           shares.immobilised.high < bars.max_immobilised && shares.embedding.high < bars.max_embedding;
  };
  if (outcomes.segments.empty()) return is_between(outcomes);
  return std::any_of(outcomes.segments.begin(), outcomes.segments.end(), is_between);
}

}  // namespace

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

StationState undisturbed(const RoverModel& rover, const Stance& stance, const DriveCommand& command) {
  StationState state;
  state.along_m_s = state.forward_m_s = command.turn_in_place ? 0.0 : command.speed_m_s;
  state.yaw_rate_rad_s =
      command.turn_in_place ? command.turn_rate_rad_s : command.curvature_1_m * command.speed_m_s;
  state.attitude = stance.attitude;
  state.wheels = PerWheel<WheelState>(rover.wheels.size());
  return state;
}

std::vector<DrawnOutcome> outcomes_of_draws(const RoverModel& rover, double gravity_m_s2,
                                            const SoilBeliefs& beliefs, const PreparedDrive& drive,
                                            const DriveLimits& limits, const RiskOptions& options,
                                            std::size_t threads, Progress& progress) {
  const DrawnDriver driver(rover, gravity_m_s2, beliefs, drive, limits, options);
  std::vector<DrawnOutcome> outcomes(static_cast<std::size_t>(options.draws));
  parallel_for(outcomes.size(), threads, [&](std::size_t draw) {
    const DrawnDrive drawn = driver.run(random_key(options.seed, draw), {}, progress);
    outcomes[draw] = {drawn, drawn.immobilised};
  });
  if (progress.cancelled()) outcomes.clear();
  return outcomes;
}

bool assess_risk(const RoverModel& rover, double gravity_m_s2, const SoilBeliefs& beliefs,
                 const PreparedDrive& drive, const DriveLimits& limits, const RiskOptions& options,
                 std::size_t threads, Progress& progress, DrivePrediction& prediction, DrawsSoFar* so_far) {
  const DrawnDriver driver(rover, gravity_m_s2, beliefs, drive, limits, options);
  const DrawsSoFar kept = so_far && *so_far ? *so_far : std::make_shared<DrawnDrives>();
  if (so_far) *so_far = kept;
  // What was drawn before is taken as if it were drawn now: the answer does not depend on it.
  std::vector<DrawnDrive> before = std::exchange(kept->all, {});
  std::vector<DrawnDrive>& drives = kept->all;
  const auto most = static_cast<std::size_t>(std::max(options.draws, options.max_draws));
  do {
    const std::size_t count = next_batch(drives.size(), options);
    while (drives.size() < std::min(count, before.size())) drives.push_back(std::move(before[drives.size()]));
    if (!draw_more(driver, count, drive.stations.size(), options, threads, progress, drives)) {
      drives.clear();  // some were cut short
      return false;
    }
    summarise(drives, drive.stations, limits, options, prediction);
  } while (drives.size() < most && !options.bars.decide(prediction.outcomes) &&
           !stays_open(options.bars, prediction.outcomes));

  prediction.scout = scout_drive(drives, drive.stations, beliefs, prediction.outcomes, options.bars);
  if (!drive.stations.empty())
    fill_events(drives, Segments(drive.stations, options.segment_m), prediction.stations);
  for (std::size_t k = 0; k < prediction.stations.size(); ++k) {
    StationPrediction& station = prediction.stations[k];
    fill_station(drives, k, station);
    if (station.risk > prediction.worst_place.value)
      prediction.worst_place = {station.risk, station.station.distance_m};
  }
  if (drives.size() < before.size())
    drives.insert(drives.end(),
                  std::make_move_iterator(before.begin() + static_cast<std::ptrdiff_t>(drives.size())),
                  std::make_move_iterator(before.end()));
  if (prediction.without_stance) prediction.worst_place = {1.0, prediction.without_stance->distance_m};
  return true;
}

}  // namespace slipway::sim
