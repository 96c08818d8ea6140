#pragma once

#include <string>
#include <vector>

#include "api/json/json_value.h"

namespace slipway::api::json {

// Adds to a soil of a soils/1 what it leaves out and few tests measure, with the values of the shipped sands:
// a bevameter gives k_c, k_phi, n, cohesion and friction angle, and often no more. K of an unknown sand may
// be half or twice as large, so that draws differ more and a slip that is predicted with it is no surer than
// one of a soil that nobody tested. A slip curve stays as it is. The answer has what was added, each in
// words, for the soil's `assumed`.
std::vector<std::string> give_what_is_assumed(JsonValue& soil);

}  // namespace slipway::api::json
