#include "sim/quasi_static/slip_table.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/angle.h"
#include "core/pose.h"
#include "sim/quasi_static/balance_search.h"
#include "sim/quasi_static/slip_curve_motion.h"
#include "sim/quasi_static/traction_limit.h"
#include "sim/rover/drive_command.h"
#include "sim/wheel/slip_ratio.h"

namespace slipway::sim {
namespace {

// Node spacing: at the limit this share of the step, half way to the whole at b. See the header's xi.
const double kA_rad = rad_from_deg(0.2), kB_rad = rad_from_deg(6.0);
// Limits are followed this far beyond the table's edge, so that they stay smooth along it.
const double kBeyond_rad = rad_from_deg(8.0);
// Near the steepest side slope that holds the rover its limit of climbing turns up ever faster. Columns whose
// limits are further apart than this say nothing of each other.
const double kLimitJump_rad = rad_from_deg(3.0);
// Speed ratios along and across, lean in pitch and roll; then the wheels' sinkages, then the motors' torques.
constexpr int kMotionFields = 4;

}  // namespace

struct SlipTable::Stencil {
  int first = 0, count = 0;
  std::array<double, 4> weight{};

  // Lagrange's polynomial through nodes at whole numbers, at `place`: through the four about it, or the
  // nearest four of first .. last.
  static Stencil at(double place, int lowest, int highest) {
    Stencil s;
    s.count = std::min(4, highest - lowest + 1);
    s.first = std::clamp(static_cast<int>(std::floor(place)) - 1, lowest, highest - s.count + 1);
    const double t = place - s.first;
    for (int i = 0; i < s.count; ++i) {
      s.weight[i] = 1.0;
      for (int j = 0; j < s.count; ++j)
        if (j != i) s.weight[i] *= (t - j) / (i - j);
    }
    return s;
  }
};

SlipTable::SlipTable(const RoverModel& rover, double gravity_m_s2, const Soil& soil, double limit_rad,
                     double step_rad, const DriveConditions& conditions)
    : step_rad_(step_rad),
      wheels_(static_cast<int>(rover.wheels.size())),
      fields_(kMotionFields + 2 * wheels_) {
  const int half = std::max(1, static_cast<int>(std::ceil(limit_rad / step_rad - 1e-9)));
  limit_rad_ = half * step_rad_;
  if (soil.slip_curve != nullptr) {
    curve_soil_ = soil;
    return;
  }
  columns_.resize(2 * static_cast<std::size_t>(half) + 1);
  const DriveCommand command{.speed_m_s = rover.cruise_speed_m_s, .motor_temp_c = conditions.motor_temp_c};
  speed_m_s_ = command.speed_m_s * attainable_share(rover, command);
  drive_ = at_temperature(rover.drive, command.motor_temp_c.value_or(rover.drive.reference_temp_c));
  const PerWheel<WheelCommand> commands = wheel_commands(rover, command);
  for (int k = 0; k < wheels_; ++k) {
    const WheelModel& wheel = rover.wheels[k];
    const bool is_driven = wheel.drive == WheelDrive::kDriven;
    rates_rad_s_.push_back(is_driven ? true_motion(wheel, commands[k]).rate_rad_s : 0.0);
  }
  find_limits(rover, gravity_m_s2, soil, command);
  QuasiStaticSolver solver(rover, gravity_m_s2);
  const int columns = static_cast<int>(columns_.size());
  for (int c = 0; c < columns; ++c) {
    Column& column = columns_[c];
    if (column.empty()) continue;
    // A column takes part in interpolation up to two columns away, at the same d.
    double highest_limit = column.traction_limit_rad, lowest_limit = highest_limit;
    for (int n = std::max(0, c - 2); n <= std::min(columns - 1, c + 2); ++n) {
      if (columns_[n].empty()) continue;
      highest_limit = std::max(highest_limit, columns_[n].traction_limit_rad);
      lowest_limit = std::min(lowest_limit, columns_[n].traction_limit_rad);
    }
    fill(column, std::max(0.0, -limit_rad_ - highest_limit), limit_rad_ - lowest_limit,
         (c - half) * step_rad_, soil, rover, command, solver);
  }
}

// From level outwards; beyond a roll at which the rover moves at no pitch it moves at none.
void SlipTable::find_limits(const RoverModel& rover, double gravity_m_s2, const Soil& soil,
                            const DriveCommand& command) {
  TractionLimitSearch search(rover, gravity_m_s2, soil, command, -limit_rad_ - kBeyond_rad, limit_rad_);
  const int half = static_cast<int>(columns_.size()) / 2;
  for (const int way : {1, -1}) {
    std::optional<double> guess;
    for (int c = half; c >= 0 && c <= 2 * half; c += way) {
      if (c == half && way < 0) {
        guess = columns_[half].traction_limit_rad;
        if (columns_[half].last < 0) return;
        continue;
      }
      guess = search.find((c - half) * step_rad_, guess);
      if (!guess) break;
      columns_[c].traction_limit_rad = *guess;
      columns_[c].last = 0;
    }
  }
}

void SlipTable::fill(Column& column, double lowest_d_rad, double highest_d_rad, double roll_rad,
                     const Soil& soil, const RoverModel& rover, const DriveCommand& command,
                     QuasiStaticSolver& solver) {
  column.first = std::max(0, static_cast<int>(std::floor(xi(lowest_d_rad))) - 1);
  column.begin = values_.size();
  const int highest = std::max(column.first + 3, static_cast<int>(std::ceil(xi(highest_d_rad))));
  column.last = highest;
  values_.resize(column.begin + static_cast<std::size_t>((highest - column.first + 1) * fields_));
  // Downwards, each start a warm one: so the search stays with the motion that drives, where there is
  // another.
  for (int node = highest; node >= column.first; --node) {
    const Attitude attitude{
        .roll_rad = roll_rad, .pitch_rad = column.traction_limit_rad + d_rad(node), .yaw_rad = 0.0};
    const StationState state = solver.solve(stance_on_plane(rover, attitude), soil, command);
    if (!state.moving()) {
      // It slides away down the steepest descents.
      column.last = node - 1;
      continue;
    }
    double* value = &values_[column.begin + static_cast<std::size_t>((node - column.first) * fields_)];
    *value++ = state.along_m_s / speed_m_s_;
    *value++ = state.leftward_m_s / speed_m_s_;
    *value++ = state.attitude.pitch_rad - attitude.pitch_rad;
    *value++ = state.attitude.roll_rad - attitude.roll_rad;
    for (const WheelState& wheel : state.wheels) *value++ = wheel.sinkage_m;
    for (int k = 0; k < wheels_; ++k) *value++ = state.wheels[k].torque_nm + rover.wheels[k].drag_nm;
  }
}

double SlipTable::xi(double d) const {
  return (d + (kB_rad - kA_rad) * std::log1p(d / kA_rad)) / step_rad_;
}

// xi is concave in d: Newton from the left rises to the root.
double SlipTable::d_rad(double at) const {
  double d = 0.0;
  for (int iteration = 0; iteration < 60 && xi(d) < at - 1e-12; ++iteration)
    d += (at - xi(d)) * step_rad_ * (d + kA_rad) / (d + kB_rad);
  return d;
}

SlipTable::Stencil SlipTable::columns_about(double place) const {
  const int nearest = static_cast<int>(std::lround(place));
  const auto goes_on = [&](int from, int to) {
    if (to < 0 || to >= static_cast<int>(columns_.size()) || columns_[to].empty()) return false;
    return std::abs(columns_[to].traction_limit_rad - columns_[from].traction_limit_rad) < kLimitJump_rad;
  };
  if (columns_[nearest].empty()) return {};
  int lowest = nearest, highest = nearest;
  while (lowest > nearest - 3 && goes_on(lowest, lowest - 1)) --lowest;
  while (highest < nearest + 3 && goes_on(highest, highest + 1)) ++highest;
  return Stencil::at(place, lowest, highest);
}

TableEntry SlipTable::entry_of(const double* values, double pitch_rad) const {
  TableEntry entry;
  const double along = values[0], across = values[1];
  entry.slip_ratio = bounded_slip(slip_from_speed_ratio(along));
  entry.side_slip_rad = std::atan2(across, std::abs(along));
  entry.pitch_lean_rad = values[2];
  entry.roll_lean_rad = values[3];
  double power_w = 0.0;
  for (int k = 0; k < wheels_; ++k) {
    entry.sinkage_m = std::max(entry.sinkage_m, values[kMotionFields + k]);
    if (rates_rad_s_[k] == 0.0) continue;
    const MotorState motor = motor_state(drive_, values[kMotionFields + wheels_ + k], rates_rad_s_[k]);
    entry.current_a = std::max(entry.current_a, std::abs(motor.current_a));
    power_w += motor.electric_power_w;
  }
  entry.energy_j_m = power_w / (along * speed_m_s_ * std::cos(pitch_rad));
  return entry;
}

TableEntry SlipTable::entry_on_curve(double pitch_rad, double roll_rad) const {
  const Eigen::Matrix3d R_MB = rotation_MB({.roll_rad = roll_rad, .pitch_rad = pitch_rad, .yaw_rad = 0.0});
  const SlipOnCurve slip = slip_on_curve(*curve_soil_, travel_slopes(R_MB, {}));
  TableEntry entry{.slip_ratio = slip.slip_ratio, .side_slip_rad = slip.side_slip_rad, .by_slip_curve = true};
  entry.immobile = slip.outside || speed_ratio_from_slip(slip.slip_ratio) < kSpinningSpeedRatio;
  if (entry.immobile) entry.slip_ratio = 1.0;
  return entry;
}

std::optional<TableEntry> SlipTable::at(double pitch_rad, double roll_rad) const {
  if (!(std::abs(pitch_rad) <= limit_rad_ && std::abs(roll_rad) <= limit_rad_)) return std::nullopt;
  if (curve_soil_) return entry_on_curve(pitch_rad, roll_rad);
  TableEntry stuck{.slip_ratio = 1.0, .immobile = true};
  const double place = (roll_rad + limit_rad_) / step_rad_;
  const Stencil across = columns_about(place);
  if (across.count == 0) return stuck;
  double limit = 0.0;
  for (int c = 0; c < across.count; ++c)
    limit += across.weight[c] * columns_[across.first + c].traction_limit_rad;
  const double d = std::max(0.0, pitch_rad - limit), at = xi(d);
  std::array<double, kMotionFields + 2 * kMaxWheels> values{};
  for (int c = 0; c < across.count; ++c) {
    const Column& column = columns_[across.first + c];
    const Stencil along = Stencil::at(at, column.first, column.last);
    for (int n = 0; n < along.count; ++n) {
      const double weight = across.weight[c] * along.weight[n];
      const double* node =
          &values_[column.begin + static_cast<std::size_t>(along.first - column.first + n) * fields_];
      for (int f = 0; f < fields_; ++f) values[f] += weight * node[f];
    }
  }
  TableEntry entry = entry_of(values.data(), pitch_rad);
  if (pitch_rad < limit || at > columns_[std::lround(place)].last + 0.5) {
    entry.slip_ratio = 1.0;
    entry.energy_j_m = 0.0;
    entry.immobile = true;
  }
  return entry;
}

}  // namespace slipway::sim
