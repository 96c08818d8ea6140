#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "research/benchmark/drives_needed.h"

namespace slipway::api {

// A row for each campaign, and the median ratio over them with its interval. Markdown.
std::string drives_needed_report(const gap::DrivesNeeded& needed);

}  // namespace slipway::api
