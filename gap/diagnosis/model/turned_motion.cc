#include "gap/diagnosis/model/turned_motion.h"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <optional>

#include "sim/rover/drive_command.h"

namespace slipway::gap {

void read_along_turned_heading(const WindowModel& model, std::size_t window, double off_rad,
                               std::vector<double>& predicted) {
  const DriveWindow& of = model.windows()[window];
  if (of.command.turn_in_place) return;
  std::optional<std::size_t> slip, side_slip;  // rows
  double roll = 0.0, pitch = 0.0;
  for (std::size_t i = 0; i < of.observations.size(); ++i) {
    const Observation& o = of.observations[i];
    const std::size_t row = model.offset(window) + i;
    if (o.channel == Channel::kRoll) roll = o.value;
    if (o.channel == Channel::kPitch) pitch = o.value;
    if (!std::isfinite(predicted[row])) continue;
    if (o.channel == Channel::kSlip) slip = row;
    if (o.channel == Channel::kSideSlip) side_slip = row;
  }
  // Along the travel and to its left, in units of the commanded speed; then forward and leftward in the body,
  // and level.
  const double sense = std::copysign(1.0, of.command.speed_m_s);
  const Eigen::Vector2d moved(sense * (slip ? 1.0 - predicted[*slip] : 1.0),
                              side_slip ? predicted[*side_slip] : 0.0);
  const Eigen::Vector2d travel = sim::travel_direction(of.command);
  Eigen::Matrix2d in_body, level;
  in_body << travel.x(), -travel.y(), travel.y(), travel.x();
  level << std::cos(pitch), std::sin(pitch) * std::sin(roll), 0.0, std::cos(roll);
  const Eigen::Matrix2d to_level = level * in_body;
  const Eigen::Vector2d read = to_level.inverse() * (Eigen::Rotation2Dd(-off_rad) * (to_level * moved));
  if (slip) predicted[*slip] = 1.0 - sense * read.x();
  if (side_slip) predicted[*side_slip] = read.y();
}

}  // namespace slipway::gap
