#include "steps/plane_slips.h"

#include <algorithm>
#include <cmath>

#include "core/angle.h"
#include "sim/quasi_static/quasi_static.h"
#include "sim/rover/stance.h"

namespace slipway::steps {
namespace {

constexpr double kSteepest_deg = 30.0, kPitchSpacing_deg = 2.0, kRollSpacing_deg = 10.0;

// The node below a value and how far the value is on the way to the next, both within the table.
struct Between {
  std::size_t below;
  double share;
};
Between between(double nodes, std::size_t count) {
  const double within = std::clamp(nodes, 0.0, static_cast<double>(count - 1));
  const auto below = std::min(static_cast<std::size_t>(within), count - 2);
  return {below, within - static_cast<double>(below)};
}

}  // namespace

PlaneSlips::PlaneSlips(const sim::RoverModel& rover, double gravity_m_s2, const sim::Soil& soil) {
  sim::QuasiStaticSolver solver(rover, gravity_m_s2, sim::Precision::kDraws);
  const sim::DriveCommand command{.speed_m_s = rover.cruise_speed_m_s};
  for (std::size_t r = 0; r < kRolls; ++r) {
    for (std::size_t p = 0; p < kPitches; ++p) {
      const double pitch_deg = kPitchSpacing_deg * static_cast<double>(p) - kSteepest_deg;
      // A positive pitch of an attitude is nose down.
      const sim::Stance stance =
          sim::stance_on_plane(rover, {.roll_rad = rad_from_deg(kRollSpacing_deg * static_cast<double>(r)),
                                       .pitch_rad = rad_from_deg(-pitch_deg),
                                       .yaw_rad = 0.0});
      const sim::StationState state = solver.solve(stance, soil, command);
      slips_[r][p] = state.moving() ? std::min(sim::measured_slip(state, command), 1.0) : 1.0;
    }
  }
}

double PlaneSlips::at(double pitch_rad, double roll_rad) const {
  const Between p = between((deg_from_rad(pitch_rad) + kSteepest_deg) / kPitchSpacing_deg, kPitches);
  const Between r = between(std::abs(deg_from_rad(roll_rad)) / kRollSpacing_deg, kRolls);
  const auto at_roll = [&](std::size_t row) {
    return (1.0 - p.share) * slips_[row][p.below] + p.share * slips_[row][p.below + 1];
  };
  return (1.0 - r.share) * at_roll(r.below) + r.share * at_roll(r.below + 1);
}

}  // namespace slipway::steps
