#include "sim/single_wheel/wheel_sweep.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/angle.h"
#include "sim/rover/rover_field.h"

namespace slipway::sim {
std::size_t rows_of(const WheelSweep& sweep) {
  if (sweep.paired) return sweep.axes.empty() ? 0 : sweep.axes.front().values.size();
  std::size_t rows = 1;
  for (const SweepAxis& axis : sweep.axes) rows *= axis.values.size();
  return rows;
}

WheelRig rig_of(const WheelSweep& sweep, std::size_t row, std::vector<double>& at) {
  WheelRig rig = sweep.rig;
  at.resize(sweep.axes.size());
  for (std::size_t a = sweep.axes.size(); a-- > 0;) {
    const SweepAxis& axis = sweep.axes[a];
    at[a] = axis.values[row % axis.values.size()];
    if (!sweep.paired) row /= axis.values.size();
  }
  for (const SweepSetting& setting : sweep.set) set_sweep_parameter(setting.parameter, setting.value, rig);
  for (std::size_t a = 0; a < sweep.axes.size(); ++a)
    set_sweep_parameter(sweep.axes[a].parameter, at[a], rig);
  return rig;
}

namespace {

std::string unknown_parameter(const std::string& parameter, const SoilFormat& format) {
  std::string known;
  for (const std::string& name : sweep_field_names(format)) known += (known.empty() ? "" : ", ") + name;
  return fmt::format("\"{:.80}\" is nothing a single wheel can be swept over, known: {}", parameter, known);
}

// What is wrong with a value; nothing where it is in the parameter's range.
std::optional<std::string> out_of_range(const std::string& parameter, const Field& field, double value) {
  if (value >= field.lowest && value <= field.highest) return std::nullopt;
  return out_of_range_in_words(parameter, value, field);
}

void check_axis(const SweepAxis& axis, const WheelRig& rig, const std::string& pointer,
                std::vector<Fault>& faults) {
  const auto field = sweep_field(axis.parameter, *rig.soil_format);
  if (!field)
    return faults.push_back({pointer + "/parameter", unknown_parameter(axis.parameter, *rig.soil_format)});
  for (std::size_t i = 0; i < axis.values.size(); ++i) {
    if (const auto fault = out_of_range(axis.parameter, *field, axis.values[i]))
      return faults.push_back({fmt::format("{}/values/{}", pointer, i), *fault});  // one of a range is enough
  }
}

void check_setting(const SweepSetting& setting, const WheelRig& rig, std::vector<Fault>& faults) {
  const std::string pointer = "/set/" + setting.parameter;
  const auto field = sweep_field(setting.parameter, *rig.soil_format);
  if (!field) return faults.push_back({pointer, unknown_parameter(setting.parameter, *rig.soil_format)});
  if (const auto fault = out_of_range(setting.parameter, *field, setting.value))
    faults.push_back({pointer, *fault});
}

// Where the blame for a row's fault lies: the axis that sets the parameter, or the parameter itself.
std::string pointer_to(const WheelSweep& sweep, std::string_view parameter) {
  for (std::size_t a = 0; a < sweep.axes.size(); ++a) {
    if (sweep.axes[a].parameter == parameter) return fmt::format("/sweep/{}", a);
  }
  return fmt::format("/{}", parameter);
}

// What no rig can do; nothing where it can.
std::optional<Fault> impossible(const WheelSweep& sweep, const WheelRigConditions& test) {
  constexpr double kRight = 0.5 * std::numbers::pi * (1.0 - 1e-9);
  if (test.slip_definition == SlipDefinition::kForward && std::abs(test.slip_angle_rad) >= kRight)
    return Fault{pointer_to(sweep, "slip_angle_deg"),
                 "slip_angle_deg = 90 deg, must be below 90 where slip is by the forward speed, which is 0 "
                 "there; slip_definition \"travel\" knows a slip at 90 deg"};
  if (test.slope_rad && test.sinkage_m)
    return Fault{pointer_to(sweep, "slope_deg"),
                 "slope_deg and sinkage_m: a wheel that climbs carries its load, at no depth that is held"};
  if (test.slope_rad && test.slip_angle_rad != 0.0)
    return Fault{pointer_to(sweep, "slope_deg"), "slope_deg and slip_angle_deg: a wheel climbs straight on"};
  const double deepest = sinkage_m(test.wheel.radius_m, max_entry_angle_rad(test.soil));
  if (test.sinkage_m && *test.sinkage_m > deepest)
    return Fault{
        pointer_to(sweep, "sinkage_m"),
        fmt::format("sinkage_m = {:g} m, must be at most {:.6g}: the axle", *test.sinkage_m, deepest)};
  const double stiffness =
      test.soil.pressure_form({.width_m = test.wheel.width_m, .radius_m = test.wheel.radius_m}).stiffness;
  if (!(stiffness > 0.0))
    return Fault{"/soil", fmt::format("{} = {:g}, must be positive for a wheel of width {:g} m",
                                      test.soil.pressure_law.row == nullptr ? "k_c / b + k_phi"
                                                                            : "the pressure's factor",
                                      stiffness, test.wheel.width_m)};
  return std::nullopt;
}

}  // namespace

double rounded_to_twelve(double value) {
  return std::stod(fmt::format("{:.12g}", value));
}

std::vector<double> stepped(double lowest, double highest, double step) {
  std::vector<double> values;
  const double steps = std::max(0.0, std::floor((highest - lowest) / step + 1e-9));
  const double nothing = 1e-12 * std::max(std::abs(lowest), std::abs(highest));
  for (std::size_t i = 0; static_cast<double>(i) <= steps && i <= kMaxSweepRows; ++i) {
    const double value = lowest + static_cast<double>(i) * step;
    values.push_back(std::abs(value) <= nothing ? 0.0 : rounded_to_twelve(value));
  }
  return values;
}

std::vector<Fault> parameter_faults(const WheelSweep& sweep) {
  std::vector<Fault> faults;
  for (const SweepSetting& setting : sweep.set) check_setting(setting, sweep.rig, faults);
  for (std::size_t a = 0; a < sweep.axes.size(); ++a)
    check_axis(sweep.axes[a], sweep.rig, fmt::format("/sweep/{}", a), faults);
  return faults;
}

std::vector<Fault> faults_of(const WheelSweep& sweep) {
  std::vector<Fault> faults = parameter_faults(sweep);
  const std::size_t most = sweep.paired ? kMaxPairedAxes : kMaxSweepAxes;
  if (sweep.axes.size() > most)
    faults.push_back(
        {"/sweep", fmt::format("sweep has {} axes, must have at most {}", sweep.axes.size(), most)});
  for (std::size_t a = 0; a < sweep.axes.size(); ++a) {
    const SweepAxis& axis = sweep.axes[a];
    for (std::size_t before = 0; before < a; ++before)
      if (sweep.axes[before].parameter == axis.parameter)
        faults.push_back(
            {fmt::format("/sweep/{}/parameter", a), fmt::format("{} is swept twice", axis.parameter)});
    if (sweep.paired && axis.values.size() != sweep.axes.front().values.size())
      faults.push_back(
          {fmt::format("/sweep/{}/values", a),
           fmt::format("{} values, must be as many as the first axis has, {}: the sweep is paired",
                       axis.values.size(), sweep.axes.front().values.size())});
  }
  if (sweep.paired && sweep.axes.empty()) faults.push_back({"/sweep", "sweep is paired and has no axes"});
  if (!faults.empty()) return faults;
  if (rows_of(sweep) > kMaxSweepRows)
    faults.push_back(
        {"/sweep", fmt::format("sweep has {} rows, must have at most {}", rows_of(sweep), kMaxSweepRows)});
  if (sweep.rig.soil.slip_curve != nullptr) {
    faults.push_back(
        {"/soil", "the soil is known by a slip curve alone, which says nothing of a single wheel's forces"});
    return faults;
  }
  for (std::size_t a = 0; a < sweep.axes.size(); ++a)
    if (auto fault = not_of_this_soil(sweep.axes[a].parameter, sweep.rig.soil))
      faults.push_back({fmt::format("/sweep/{}/parameter", a), std::move(*fault)});
  for (const SweepSetting& setting : sweep.set)
    if (auto fault = not_of_this_soil(setting.parameter, sweep.rig.soil))
      faults.push_back({"/set/" + setting.parameter, std::move(*fault)});
  if (!faults.empty()) return faults;
  for (const SweepPoint& point : points_of(sweep)) {
    if (auto fault = impossible(sweep, point.test)) return {*fault};
  }
  return faults;
}

std::vector<SweepPoint> points_of(const WheelSweep& sweep) {
  std::vector<SweepPoint> points(rows_of(sweep));
  for (std::size_t i = 0; i < points.size(); ++i)
    points[i].test = conditions_of(rig_of(sweep, i, points[i].at));
  return points;
}

std::vector<SweepRow> run_wheel_sweep(const WheelSweep& sweep) {
  std::vector<SweepRow> rows;
  for (SweepPoint& point : points_of(sweep)) {
    WheelRigResult result = run_wheel_rig(point.test);
    rows.push_back({std::move(point), std::move(result)});
  }
  return rows;
}

}  // namespace slipway::sim
