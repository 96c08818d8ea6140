#pragma once

#include <string>

#include "server/cli/inquiry/ask_options.h"

namespace slipway::server {

// What differs between soils, from the tests of several.
struct BeliefCommand {
  AskOptions ask;
  std::string file;  // "soil-belief/1"
};

// The exit status: 0 a belief, 1 none, 2 input that can't be read.
int believe(const BeliefCommand& options);

}  // namespace slipway::server
