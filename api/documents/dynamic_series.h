#pragma once

#include "api/json/writer.h"
#include "planner/problem/dynamic_verification.h"

namespace slipway::api::json {

// "dynamic": a drive at the dynamic level, its figures alone.
void write_dynamic_figures(Writer& w, const planner::DynamicVerification& dynamic);

// The same with its events and samples, one array per quantity and one element per sample.
void write_dynamic_drive(Writer& w, const planner::DynamicVerification& dynamic);

}  // namespace slipway::api::json
