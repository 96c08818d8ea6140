#pragma once

#include <string>
#include <vector>

namespace slipway::server {

struct SpiceImportCommand {
  std::vector<std::string> kernels;  // files: positions, attitudes, clock, leap seconds, landing site
  std::string out;                   // file of the steps, "slip-steps/1"
};

// The exit status: 0 the steps are written, 1 they could not be written, 2 a kernel can't be used or has no
// step.
int import_spice(const SpiceImportCommand& options);

}  // namespace slipway::server
