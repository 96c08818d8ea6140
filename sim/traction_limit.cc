#include "sim/traction_limit.h"

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstdint>

#include "core/angle.h"
#include "sim/balance_search.h"
#include "sim/drive_command.h"

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
      lowest_rad_(steepest_climb_rad),
      highest_rad_(steepest_descent_rad),
      solver_(rover, gravity_m_s2) {}

double TractionLimitSearch::surplus(double roll_rad, double pitch_rad) {
  const StationState state =
      solver_.solve(stance_on_plane(rover_, {.roll_rad = roll_rad, .pitch_rad = pitch_rad, .yaw_rad = 0.0}),
                    soil_, command_);
  const double ratio =
      state.along_m_s / (command_.speed_m_s * attainable_share(rover_, command_)) - kSpinningSpeedRatio;
  if (state.moving()) return std::max(ratio, 0.0);
  // Just beyond the limit the balance goes on, of a rover that slides back; elsewhere its speed says nothing.
  return ratio < -1e-6 ? std::max(ratio, -1.0) : -1.0;
}

std::optional<double> TractionLimitSearch::moving_pitch(double roll_rad, double from_rad, double step_rad) {
  for (double pitch = from_rad; pitch >= lowest_rad_ && pitch <= highest_rad_; pitch += step_rad) {
    if (surplus(roll_rad, pitch) >= 0.0) return pitch;
    if (step_rad > 0.0) step_rad = std::min(2.0 * step_rad, kWalk_rad);
  }
  return std::nullopt;
}

std::optional<double> TractionLimitSearch::find(double roll_rad, std::optional<double> guess_rad) {
  // Near a neighbour's limit first, upwards from there; without one from the steepest descent down.
  std::optional<double> moving = guess_rad ? moving_pitch(roll_rad, *guess_rad + kNear_rad, kNear_rad)
                                           : moving_pitch(roll_rad, highest_rad_, -kWalk_rad);
  if (!moving) return std::nullopt;
  double step = guess_rad ? kNear_rad : kWalk_rad, still = *moving;
  double speed = 0.0, beyond = 0.0;
  for (double pitch = *moving;;) {
    if (pitch <= lowest_rad_) return lowest_rad_;
    pitch = std::max(lowest_rad_, pitch - step);
    beyond = surplus(roll_rad, pitch);
    if (beyond < 0.0) {
      *moving = pitch;
      break;
    }
    still = pitch;
    step = std::min(2.0 * step, kWalk_rad);
  }
  speed = surplus(roll_rad, still);
  std::uintmax_t most = 40;
  const auto close = [](double a, double b) { return std::abs(a - b) < kTolerance_rad; };
  const auto [below, above] = boost::math::tools::toms748_solve(
      [&](double pitch) { return surplus(roll_rad, pitch); }, *moving, still, beyond, speed, close, most);
  return above;
}

}  // namespace slipway::sim
