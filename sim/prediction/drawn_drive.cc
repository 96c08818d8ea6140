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

// How far the heading leaves that of the command on the way to a station.
double turned_off_rad(const PreparedStation& station, const StationState& state) {
  if (station.command.turn_in_place || station.drive_m <= 0.0) return 0.0;
  const double commanded = station.command.curvature_1_m * state.along_m_s;
  return (state.yaw_rate_rad_s - commanded) * effort_of(station, state).duration_s;
}

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

struct DrawnDriver::Run {
  Run(const DrawnDriver& driver, std::uint64_t key, const DrawnRun& how)
      : ground(driver.beliefs_, key, std::cref(driver.drives_level_), how.redrawn),
        solver(driver.rover_, driver.gravity_m_s2_, Precision::kDraws),
        follower(driver.rover_, driver.limits_, driver.options_.checks, driver.options_.segment_m),
        shortfall(driver.stretch_ends_m_),
        drift(driver.stretch_ends_m_),
        under(driver.rover_.wheels.size()) {
    if (how.met) ground.note(*how.met);
    if (driver.options_.relief && !driver.drive_.stations.empty())
      relief.emplace(*driver.drive_.ground, *driver.options_.relief, random_key(key, kReliefStream),
                     StandingPlace{driver.drive_.stations.front().pose, driver.rover_.circumscribed_m()});
  }

  DrawnGround ground;
  QuasiStaticSolver solver;
  OutcomeFollower follower;
  ShortfallFollower shortfall;
  DriftFollower drift;
  PerWheel<Soil> under;
  std::optional<DrawnRelief> relief;
  const RoverBalance::Vector* last_on_means = nullptr;
  std::optional<StationState> last;  // where the rover moved
};

DrawnDriver::DrawnDriver(const RoverModel& rover, double gravity_m_s2, const SoilBeliefs& beliefs,
                         const PreparedDrive& drive, const DriveLimits& limits, const RiskOptions& options)
    : rover_(rover),
      gravity_m_s2_(gravity_m_s2),
      beliefs_(beliefs),
      drive_(drive),
      limits_(limits),
      options_(options),
      station_rules_(rover, limits),
      drives_level_(rover, gravity_m_s2) {
  if (!drive.stations.empty()) stretch_ends_m_ = stretch_ends_m(drive.stations);
  geometries_.reserve(drive.stations.size());
  for (const PreparedStation& station : drive.stations)
    geometries_.emplace_back(rover, gravity_m_s2, station.stance, station.command);
}

std::optional<PreparedStation> DrawnDriver::on_relief(std::size_t s, const Ground& relief) const {
  const std::optional<Stance> stance = settle(rover_, relief, drive_.stations[s].pose);
  if (!stance) return std::nullopt;
  PreparedStation station = drive_.stations[s];
  station.stance = *stance;
  return station;
}

// Where the solver gives up, the rover is taken to go on as it came.
StationState DrawnDriver::balance(std::size_t s, const PreparedStation& station, Run& run,
                                  DrawnDrive& drawn) const {
  for (std::size_t k = 0; k < run.under.size(); ++k)
    run.under[k] = run.ground.at(station.soil[k], station.pose.x_m, station.pose.y_m);
  if (station.on_means) {
    run.solver.follow(run.last_on_means ? *run.last_on_means : *station.on_means, *station.on_means);
    run.last_on_means = &*station.on_means;
  }
  StationState state =
      run.relief ? run.solver.solve(BalanceGeometry(rover_, gravity_m_s2_, station.stance, station.command),
                                    run.under)
                 : run.solver.solve(geometries_[s], run.under);
  if (state.outcome == Outcome::kNotConverged) {
    drawn.unsolved = true;
    return run.last ? *run.last : undisturbed(rover_, station.stance, station.command);
  }
  scale_slip(slip_scale(run.ground, station), state);
  if (state.moving()) run.last = state;
  return state;
}

DrawnDrive DrawnDriver::run(std::uint64_t key, const DrawnRun& how, const Progress& progress) const {
  DrawnDrive drawn;
  Run run(*this, key, how);
  bool without_stance = drive_.without_stance, embedded = false;
  std::size_t s = 0;
  for (; s < drive_.stations.size() && !(embedded && drawn.immobilised); ++s) {
    if (progress.cancelled()) break;
    const std::optional<PreparedStation> drawn_station =
        run.relief ? on_relief(s, *run.relief) : std::nullopt;
    if (run.relief && !drawn_station) {
      without_stance = true;
      break;
    }
    const PreparedStation& station = drawn_station ? *drawn_station : drive_.stations[s];
    const StationState state = balance(s, station, run, drawn);
    if (!embedded) embedded = !run.follower.add(station, s, state);
    if (how.to_first_stop && (embedded || run.follower.stops() > 0)) break;
    const bool was_held = drawn.immobilised;
    if (!was_held) add(station, state, run.follower.aside_m(), how.keep_states, drawn);
    if (!state.moving()) continue;
    drive(station, state, drawn);
    if (was_held) continue;
    run.shortfall.add(station.drive_m, state.slip_ratio);
    run.drift.add(station.drive_m, state.side_slip_rad, turned_off_rad(station, state));
  }
  if (without_stance && !embedded && !drive_.stations.empty()) {
    const std::size_t at = std::min(s, drive_.stations.size() - 1);
    run.follower.without_stance(drive_.stations[at], at);
    drawn.breaks_a_limit = drawn.immobilised = true;
  }
  drawn.outcome = run.follower.finish();
  drawn.shortfall_m = run.shortfall.finish(drawn.immobilised);
  run.drift.finish(drawn.drift_m, drawn.turned_rad);
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

void DrawnDriver::add(const PreparedStation& station, const StationState& state, double aside_m,
                      bool keep_states, DrawnDrive& drawn) const {
  const bool bad = !state.moving() || station_rules_.broken_by(station.stance, station.command, state);
  drawn.breaks_a_limit |= bad;
  drawn.bad.push_back(bad);
  if (keep_states) {
    drawn.slip.push_back(static_cast<float>(state.slip_ratio));
    drawn.current_a.push_back(static_cast<float>(largest_current_a(state)));
    drawn.sinkage_m.push_back(static_cast<float>(deepest_sinkage_m(state)));
    drawn.tilt_rad.push_back(static_cast<float>(state.attitude.tilt_rad()));
    drawn.clearance_m.push_back(static_cast<float>(station.stance.belly_clearance_m));
    drawn.aside_m.push_back(static_cast<float>(aside_m));
  }
  drawn.immobilised = !state.moving();
}

}  // namespace slipway::sim
