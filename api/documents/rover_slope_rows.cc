#include "api/documents/rover_slope_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "core/angle.h"

namespace slipway::api::json {
namespace {

using MaybeNumber = std::optional<double>;

constexpr double kTolerance = 1e-8;  // of the weight, to which the balance is solved; less is nothing

template <class Function>
double sum_over_wheels(const RoverOnSlope& row, Function of_wheel) {
  double total = 0.0;
  for (std::size_t k = 0; k < row.wheels.size(); ++k) total += of_wheel(row.state.wheels[k]);
  return total;
}

struct RoverColumn {
  std::string_view name, unit, summary;
  MaybeNumber (*value)(const RoverOnSlope& row);
  bool by_forces = true;  // not known on ground with a slip curve
};
constexpr std::array kRoverColumns{
    RoverColumn{"slope_deg", "deg", "that the rover climbs; negative: descends",
                [](const RoverOnSlope& r) -> MaybeNumber { return deg_from_rad(r.slope_rad); }, false},
    RoverColumn{"slip", "1", "of the rover: 1 - its speed over the commanded one",
                [](const RoverOnSlope& r) -> MaybeNumber { return r.state.slip_ratio; }, false},
    RoverColumn{"slip_angle_deg", "deg", "of its motion to its heading, positive to the left",
                [](const RoverOnSlope& r) -> MaybeNumber { return deg_from_rad(r.state.side_slip_rad); },
                false},
    RoverColumn{"load_n", "N", "of all wheels, along the ground's normal",
                [](const RoverOnSlope& r) -> MaybeNumber {
                  return sum_over_wheels(r, [](const auto& w) { return w.load_n; });
                }},
    RoverColumn{"drawbar_pull_n", "N", "of all wheels",
                [](const RoverOnSlope& r) -> MaybeNumber {
                  const double pull = sum_over_wheels(r, [](const auto& w) { return w.drawbar_pull_n; });
                  return std::abs(pull) > kTolerance * r.weight_n ? pull : 0.0;
                }},
    RoverColumn{"torque_nm", "N m", "of all wheels",
                [](const RoverOnSlope& r) -> MaybeNumber {
                  return sum_over_wheels(r, [](const auto& w) { return w.torque_nm; });
                }},
    RoverColumn{"current_a", "A", "of all drive motors",
                [](const RoverOnSlope& r) -> MaybeNumber {
                  return sum_over_wheels(r, [](const auto& w) { return w.current_a; });
                }},
    RoverColumn{"power_w", "W", "electric, of all drive motors",
                [](const RoverOnSlope& r) -> MaybeNumber { return r.state.electric_power_w; }},
    RoverColumn{"sinkage_m", "m", "of the deepest wheel",
                [](const RoverOnSlope& r) -> MaybeNumber {
                  double deepest = 0.0;
                  for (std::size_t k = 0; k < r.wheels.size(); ++k)
                    deepest = std::max(deepest, r.state.wheels[k].sinkage_m);
                  return deepest;
                }},
    RoverColumn{"lean_deg", "deg", "that the body's nose rises above the slope as its wheels sink unequally",
                [](const RoverOnSlope& r) -> MaybeNumber {
                  return deg_from_rad(-r.state.attitude.pitch_rad - r.slope_rad);
                }},
};

struct WheelColumn {
  std::string_view name, unit, summary;
  double (*value)(const sim::WheelState& wheel);
};
constexpr std::array kWheelColumns{
    WheelColumn{"load_n", "N", "along the ground's normal",
                [](const sim::WheelState& w) { return w.load_n; }},
    WheelColumn{"slip", "1", "by its rim", [](const sim::WheelState& w) { return w.slip_ratio; }},
    WheelColumn{"sinkage_m", "m", "below the undisturbed ground",
                [](const sim::WheelState& w) { return w.sinkage_m; }},
    WheelColumn{"drawbar_pull_n", "N", "along its heading",
                [](const sim::WheelState& w) { return w.drawbar_pull_n; }},
    WheelColumn{"torque_nm", "N m", "at the axle", [](const sim::WheelState& w) { return w.torque_nm; }},
    WheelColumn{"current_a", "A", "of its motor", [](const sim::WheelState& w) { return w.current_a; }}};

bool is_rover_column(std::string_view name) {
  return std::any_of(kRoverColumns.begin(), kRoverColumns.end(),
                     [&](const RoverColumn& c) { return c.name == name; });
}

void write_rover_column(Writer& w, std::string_view name, std::string_view unit, std::string_view summary) {
  w.begin_object().text("name", name).text("unit", unit).text("summary", summary).end_object();
}

// A balance in which the rover does not come up, or slides back, is none that climbs.
std::string_view rover_outcome(const RoverOnSlope& row) {
  switch (row.state.outcome) {
    case sim::Outcome::kMoving:
      return row.state.slip_ratio < 1.0 ? "balanced" : "immobilised";
    case sim::Outcome::kNoTraction:
      return "immobilised";
    case sim::Outcome::kWheelLifted:
      return "wheel_lifted";
    case sim::Outcome::kSunkToAxle:
      return "sunk_to_axle";
    case sim::Outcome::kStalled:
      return "stalled";
    case sim::Outcome::kOutsideSlipCurve:
      return "outside_slip_curve";
    case sim::Outcome::kNotConverged:
      break;
  }
  return "not_balanced";
}

std::string rover_reason(const RoverOnSlope& row) {
  const sim::StationState& state = row.state;
  if (state.moving()) return "immobilised: the wheels turn and the rover does not climb";
  std::string reason(sim::describe(state.outcome));
  if (state.wheel >= 0) reason += " (" + row.wheels[static_cast<std::size_t>(state.wheel)] + ")";
  return reason;
}

void write_rover_row(Writer& w, const WheelSweepAnswer& answer, const RoverOnSlope& row) {
  w.begin_object();
  for (std::size_t a = 0; a < answer.sweep.axes.size(); ++a)
    if (!is_rover_column(answer.sweep.axes[a].parameter)) w.exact(answer.sweep.axes[a].parameter, row.at[a]);
  const std::string_view outcome = rover_outcome(row);
  const bool balanced = outcome == "balanced";
  for (const RoverColumn& column : kRoverColumns) {
    const bool always = column.name == "slope_deg";
    if (!always && (!balanced || (column.by_forces && row.state.by_slip_curve))) continue;
    if (const MaybeNumber value = column.value(row)) w.significant(column.name, *value);
  }
  if (balanced && !row.state.by_slip_curve)
    for (std::size_t k = 0; k < row.wheels.size(); ++k)
      for (const WheelColumn& column : kWheelColumns)
        w.significant(row.wheels[k] + "_" + std::string(column.name), column.value(row.state.wheels[k]));
  w.text("outcome", outcome);
  if (!balanced) w.text("reason", rover_reason(row));
  w.end_object();
}

}  // namespace

void write_rover_columns(Writer& w, const WheelSweepAnswer& answer) {
  w.key("columns").begin_array();
  for (const sim::SweepAxis& axis : answer.sweep.axes) {
    if (is_rover_column(axis.parameter)) continue;
    const auto field = sim::sweep_field(axis.parameter, *answer.sweep.rig.soil_format);
    write_rover_column(w, axis.parameter, field ? field->unit : "", field ? field->summary : "");
  }
  for (const RoverColumn& column : kRoverColumns)
    write_rover_column(w, column.name, column.unit, column.summary);
  for (const std::string& wheel :
       answer.rover_rows.empty() ? std::vector<std::string>() : answer.rover_rows.front().wheels)
    for (const WheelColumn& column : kWheelColumns)
      write_rover_column(w, wheel + "_" + std::string(column.name), column.unit,
                         fmt::format("of wheel {}: {}", wheel, column.summary));
  write_rover_column(
      w, "outcome", "",
      "balanced, immobilised, sunk_to_axle, stalled, wheel_lifted, outside_slip_curve or not_balanced");
  write_rover_column(w, "reason", "", "why there is no balance");
  w.end_array();
}

void write_rover_rows(Writer& w, const WheelSweepAnswer& answer) {
  w.key("rows").begin_array();
  for (const RoverOnSlope& row : answer.rover_rows) write_rover_row(w, answer, row);
  w.end_array();
}

}  // namespace slipway::api::json
