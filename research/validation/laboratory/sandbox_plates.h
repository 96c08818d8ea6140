#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/result.h"
#include "gap/estimate/plate_sinkage.h"

namespace slipway::validation {

// One of the nine plate tests in the sand of the single-wheel tests [Pavlov & Johnson 2022].
struct SandboxTest {
  std::string name;
  gap::PlateRecord plate;
};

// Errors: unreadable_data.
Result<std::vector<SandboxTest>> load_sandbox_plates(const std::filesystem::path& csv);

}  // namespace slipway::validation
