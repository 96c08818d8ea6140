#pragma once

#include <optional>
#include <vector>

#include "sim/quasi_static/quasi_static.h"

namespace slipway::sim {

// What the table knows of straight driving on a slope, for one rover on one soil.
struct TableEntry {
  double slip_ratio = 0.0;
  double side_slip_rad = 0.0;
  double sinkage_m = 0.0;   // deepest wheel
  double current_a = 0.0;   // largest of the wheels
  double energy_j_m = 0.0;  // per metre made good
  // What the wheels' unequal sinkages add to the plane's pitch and roll. 0 on a soil with a slip curve.
  double pitch_lean_rad = 0.0, roll_lean_rad = 0.0;
  bool immobile = false;  // then slip is 1, energy 0 and the rest as at the limit
  bool by_slip_curve =
      false;  // the soil has a slip curve: sinkage, current and energy are not known, and 0 here
};

// The table level: slip, sinkage, current and energy over the body's pitch and roll on a plane, from the
// quasi-static level at nodes. Immutable.
//
// Slip has a limit at which the rover comes to a stand, p(roll), close to which it turns up steeply. So a
// column of nodes at one roll counts its pitch from its own limit, d = pitch - p(roll), no cell straddles the
// limit, and the nodes are the closer the nearer they are to it: one lies at every whole number xi of
//
//   xi(d) = (d + (b - a) ln(1 + d / a)) / step     dd/dxi = step (d + a) / (d + b)
//
// Tabulated are quantities that stay smooth where slip and side slip do not: the speed ratios along and
// across, the lean, and each wheel's sinkage and motor's torque. Currents, which have a kink where the ground
// drives a motor, and power come from the torques. Cubic between nodes (Lagrange's polynomial through four
// each way), one-sided at the table's edges and at the limit.
//
// A soil with a slip curve needs no nodes: its curve is asked at every attitude.
class SlipTable {
 public:
  // Columns every step_rad over [-limit_rad, limit_rad] in roll, driving at the rover's cruise speed.
  SlipTable(const RoverModel& rover, double gravity_m_s2, const Soil& soil, double limit_rad, double step_rad,
            const DriveConditions& conditions = {});
  // Forward driving at this attitude; nothing outside the table's limit.
  std::optional<TableEntry> at(double pitch_rad, double roll_rad) const;
  double limit_rad() const { return limit_rad_; }

 private:
  // Nodes first .. last of one roll; last < first where the rover moves at no pitch.
  struct Column {
    double traction_limit_rad = 0.0;
    int first = 0, last = -1;
    std::size_t begin = 0;  // of the first node's fields

    bool empty() const { return last < first; }
  };
  // Four neighbours at most, and their weights.
  struct Stencil;

  void find_limits(const RoverModel& rover, double gravity_m_s2, const Soil& soil,
                   const DriveCommand& command);
  void fill(Column& column, double lowest_d_rad, double highest_d_rad, double roll_rad, const Soil& soil,
            const RoverModel& rover, const DriveCommand& command, QuasiStaticSolver& solver);
  double xi(double d_rad) const;
  double d_rad(double xi) const;
  Stencil columns_about(double place) const;
  TableEntry entry_of(const double* values, double pitch_rad) const;
  TableEntry entry_on_curve(double pitch_rad, double roll_rad) const;

  double limit_rad_, step_rad_;
  double speed_m_s_;                 // commanded, as far as it can be attained
  DriveMotor drive_;                 // at its temperature
  std::vector<double> rates_rad_s_;  // of the driven wheels; 0 of the others
  int wheels_, fields_;
  std::vector<Column> columns_;
  std::vector<double> values_;
  std::optional<Soil> curve_soil_;  // where it has a slip curve
};

}  // namespace slipway::sim
