#include "research/validation/cuadriga/cuadriga_model.h"

#include <algorithm>
#include <cmath>

#include "core/angle.h"
#include "sim/quasi_static/quasi_static.h"

namespace slipway::validation {
namespace {

constexpr double kGravity_m_s2 = 9.81;
constexpr double kSpeed_m_s =
    0.5;  // of all drives; without an effect of rate it changes neither slip nor torque

// The commanded curvatures; the table ends at the first that is too sharp for the rover. On steep ground none
// is used, since a search that fails takes a hundred times as long as one that succeeds.
constexpr double kCurvatures_1_m[] = {0.0, 0.15, 0.3, 0.5};
constexpr double kSteepestTurn_deg = 12.0;

std::optional<ClimbState> state_at(sim::QuasiStaticSolver& solver, const sim::Stance& stance,
                                   const sim::Soil& soil, double curvature_1_m) {
  sim::DriveCommand command;
  command.speed_m_s = kSpeed_m_s;
  command.curvature_1_m = curvature_1_m;
  const sim::StationState state = solver.solve(stance, soil, command);
  if (!state.moving()) return std::nullopt;
  ClimbState climb{state.slip_ratio, state.yaw_rate_rad_s, sim::PerWheel<double>(state.wheels.size())};
  for (std::size_t k = 0; k < state.wheels.size(); ++k) climb.torque_nm[k] = state.wheels[k].torque_nm;
  return climb;
}

sim::Stance stance_at(const sim::RoverModel& rover, double gradient_rad) {
  Attitude attitude;
  attitude.pitch_rad = -gradient_rad;
  return sim::stance_on_plane(rover, attitude);
}

void add(double weight, const ClimbState& other, ClimbState& state) {
  state.slip_ratio += weight * other.slip_ratio;
  state.turn_rate_rad_s += weight * other.turn_rate_rad_s;
  for (std::size_t k = 0; k < state.torque_nm.size(); ++k) state.torque_nm[k] += weight * other.torque_nm[k];
}

ClimbState nothing_of(std::size_t wheels) {
  return {0.0, 0.0, sim::PerWheel<double>(wheels, 0.0)};
}

// Where only the straight drive was solved, a turn adds the same as at the gradient `like`.
void add_turns(const std::vector<ClimbState>& like, std::vector<ClimbState>& turns) {
  const ClimbState straight = turns.front();
  for (std::size_t k = 1; k < like.size(); ++k) {
    ClimbState turning = straight;
    add(1.0, like[k], turning);
    add(-1.0, like.front(), turning);
    turns.push_back(turning);
  }
}

ClimbState at_turn(const std::vector<ClimbState>& turns, double turn_rate_rad_s) {
  const double rate = std::abs(turn_rate_rad_s);
  std::size_t above = 1;
  while (above < turns.size() && turns[above].turn_rate_rad_s < rate) ++above;
  if (above == turns.size()) return turns.back();
  const ClimbState &low = turns[above - 1], &high = turns[above];
  const double part =
      std::max(0.0, (rate - low.turn_rate_rad_s) / (high.turn_rate_rad_s - low.turn_rate_rad_s));
  ClimbState state = nothing_of(low.torque_nm.size());
  add(1.0 - part, low, state);
  add(part, high, state);
  return state;
}

// The motors are among the fitted parameters, so that those of the shipped file must not stall the rover
// here.
sim::RoverModel without_limits(const sim::RoverModel& rover) {
  sim::RoverModel free = rover;
  free.drive.bus_voltage_v = 1e6;
  free.drive.max_current_a.reset();
  return free;
}

}  // namespace

sim::Soil ground_of(const CuadrigaParameters& parameters) {
  sim::Soil soil;
  soil.pressure = {0.0, parameters.k_phi, 1.0};
  soil.cohesion_pa = 1000.0;
  soil.friction_angle_rad = parameters.friction_angle_rad;
  soil.shear_modulus_x_m = soil.shear_modulus_y_m = parameters.shear_modulus_m;
  soil.density_kg_m3 = 1500.0;
  soil.c1 = 0.18;
  soil.c2 = 0.32;
  soil.shear_coupling = 1.0;
  soil.gravity_m_s2 = kGravity_m_s2;
  return soil;
}

std::optional<ClimbTable> ClimbTable::tabulate(const sim::RoverModel& rover, const sim::Soil& soil) {
  const sim::RoverModel free = without_limits(rover);
  sim::QuasiStaticSolver solver(free, kGravity_m_s2);
  ClimbTable table;
  const auto last = static_cast<int>(std::lround((kMaxGradient_deg - kMinGradient_deg) / kStep_deg));
  // The steepest gradient comes first, so that a soil that does not carry the rover there costs one solve.
  for (int k = last; k >= 0; --k) {
    const double gradient_deg = kMinGradient_deg + k * kStep_deg;
    const sim::Stance stance = stance_at(free, rad_from_deg(gradient_deg));
    std::vector<ClimbState> turns;
    for (const double curvature : kCurvatures_1_m) {
      if (curvature > 0.0 && std::abs(gradient_deg) > kSteepestTurn_deg) break;
      const auto state = state_at(solver, stance, soil, curvature);
      if (!state || (!turns.empty() && state->turn_rate_rad_s <= turns.back().turn_rate_rad_s)) break;
      turns.push_back(*state);
    }
    if (turns.empty()) return std::nullopt;
    table.stations_.push_back(std::move(turns));
  }
  std::reverse(table.stations_.begin(), table.stations_.end());
  const auto turns_at = [](int k) { return std::abs(kMinGradient_deg + k * kStep_deg) <= kSteepestTurn_deg; };
  int lowest = 0, highest = last;
  while (!turns_at(lowest)) ++lowest;
  while (!turns_at(highest)) --highest;
  for (int k = 0; k <= last; ++k)
    if (!turns_at(k))
      add_turns(table.stations_[static_cast<std::size_t>(std::clamp(k, lowest, highest))],
                table.stations_[static_cast<std::size_t>(k)]);
  return table;
}

ClimbState ClimbTable::at(const ClimbConditions& conditions) const {
  const double place = (deg_from_rad(conditions.gradient_rad) - kMinGradient_deg) / kStep_deg;
  const int last = static_cast<int>(stations_.size()) - 1;
  const int first = std::clamp(static_cast<int>(std::floor(place)) - 1, 0, last - 3);
  ClimbState state = nothing_of(stations_.front().front().torque_nm.size());
  for (int k = first; k < first + 4; ++k) {
    double weight = 1.0;  // Lagrange's
    for (int other = first; other < first + 4; ++other)
      if (other != k) weight *= (place - other) / (k - other);
    add(weight, at_turn(stations_[static_cast<std::size_t>(k)], conditions.turn_rate_rad_s), state);
  }
  return state;
}

std::optional<ClimbState> solve_climb(const sim::RoverModel& rover, const sim::Soil& soil,
                                      double gradient_rad, double curvature_1_m) {
  const sim::RoverModel free = without_limits(rover);
  sim::QuasiStaticSolver solver(free, kGravity_m_s2);
  return state_at(solver, stance_at(free, gradient_rad), soil, curvature_1_m);
}

double current_of(const CuadrigaParameters& parameters, const ClimbState& state) {
  double torque = 0.0;
  for (const double wheel : state.torque_nm)
    torque += (wheel < 0.0 ? parameters.returned_share : 1.0) * wheel;
  return parameters.idle_current_a + torque / parameters.torque_per_ampere_nm;
}

double CuadrigaModel::slip(const ClimbConditions& conditions) const {
  return 1.0 - (1.0 - table_.at(conditions).slip_ratio) / (1.0 - level_slip_);
}

double CuadrigaModel::current_a(const ClimbConditions& conditions) const {
  return current_of(parameters_, table_.at(conditions));
}

double CuadrigaModel::charge_per_metre_as(const ClimbConditions& conditions, double wheel_speed_m_s) const {
  return current_a(conditions) / (wheel_speed_m_s * (1.0 - slip(conditions)));
}

}  // namespace slipway::validation
