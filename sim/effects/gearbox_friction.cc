#include "sim/effects/gearbox_friction.h"

#include <array>

namespace slipway::sim {
namespace {

constexpr std::array kFields{
    Field{"torque_nm", "N m", "dry friction at the wheel", 0.0, 50.0, 0.5, 0.0},
    Field{"viscous_nms_rad", "N m s/rad", "viscous friction at the wheel", 0.0, 100.0, 0.0, 0.0},
    Field{"efficiency_loss", "1", "share of the gear efficiency that is lost", 0.0, 0.9, 0.0, 0.0},
};

void change(std::span<const double> values, RoverModel& rover) {
  DriveMotor& drive = rover.drive;
  drive.gear_friction_nm += values[0];
  drive.gear_viscous_nms_rad += values[1];
  drive.gear_efficiency *= 1.0 - values[2];
}

}  // namespace

constexpr Effect kGearboxFriction{
    .name = "gearbox_friction",
    .summary = "friction in the gearboxes besides what efficiency and no-load current hold",
    .reference = "ROAMS section 2.4 (damping); [Lindemann 2005]",
    .fields = kFields,
    .on_rover = &change};

}  // namespace slipway::sim
