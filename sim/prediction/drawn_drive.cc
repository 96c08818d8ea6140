#include "sim/prediction/drawn_drive.h"

#include <cmath>
#include <functional>

#include "core/random.h"
#include "sim/prediction/drawn_ground.h"
#include "sim/prediction/drawn_relief.h"
#include "sim/prediction/odometry_shortfall.h"
#include "sim/wheel/slip_ratio.h"

namespace slipway::sim {
namespace {

// Beside the keys of the soils, which come from their names.
constexpr std::uint64_t kReliefStream = 0x72656c696566ULL;

}  // namespace

double slip_scale(const DrawnGround& ground, const PreparedStation& station) {
  double sum = 0.0;
  for (std::size_t k = 0; k < station.soil.size(); ++k) sum += std::log(ground.slip_scale(station.soil[k]));
  return std::exp(sum / static_cast<double>(station.soil.size()));
}

void scale_slip(double scale, StationState& state) {
  if (!state.moving() || state.slip_ratio >= 1.0 || scale == 1.0) return;
  const double travel = speed_ratio_from_slip(state.slip_ratio);
  const double scaled = std::pow(travel, scale);
  state.along_m_s *= scaled / travel;
  state.slip_ratio = slip_from_speed_ratio(scaled);
}

DrawnDriver::DrawnDriver(const RoverModel& rover, double gravity_m_s2, const SoilBeliefs& beliefs,
                         const PreparedDrive& drive, const DriveLimits& limits, const SlipChecks& checks,
                         const ReliefSpread* relief)
    : rover_(rover),
      gravity_m_s2_(gravity_m_s2),
      beliefs_(beliefs),
      drive_(drive),
      limits_(limits),
      checks_(checks),
      relief_(relief),
      drives_level_(rover, gravity_m_s2) {
  if (!drive.stations.empty()) stretch_ends_m_ = stretch_ends_m(drive.stations);
  geometries_.reserve(drive.stations.size());
  for (const PreparedStation& station : drive.stations)
    geometries_.emplace_back(rover, gravity_m_s2, station.stance, station.command);
}

DrawnDrive DrawnDriver::run(std::uint64_t key, const DrawnRun& how, const Progress& progress) const {
  DrawnDrive drawn;
  DrawnGround ground(beliefs_, key, std::cref(drives_level_), how.redrawn);
  if (how.met) ground.note(*how.met);
  QuasiStaticSolver solver(rover_, gravity_m_s2_, Precision::kDraws);
  OutcomeFollower follower(rover_, limits_, checks_);
  ShortfallFollower shortfall(stretch_ends_m_);
  PerWheel<Soil> under(rover_.wheels.size());
  std::optional<DrawnRelief> relief;
  if (relief_) relief.emplace(*drive_.ground, *relief_, random_key(key, kReliefStream));
  bool without_stance = drive_.without_stance;
  const RoverBalance::Vector* last_on_means = nullptr;
  bool embedded = false;
  for (std::size_t s = 0; s < drive_.stations.size() && !(embedded && drawn.immobilised); ++s) {
    if (progress.cancelled()) break;
    PreparedStation on_relief;
    std::optional<BalanceGeometry> geometry_on_relief;
    if (relief) {
      const std::optional<Stance> stance = settle(rover_, *relief, drive_.stations[s].pose);
      if (!stance) {
        without_stance = true;
        break;
      }
      on_relief = drive_.stations[s];
      on_relief.stance = *stance;
      geometry_on_relief.emplace(rover_, gravity_m_s2_, on_relief.stance, on_relief.command);
    }
    const PreparedStation& station = relief ? on_relief : drive_.stations[s];
    for (std::size_t k = 0; k < under.size(); ++k)
      under[k] = ground.at(station.soil[k], station.pose.x_m, station.pose.y_m);
    if (station.on_means) {
      solver.follow(last_on_means ? *last_on_means : *station.on_means, *station.on_means);
      last_on_means = &*station.on_means;
    }
    StationState state = solver.solve(relief ? *geometry_on_relief : geometries_[s], under);
    scale_slip(slip_scale(ground, station), state);
    if (!embedded) embedded = !follower.add(station, s, state);
    if (how.to_first_stop && (embedded || follower.stops() > 0)) break;
    const bool was_held = drawn.immobilised;
    if (!was_held) add(station, state, how.keep_states, drawn);
    if (!state.moving()) continue;
    drive(station, state, drawn);
    if (!was_held) shortfall.add(station.drive_m, state.slip_ratio);
  }
  drawn.outcome = follower.finish();
  drawn.shortfall_m = shortfall.finish(drawn.immobilised || without_stance);
  if (without_stance) {
    // The wheels meet ground that the suspension cannot follow.
    drawn.breaks_a_limit = drawn.immobilised = true;
    drawn.outcome.embedded = true;
    drawn.outcome.rules[static_cast<std::size_t>(Rule::kEmbedding)].tripped = true;
  }
  drawn.stops = drawn.outcome.stops;
  drawn.embedded = drawn.outcome.embedded;
  return drawn;
}

void DrawnDriver::drive(const PreparedStation& station, const StationState& state, DrawFigures& figures) {
  const Effort effort = effort_of(station, state);
  figures.driven_m += station.drive_m;
  figures.duration_s += effort.duration_s;
  figures.energy_j += effort.energy_j;
  figures.slip_length_m += std::abs(state.slip_ratio) * station.drive_m;
}

void DrawnDriver::add(const PreparedStation& station, const StationState& state, bool keep_states,
                      DrawnDrive& drawn) const {
  const bool bad = !state.moving() || breaks(limits_, state) || breaks(limits_, station.stance);
  drawn.breaks_a_limit |= bad;
  drawn.bad.push_back(bad);
  if (keep_states) {
    drawn.slip.push_back(static_cast<float>(state.slip_ratio));
    drawn.current_a.push_back(static_cast<float>(largest_current_a(state)));
    drawn.sinkage_m.push_back(static_cast<float>(deepest_sinkage_m(state)));
    drawn.tilt_rad.push_back(static_cast<float>(state.attitude.tilt_rad()));
    drawn.clearance_m.push_back(static_cast<float>(station.stance.belly_clearance_m));
  }
  drawn.immobilised = !state.moving();
}

}  // namespace slipway::sim
