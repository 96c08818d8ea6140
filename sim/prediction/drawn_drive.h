#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/progress.h"
#include "sim/prediction/drive_outcome.h"
#include "sim/prediction/drive_risk.h"

namespace slipway::sim {

// The results of one draw along a drive.
struct DrawnDrive {
  double weight = 1.0;
  std::vector<float> slip, current_a, sinkage_m;  // per station that was reached, where they are kept
  std::vector<bool> bad;  // per station: a limit is broken or the rover is immobilised
  bool any_bad = false;
  bool immobilised = false;
  double duration_s = 0.0, energy_j = 0.0;
  double length_m = 0.0, slip_length_m = 0.0;  // driven, and the slip's magnitude summed over it
  DriveOutcome outcome;

  double mean_slip_ratio() const { return length_m > 0.0 ? slip_length_m / length_m : 0.0; }
};

// Drives a prepared drive on draws of the ground. What it is given must outlive it; used from several
// threads.
class DrawnDriver {
 public:
  DrawnDriver(const RoverModel& rover, double gravity_m_s2, const SoilBeliefs& beliefs,
              const PreparedDrive& drive, const DriveLimits& limits, const SlipChecks& checks);

  DrawnDrive run(std::uint64_t key, bool keep_states, const Progress& progress) const;

 private:
  bool drives_level(const Soil& soil) const;
  void add(const PreparedStation& station, const StationState& state, bool keep_states,
           DrawnDrive& drawn) const;

  const RoverModel& rover_;
  double gravity_m_s2_;
  const SoilBeliefs& beliefs_;
  const PreparedDrive& drive_;
  const DriveLimits& limits_;
  const SlipChecks& checks_;
  std::optional<Stance> level_;
};

}  // namespace slipway::sim
