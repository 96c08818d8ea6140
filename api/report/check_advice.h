#pragma once

#include <string>
#include <vector>

#include "api/json/json_value.h"

namespace slipway::api {

// What would change the verdict of a "check/1" document, in words and numbers of its draws: the stretch to
// avoid or to drive with more frequent checks, the limit that fewer draws would pass, the ground to map, the
// draws to take. Of a GO: what comes nearest to a limit. What a changed limit does to the verdict only
// another check can tell.
std::vector<std::string> check_advice(const json::JsonValue& check);

// What a scout drive onto the ground that decides would be worth, in words: of the "outcomes" of a check or
// of a plan's route. Empty where no ground decides.
std::string scout_words(const json::JsonValue& outcomes);

}  // namespace slipway::api
