#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/result.h"

namespace CLI {
class App;
}

namespace slipway::server {

struct ValidateOptions {
  std::string data;
  std::vector<std::string> only;  // names of comparisons; empty: all
  std::string plots;              // folder for one SVG per comparison; empty: none
  std::string check;              // page whose printed part must be what comes out; empty: none
  std::string write;              // page whose printed part is replaced; empty: none
  bool json = false;
  bool list = false;
};

// The exit status: 0 every stated band holds (and the page is as it should be), 1 one does not, 2 unknown
// comparisons.
int validate(const ValidateOptions& options);

// Puts what was printed into the page `write`, where there is one; otherwise whether the page `check`, where
// there is one, holds it, and says on standard error by which command it would.
Result<bool> settle_page(const std::string& write, const std::string& check, const std::string& printed,
                         const std::string& command);

// Adds the subcommand; `run` then runs it where it is given.
void add_validate_command(CLI::App& app, std::function<int()>& run);

}  // namespace slipway::server
