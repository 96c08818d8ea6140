#include "sim/wheel/sliced_wheel.h"

#include <algorithm>
#include <stdexcept>

#include "sim/wheel/wheel_kernel.h"

namespace slipway::sim {

double slice_offset_m(double width_m, int slice, int slices) {
  return width_m * ((slice + 0.5) / slices - 0.5);
}

SlicedWheelForces sliced_wheel_forces(const WheelGeometry& wheel, const Soil& soil,
                                      std::span<const double> ground_height_m, double sinkage_m,
                                      const WheelMotion& motion) {
  const int slices = static_cast<int>(ground_height_m.size());
  if (slices < 1 || slices > kMaxSlices) throw std::invalid_argument("sliced_wheel_forces: 1 to 9 slices");
  const int leading = motion.leftward > 0.0 ? slices - 1 : 0;
  // The stiffness is that under the whole width.
  WheelNumbers slice = numbers_of(wheel, soil, 0.0, motion);
  slice.width /= slices;
  SlicedWheelForces out;
  std::array<WheelNumbers, kMaxSlices> numbers;
  std::array<WheelForces, kMaxSlices> forces;
  std::array<int, kMaxSlices> of;
  std::size_t count = 0;
  for (int s = 0; s < slices; ++s) {
    const double depth = sinkage_m + ground_height_m[s];
    if (depth <= 0.0) continue;
    slice.theta_f = std::min(entry_angle_rad(wheel.radius_m, depth), kMaxEntryAngleRad);
    numbers[count] = slice;
    if (s != leading) numbers[count].side_bulldozing = numbers[count].closures.plough_wall = 0.0;
    out.slices[s].entry_angle_rad = slice.theta_f;
    out.slices[s].exit_angle_rad = -soil.exit_angle_ratio * slice.theta_f;
    of[count++] = s;
  }
  wheel_forces({numbers.data(), count}, {forces.data(), count});
  for (std::size_t n = 0; n < count; ++n) {
    const WheelForces& f = forces[n];
    out.total.drawbar_pull_n += f.drawbar_pull_n;
    out.total.lateral_n += f.lateral_n;
    out.total.vertical_n += f.vertical_n;
    out.total.torque_nm += f.torque_nm;
    out.overturning_nm += slice_offset_m(wheel.width_m, of[n], slices) * f.vertical_n;
    out.slices[of[n]].vertical_n = f.vertical_n;
  }
  return out;
}

}  // namespace slipway::sim
