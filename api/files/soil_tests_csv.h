#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "gap/estimate/soil_observation.h"

namespace slipway::api {

// What a row of wheel tests holds, as column or as key; ranges at the boundary.
struct TestColumn {
  std::string_view name;
  double lowest = 0.0, highest = 0.0;
  bool required = false;      // there, and in every row
  bool above_lowest = false;  // lowest itself is refused
};
// Load, slip ratio and slip angle; then a column for each of a wheel's channels; then each one's deviation.
std::span<const TestColumn> wheel_test_columns();
// The values of these columns as an observation. Faults: a deviation without its reading, nothing measured.
gap::WheelObservation wheel_observation(std::span<const std::optional<double>> values,
                                        std::vector<std::string>& faults);

// Wheel tests, a row each. Columns in any order:
//
//   load_n, slip_ratio                      must be there, in every row
//   slip_angle_deg                          from the wheel's plane to its travel; 0 where absent
//   torque_nm, drawbar_pull_n, thrust_n,    what was measured; a column may be absent and a cell empty, but
//   sinkage_m, current_a, lateral_force_n   one must be there in every row
//   torque_std_nm, drawbar_pull_std_n, ...  their standard deviations
//   wheel, soil                             names of what was tested, where there are several
//
// A lateral force is of the soil on the wheel, positive to the left, as a slip angle is. All faults together,
// each with its file, line and column: "tests.csv, line 5, column 3 (torque_nm)". Errors: unreadable_data.
Result<std::vector<gap::WheelObservation>> read_wheel_tests_csv(std::string_view file, std::string_view text);

// Plate tests, a sample each: plate_radius_m, sinkage_m, and pressure_pa or force_n over the plate's area.
// Samples of one radius that follow each other are one test, and a column `test` tells more of one radius
// apart. Samples at or above the surface are left out.
Result<std::vector<gap::PlateRecord>> read_plate_tests_csv(std::string_view file, std::string_view text);

}  // namespace slipway::api
