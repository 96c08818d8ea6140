#pragma once

#include <cstdint>

#include "core/progress.h"
#include "sim/prediction/drawn_drive.h"
#include "sim/prediction/drive_prediction.h"

namespace slipway::sim {

// Conditions one draw, of which `key` is the key, on a drive of the past; see condition_draws().
void condition(const DrawnDriver& driver, std::uint64_t key, const PastDriveReport& report,
               const Progress& progress, ConditionedDraw& draw);

}  // namespace slipway::sim
