#include "sim/prediction/drawn_drive.h"

#include <cmath>

#include "sim/prediction/drawn_ground.h"

namespace slipway::sim {
namespace {

class LevelGround final : public Ground {
 public:
  std::optional<GroundPoint> at(double /*x_m*/, double /*y_m*/) const override { return GroundPoint{}; }
  std::optional<std::size_t> soil_at(double /*x_m*/, double /*y_m*/) const override { return std::nullopt; }
};

}  // namespace

DrawnDriver::DrawnDriver(const RoverModel& rover, double gravity_m_s2, const SoilBeliefs& beliefs,
                         const PreparedDrive& drive, const DriveLimits& limits, const SlipChecks& checks)
    : rover_(rover),
      gravity_m_s2_(gravity_m_s2),
      beliefs_(beliefs),
      drive_(drive),
      limits_(limits),
      checks_(checks),
      level_(settle(rover, LevelGround(), {})) {}

DrawnDrive DrawnDriver::run(std::uint64_t key, bool keep_states, const Progress& progress) const {
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

bool DrawnDriver::drives_level(const Soil& soil) const {
  if (!level_) return true;
  QuasiStaticSolver solver(rover_, gravity_m_s2_, Precision::kDraws);
  const StationState state = solver.solve(*level_, soil, {.speed_m_s = rover_.cruise_speed_m_s});
  return state.moving() && state.slip_ratio < kMaxLevelSlip;
}

void DrawnDriver::add(const PreparedStation& station, const StationState& state, bool keep_states,
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
  drawn.length_m += station.drive_m;
  drawn.slip_length_m += std::abs(state.slip_ratio) * station.drive_m;
}

}  // namespace slipway::sim
