#pragma once

#include <string>

#include "api/json/json_value.h"

namespace slipway::api::json {

// The document of an object with the members of another laid over it: what both have is that of `over`, but
// members that are objects in both are laid over each other in turn.
std::string laid_over(const JsonValue& base, const JsonValue& over);

}  // namespace slipway::api::json
