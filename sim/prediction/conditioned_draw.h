#pragma once

#include <cstdint>

#include "core/progress.h"
#include "sim/prediction/drawn_drive.h"
#include "sim/prediction/drive_prediction.h"
#include "sim/prediction/telemetry.h"

namespace slipway::sim {

// Conditions one draw, of which `key` is the key, on a drive of the past; see condition_draws().
void condition(const DrawnDriver& driver, std::uint64_t key, const PastDriveReport& report,
               const Progress& progress, ConditionedDraw& draw);

// Drives a stretch on draws of the ground for what is measured on it. What it is given must outlive it; used
// from several threads.
class StretchDriver {
 public:
  StretchDriver(const RoverModel& rover, double gravity_m_s2, const SoilBeliefs& beliefs,
                const PreparedDrive& drive);

  // On the draw of a key, with cells redrawn; notes the cells that it meets.
  DrawnStretch run(std::uint64_t key, const RedrawnCells& redrawn,
                   std::unordered_set<std::uint64_t>* met) const;

 private:
  const RoverModel& rover_;
  double gravity_m_s2_;
  const SoilBeliefs& beliefs_;
  const PreparedDrive& drive_;
  LevelGroundTest drives_level_;
};

// Conditions one draw on a measured stretch (see condition_on_stretch()), and returns the slip that it had
// there before.
double condition(const StretchDriver& driver, std::uint64_t key, const MeasuredStretch& measured,
                 const TelemetryErrors& errors, int tries, const Progress& progress, ConditionedDraw& draw);

}  // namespace slipway::sim
