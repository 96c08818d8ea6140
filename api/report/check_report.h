#pragma once

#include <string>
#include <string_view>

#include "api/files/catalogue.h"
#include "core/result.h"

namespace slipway::api {

// A "check/1" document as one HTML page to take into a meeting: verdict, reasons and what would change it,
// the rules, the map, charts along the way, stretches, recommended limits, position error, request and
// provenance. It loads nothing and prints on A4. Errors: those of reading the terrain; internal where the
// document is no check.
Result<std::string> check_report(const Catalogue& catalogue, std::string_view answer);

}  // namespace slipway::api
