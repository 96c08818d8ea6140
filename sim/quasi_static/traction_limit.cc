#include "sim/quasi_static/traction_limit.h"

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstdint>

#include "core/angle.h"
#include "sim/quasi_static/balance_search.h"
#include "sim/rover/drive_command.h"

namespace slipway::sim {
namespace {

const double kWalk_rad = rad_from_deg(5.0);
const double kNear_rad = rad_from_deg(0.3);
const double kTolerance_rad = rad_from_deg(0.02);

}  // namespace

TractionLimitSearch::TractionLimitSearch(const RoverModel& rover, double gravity_m_s2, const Soil& soil,
                                         const DriveCommand& command, double steepest_climb_rad,
                                         double steepest_descent_rad)
    : rover_(rover),
      soil_(soil),
      command_(command),
      min_pitch_rad_(steepest_climb_rad),
      max_pitch_rad_(steepest_descent_rad),
      solver_(rover, gravity_m_s2) {}

double TractionLimitSearch::surplus(double roll_rad, double pitch_rad) {
  const StationState state =
      solver_.solve(stance_on_plane(rover_, {.roll_rad = roll_rad, .pitch_rad = pitch_rad, .yaw_rad = 0.0}),
                    soil_, command_);
  const double commanded_m_s = command_.speed_m_s * attainable_share(rover_, command_);
  const double surplus =
      state.along_m_s / commanded_m_s - std::hypot(kSpinningSpeedRatio, state.leftward_m_s / commanded_m_s);
  if (state.moving()) return surplus;
  // Just beyond the limit there is still a balance of a rover that slides back. Where there is none, the
  // speed has no meaning.
  return surplus < 0.0 ? std::max(surplus, -1.0) : -1.0;
}

std::optional<TractionLimitSearch::Trial> TractionLimitSearch::find_moving(double roll_rad, double from_rad,
                                                                           double step_rad) {
  for (double pitch = from_rad; pitch >= min_pitch_rad_ && pitch <= max_pitch_rad_; pitch += step_rad) {
    const Trial trial{pitch, surplus(roll_rad, pitch)};
    if (trial.surplus >= 0.0) return trial;
    if (step_rad > 0.0) step_rad = std::min(2.0 * step_rad, kWalk_rad);
  }
  return std::nullopt;
}

std::optional<double> TractionLimitSearch::find(double roll_rad, std::optional<double> guess_rad) {
  // The search begins near the neighbour's limit and goes up from there; without one it begins at the
  // steepest descent.
  const std::optional<Trial> start = guess_rad ? find_moving(roll_rad, *guess_rad + kNear_rad, kNear_rad)
                                               : find_moving(roll_rad, max_pitch_rad_, -kWalk_rad);
  if (!start) return std::nullopt;
  double step = guess_rad ? kNear_rad : kWalk_rad;
  Trial ahead = *start, stuck = *start;
  while (stuck.surplus >= 0.0) {
    ahead = stuck;
    if (ahead.pitch_rad <= min_pitch_rad_) return min_pitch_rad_;
    stuck.pitch_rad = std::max(min_pitch_rad_, ahead.pitch_rad - step);
    stuck.surplus = surplus(roll_rad, stuck.pitch_rad);
    step = std::min(2.0 * step, kWalk_rad);
  }
  std::uintmax_t most = 40;
  const auto close = [](double a, double b) { return std::abs(a - b) < kTolerance_rad; };
  return boost::math::tools::toms748_solve([&](double pitch) { return surplus(roll_rad, pitch); },
                                           stuck.pitch_rad, ahead.pitch_rad, stuck.surplus, ahead.surplus,
                                           close, most)
      .second;
}

}  // namespace slipway::sim
