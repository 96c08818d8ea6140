#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/result.h"
#include "steps/slip_step.h"

namespace slipway::api {

// The steps of a file ("slip-steps/1"), which faults call `name`. Errors: unreadable_data, where it can't be
// read or with every fault.
Result<std::vector<steps::SlipStep>> read_slip_steps_file(const std::filesystem::path& path,
                                                          const std::string& name);

}  // namespace slipway::api
