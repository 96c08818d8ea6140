#include "sim/slip_table.h"

#include <algorithm>
#include <cmath>

namespace slipway::sim {
namespace {

TableEntry entry_of(const StationState& state, double cos_tilt) {
  TableEntry entry;
  entry.slip_ratio = state.slip_ratio;
  entry.side_slip_rad = state.side_slip_rad;
  entry.immobile = state.moving() ? 0.0 : 1.0;
  for (const WheelState& wheel : state.wheels) {
    entry.sinkage_m = std::max(entry.sinkage_m, wheel.sinkage_m);
    entry.current_a = std::max(entry.current_a, std::abs(wheel.current_a));
  }
  const double made_good = state.forward_m_s * cos_tilt;
  entry.energy_j_m = state.moving() ? state.electric_power_w / made_good : 0.0;
  return entry;
}

TableEntry blend(const TableEntry& a, const TableEntry& b, double t) {
  // Energy per metre means nothing where the rover does not move: there the moving node's stands.
  const auto mix = [t](double x, double y) { return x + t * (y - x); };
  const double energy_a = a.immobile > 0.0 && a.energy_j_m == 0.0 ? b.energy_j_m : a.energy_j_m;
  const double energy_b = b.immobile > 0.0 && b.energy_j_m == 0.0 ? a.energy_j_m : b.energy_j_m;
  return {mix(a.slip_ratio, b.slip_ratio), mix(a.side_slip_rad, b.side_slip_rad),
          mix(a.sinkage_m, b.sinkage_m),   mix(a.current_a, b.current_a),
          mix(energy_a, energy_b),         mix(a.immobile, b.immobile)};
}

}  // namespace

SlipTable::SlipTable(const RoverModel& rover, double gravity_m_s2, const Soil& soil, double limit_rad,
                     double step_rad, const DriveConditions& conditions)
    : step_rad_(step_rad) {
  const int half = std::max(1, static_cast<int>(std::ceil(limit_rad / step_rad - 1e-9)));
  nodes_ = 2 * half + 1;
  limit_rad_ = half * step_rad_;
  entries_.resize(static_cast<std::size_t>(nodes_) * nodes_);
  QuasiStaticSolver solver(rover, gravity_m_s2);
  const DriveCommand command{.speed_m_s = rover.cruise_speed_m_s, .motor_temp_c = conditions.motor_temp_c};
  for (int i = 0; i < nodes_; ++i) {
    for (int j = 0; j < nodes_; ++j) {
      // There and back, so that neighbours in the order are neighbours on the table and each start is a warm
      // one.
      const int column = i % 2 == 0 ? j : nodes_ - 1 - j;
      const Attitude attitude{
          .roll_rad = (column - half) * step_rad_, .pitch_rad = (i - half) * step_rad_, .yaw_rad = 0.0};
      const StationState state = solver.solve(stance_on_plane(rover, attitude), soil, command);
      entries_[static_cast<std::size_t>(i) * nodes_ + column] = entry_of(state, std::cos(attitude.pitch_rad));
    }
  }
}

std::optional<TableEntry> SlipTable::at(double pitch_rad, double roll_rad) const {
  if (!(std::abs(pitch_rad) <= limit_rad_ && std::abs(roll_rad) <= limit_rad_)) return std::nullopt;
  const double row = (pitch_rad + limit_rad_) / step_rad_, column = (roll_rad + limit_rad_) / step_rad_;
  const int i = std::min(static_cast<int>(row), nodes_ - 2),
            j = std::min(static_cast<int>(column), nodes_ - 2);
  const TableEntry* corner = &entries_[static_cast<std::size_t>(i) * nodes_ + j];
  const double t = column - j;
  return blend(blend(corner[0], corner[1], t), blend(corner[nodes_], corner[nodes_ + 1], t), row - i);
}

}  // namespace slipway::sim
