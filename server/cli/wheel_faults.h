#pragma once

#include <vector>

#include "core/result.h"
#include "server/cli/wheel_command.h"
#include "sim/single_wheel/wheel_sweep.h"

namespace slipway::server {

// Flags of which one would take another's place without a word: a number that is given by its own flag, by
// --set, by --sweep or --rows, or by an effect more than once, and a slip beside a slope. `rows` are the
// columns of --rows. Pointers are the flags: "/slip", "/set/soil.n", "/effect".
std::vector<Fault> dropped_flags(const WheelOptions& options, const std::vector<sim::SweepAxis>& rows);

}  // namespace slipway::server
