#pragma once

#include <string>
#include <string_view>

namespace slipway {

// The version of the program, as in provenance, /healthz and `slipway --version`.
std::string_view version();

// The linker's digest of the program that runs (its build id), in hexadecimal: two builds of one version
// differ in it. The version where the program was linked without one.
const std::string& build_id();

}  // namespace slipway
