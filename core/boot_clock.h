#pragma once

#include <cstdint>
#include <string>

namespace slipway {

// Milliseconds since the machine was started, those in which it slept too (CLOCK_BOOTTIME). Nobody can set
// this clock, and all processes of a machine read the same.
std::int64_t boot_ms();

// The name of this start of the machine, new at each; empty where the system does not tell it.
std::string boot_id();

}  // namespace slipway
