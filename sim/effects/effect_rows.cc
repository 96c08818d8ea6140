#include <array>

#include "sim/effects/attitude_bias.h"
#include "sim/effects/bulldozing.h"
#include "sim/effects/cleat_shear_radius.h"
#include "sim/effects/com_offset.h"
#include "sim/effects/digging.h"
#include "sim/effects/dragging_wheel.h"
#include "sim/effects/duricrust.h"
#include "sim/effects/effect_catalogue.h"
#include "sim/effects/gearbox_friction.h"
#include "sim/effects/grousers.h"
#include "sim/effects/hardpan.h"
#include "sim/effects/inclined_load.h"
#include "sim/effects/motor_temperature.h"
#include "sim/effects/multipass.h"
#include "sim/effects/ploughing.h"
#include "sim/effects/rate_shear.h"
#include "sim/effects/side_bulldozing.h"
#include "sim/effects/slip_directed_shear.h"
#include "sim/effects/slip_sinkage.h"
#include "sim/effects/smooth_rim.h"
#include "sim/effects/soft_patch.h"
#include "sim/effects/soil_gravity.h"
#include "sim/effects/steering_offset.h"
#include "sim/effects/wheel_radius.h"

namespace slipway::sim {

// The effects in the order in which they are applied: the list that a new row is added to. Nothing else
// stands in this file, so that a test can link a catalogue of its own.
std::span<const Effect> effect_catalogue() {
  static const std::array kRows{kSlipSinkage,    kMultipass,        kGrousers,          kBulldozing,
                                kSideBulldozing, kComOffset,        kMotorTemperature,  kGearboxFriction,
                                kWheelRadius,    kDraggingWheel,    kRateShear,         kDuricrust,
                                kHardpan,        kSoftPatch,        kSteeringOffset,    kAttitudeBias,
                                kSoilGravity,    kCleatShearRadius, kSlipDirectedShear, kInclinedLoad,
                                kDigging,        kPloughing,        kSmoothRim};
  return kRows;
}

}  // namespace slipway::sim
