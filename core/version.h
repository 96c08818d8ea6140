#pragma once

#include <string_view>

namespace slipway {

// The version of the program, as in provenance, /healthz and `slipway --version`.
std::string_view version();

}  // namespace slipway
