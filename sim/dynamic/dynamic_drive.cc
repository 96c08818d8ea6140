#include "sim/dynamic/dynamic_drive.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sim/dynamic/drive_simulation.h"
#include "sim/dynamic/ground_with_laws.h"
#include "sim/rover/stance.h"

namespace slipway::sim {
namespace {

Result<DynamicDrive> simulate_drive_on(const RoverModel& rover, double gravity_m_s2, const Ground& ground,
                                       const DriveSoils& soils, const Pose2& start,
                                       std::span<const DriveLeg> legs, const DynamicOptions& options,
                                       const DriveSink& sink, Progress& progress) {
  const double c = std::cos(start.yaw_rad), s = std::sin(start.yaw_rad);
  for (const WheelModel& wheel : rover.wheels) {
    const double x = start.x_m + c * wheel.position_m.x() - s * wheel.position_m.y();
    const double y = start.y_m + s * wheel.position_m.x() + c * wheel.position_m.y();
    if (!ground.at(x, y))
      return fail(
          ErrorCode::kNoData,
          fmt::format("no elevation under wheel {} at the start, ({:.2f}, {:.2f}) m", wheel.name, x, y));
  }
  const std::optional<Stance> stance = settle(rover, ground, start);
  if (!stance)
    return fail(ErrorCode::kInvalidRequest,
                "the suspension can't stand at the start: the ground is too uneven",
                {{"/start", fmt::format("no stance at ({:.2f}, {:.2f}) m", start.x_m, start.y_m)}});
  DriveSimulation drive(rover, gravity_m_s2, ground, soils, legs, options, sink, progress);
  return drive.run(*stance);
}

// Drives as far as the ground has soils with laws.
Result<DynamicDrive> simulate_drive_beside_slip_curves(const RoverModel& rover, double gravity_m_s2,
                                                       const Ground& ground, const DriveSoils& soils,
                                                       const Pose2& start, std::span<const DriveLeg> legs,
                                                       const DynamicOptions& options, const DriveSink& sink,
                                                       Progress& progress) {
  const double c = std::cos(start.yaw_rad), s = std::sin(start.yaw_rad);
  for (const WheelModel& wheel : rover.wheels) {
    const Eigen::Vector2d p(start.x_m + c * wheel.position_m.x() - s * wheel.position_m.y(),
                            start.y_m + s * wheel.position_m.x() + c * wheel.position_m.y());
    if (on_slip_curve(ground, soils, p.x(), p.y()))
      return fail(ErrorCode::kInvalidRequest, slip_curve_reason(p), {{"/start", slip_curve_reason(p)}});
  }
  return simulate_drive_on(rover, gravity_m_s2, GroundWithLaws(ground, soils), soils, start, legs, options,
                           sink, progress);
}

}  // namespace

Result<DynamicDrive> simulate_drive(const RoverModel& rover, double gravity_m_s2, const Ground& ground,
                                    const DriveSoils& soils, const Pose2& start,
                                    std::span<const DriveLeg> legs, const DynamicOptions& options,
                                    const DriveSink& sink, Progress& progress) {
  if (auto faults = faults_of(legs, options); !faults.empty())
    return fail(ErrorCode::kInvalidRequest, "the drive can't be simulated", std::move(faults));
  const auto has_curve = [](const Soil& soil) { return soil.slip_curve != nullptr; };
  if (std::any_of(soils.known.begin(), soils.known.end(), has_curve) || has_curve(soils.unknown))
    return simulate_drive_beside_slip_curves(rover, gravity_m_s2, ground, soils, start, legs, options, sink,
                                             progress);
  return simulate_drive_on(rover, gravity_m_s2, ground, soils, start, legs, options, sink, progress);
}

}  // namespace slipway::sim
