#include "sim/effects/gearbox_friction.h"

#include <array>

namespace slipway::sim {
namespace {

constexpr std::array kFields{
    Field{"torque_nm", "N m", "dry friction, as a torque at the wheel", 0.0, 50.0, 0.5, 0.0},
    Field{"viscous_nms_rad", "N m s/rad", "viscous friction, as a torque at the wheel per wheel rate", 0.0,
          100.0, 0.0, 0.0},
    Field{"efficiency_loss", "1", "share of the gear efficiency that is lost", 0.0, 0.9, 0.0, 0.0},
};

void change(std::span<const double> values, RoverModel& rover) {
  DriveMotor& drive = rover.drive;
  drive.gear_friction_nm += values[0];
  drive.gear_viscous_nms_rad += values[1];
  drive.gear_efficiency *= 1.0 - values[2];
}

std::vector<EffectVariant> variants(const RoverModel& /*rover*/) {
  return {{.free = {free_field(kFields, "torque_nm", 0.5), free_field(kFields, "efficiency_loss", 0.1)}}};
}

EffectParameters hidden(const HiddenDraw& draw) {
  return {{"torque_nm", 0.5 * draw.size}};
}

}  // namespace

constexpr Effect kGearboxFriction{
    .name = "gearbox_friction",
    .summary =
        "the gearboxes have friction beyond what the rover file's efficiency and no-load current include",
    .reference = "ROAMS section 2.4 (damping); [Lindemann 2005]",
    .fields = kFields,
    .on_rover = &change,
    .variants = &variants,
    .has_many_forms = true,
    .hidden = &hidden};

}  // namespace slipway::sim
