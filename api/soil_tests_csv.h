#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "gap/soil_observation.h"

namespace slipway::api {

// Wheel tests, a row each. Columns in any order:
//
//   load_n, slip_ratio                      must be there, in every row
//   slip_angle_deg                          from the wheel's plane to its travel; 0 where absent
//   torque_nm, drawbar_pull_n, thrust_n,    what was measured; a column may be absent and a cell empty, but
//   sinkage_m, current_a                    one must be there in every row
//   torque_std_nm, drawbar_pull_std_n, ...  their standard deviations
//
// Slip is compared with the speed along the wheel's plane. All faults together, each with its file, line and
// column: "tests.csv, line 5, column 3 (torque_nm)". Errors: unreadable_data.
Result<std::vector<gap::WheelObservation>> read_wheel_tests_csv(std::string_view file, std::string_view text);

// Plate tests, a sample each: plate_radius_m, sinkage_m, and pressure_pa or force_n over the plate's area.
// Samples of one radius that follow each other are one test, and a column `test` tells more of one radius
// apart. Samples at or above the surface are left out.
Result<std::vector<gap::PlateTest>> read_plate_tests_csv(std::string_view file, std::string_view text);

}  // namespace slipway::api
