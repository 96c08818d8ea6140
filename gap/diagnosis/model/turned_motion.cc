#include "gap/diagnosis/model/turned_motion.h"

#include <cmath>
#include <optional>

namespace slipway::gap {

void read_along_turned_heading(const WindowModel& model, std::size_t window, double off_rad,
                               std::vector<double>& predicted) {
  const DriveWindow& of = model.windows()[window];
  if (of.command.turn_in_place) return;
  std::optional<std::size_t> slip, side_slip;  // rows
  for (std::size_t i = 0; i < of.observations.size(); ++i) {
    const std::size_t row = model.offset(window) + i;
    if (!std::isfinite(predicted[row])) continue;
    if (of.observations[i].channel == Channel::kSlip) slip = row;
    if (of.observations[i].channel == Channel::kSideSlip) side_slip = row;
  }
  // In units of the commanded speed.
  const double sense = std::copysign(1.0, of.command.speed_m_s);
  const double along = sense * (slip ? 1.0 - predicted[*slip] : 1.0);
  const double across = side_slip ? predicted[*side_slip] : 0.0;
  const double cosine = std::cos(off_rad), sine = std::sin(off_rad);
  if (slip) predicted[*slip] = 1.0 - sense * (along * cosine + across * sine);
  if (side_slip) predicted[*side_slip] = across * cosine - along * sine;
}

}  // namespace slipway::gap
