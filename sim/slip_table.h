#pragma once

#include <optional>
#include <vector>

#include "sim/quasi_static.h"

namespace slipway::sim {

// What the table knows of straight driving on a slope, for one rover on one soil.
struct TableEntry {
  double slip_ratio = 0.0;
  double side_slip_rad = 0.0;
  double sinkage_m = 0.0;   // deepest wheel
  double current_a = 0.0;   // largest of the wheels
  double energy_j_m = 0.0;  // per metre made good
  double immobile = 0.0;    // 0 moving, 1 immobilised; between nodes a blend
};

// The table rung: slip, sinkage, current and energy over the body's pitch and roll on a plane, from the
// quasi-static rung at the nodes, bilinear between them. Immutable.
class SlipTable {
 public:
  // Nodes every step_rad over [-limit_rad, limit_rad] in pitch and roll, driving at the rover's cruise speed.
  SlipTable(const RoverModel& rover, double gravity_m_s2, const Soil& soil, double limit_rad, double step_rad,
            const DriveConditions& conditions = {});
  // Forward driving at this attitude; nothing outside the table's limit.
  std::optional<TableEntry> at(double pitch_rad, double roll_rad) const;
  double limit_rad() const { return limit_rad_; }

 private:
  double limit_rad_, step_rad_;
  int nodes_;  // per axis
  std::vector<TableEntry> entries_;
};

}  // namespace slipway::sim
