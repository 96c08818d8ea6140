#pragma once

#include <string>

#include "research/benchmark/drives_needed.h"

namespace slipway::api::json {

// "drives-needed/1": what drives_needed_report says. A number of drives that was not found is absent (of
// designed) or null (of a random run).
std::string drives_needed_document(const gap::DrivesNeeded& needed);

}  // namespace slipway::api::json
