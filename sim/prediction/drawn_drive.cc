#include "sim/prediction/drawn_drive.h"

#include <cmath>
#include <functional>

#include "sim/prediction/drawn_ground.h"

namespace slipway::sim {
DrawnDriver::DrawnDriver(const RoverModel& rover, double gravity_m_s2, const SoilBeliefs& beliefs,
                         const PreparedDrive& drive, const DriveLimits& limits, const SlipChecks& checks)
    : rover_(rover),
      gravity_m_s2_(gravity_m_s2),
      beliefs_(beliefs),
      drive_(drive),
      limits_(limits),
      checks_(checks),
      drives_level_(rover, gravity_m_s2) {}

DrawnDrive DrawnDriver::run(std::uint64_t key, bool keep_states, const Progress& progress) const {
  DrawnDrive drawn;
  DrawnGround ground(beliefs_, key, std::cref(drives_level_));
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
    if (state.moving()) drive(station, state, drawn);
  }
  drawn.outcome = follower.finish();
  if (drive_.without_stance) {
    // The wheels meet ground that the suspension cannot follow: no draw of the soil passes there.
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
  }
  drawn.immobilised = !state.moving();
}

}  // namespace slipway::sim
