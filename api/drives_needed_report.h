#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "gap/drives_needed.h"

namespace slipway::api {

// How many drives diagnoses needed, with designed next drives and with random ones.
struct DrivesNeeded {
  std::uint64_t seed = 1;  // of what was drawn
  std::size_t first = 0;   // drives that every run began with
  std::vector<gap::DrivesNeededCase> cases;
};

// A row for each campaign, and the median ratio over them with its interval. Markdown.
std::string drives_needed_report(const DrivesNeeded& needed);

}  // namespace slipway::api
