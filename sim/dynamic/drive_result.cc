#include "sim/dynamic/drive_result.h"

#include <cmath>

namespace slipway::sim {

std::string_view describe(DriveEnd end) {
  switch (end) {
    case DriveEnd::kFinished:
      return "finished";
    case DriveEnd::kImmobilised:
      return "immobilised";
    case DriveEnd::kTipped:
      return "tipped";
    case DriveEnd::kSunkToAxle:
      return "sunk_to_axle";
    case DriveEnd::kSlid:
      return "slid";
  }
  return "unknown";
}

std::string_view describe(DriveEventKind kind) {
  switch (kind) {
    case DriveEventKind::kLegEnds:
      return "leg_ends";
    case DriveEventKind::kLiftOff:
      return "lift_off";
    case DriveEventKind::kTouchDown:
      return "touch_down";
    case DriveEventKind::kStall:
      return "stall";
    case DriveEventKind::kStallEnds:
      return "stall_ends";
    case DriveEventKind::kJointStop:
      return "joint_stop";
  }
  return "unknown";
}

double final_slip_ratio(const DynamicDrive& drive) {
  if (drive.commanded_m <= 0.0) return 0.0;
  return std::hypot(drive.final.x_m - drive.commanded.x_m, drive.final.y_m - drive.commanded.y_m) /
         drive.commanded_m;
}

}  // namespace slipway::sim
