#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "steps/slip_step.h"

namespace slipway::steps {

inline constexpr std::size_t kMaxSteps = 1'000'000;

// The slip range of a step; what lies outside is no slip but another move.
inline constexpr double kLowestSlip = -1.0;
inline constexpr double kHighestSlip = 1.5;

// A table of steps, "slip-steps/1", see docs/reference/slip_steps.md: a CSV with a header, before which a
// line
// "# slip-steps/1" may stand. Errors: unreadable_data with the first 20 faults, each with its line and
// column.
Result<std::vector<SlipStep>> read_slip_steps(std::string_view text, std::string_view file);

// The steps as such a table, in the resolution that the columns have there: 0.1 mm of odometry, 0.0001 of
// slip, 0.01 deg. The columns of maps and of sols' mean pitches are there only where some step has them.
std::string write_slip_steps(std::span<const SlipStep> steps);

}  // namespace slipway::steps
