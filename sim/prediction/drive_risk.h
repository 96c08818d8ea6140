#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/progress.h"
#include "sim/prediction/drive_prediction.h"

namespace slipway::sim {

// A station with the stance of the rover on it, which all soil draws of a drive share.
struct PreparedStation {
  Stance stance;
  PerWheel<std::optional<std::size_t>> soil;  // index of the soil under each wheel; empty on unknown ground
  DriveCommand command;
  Pose2 pose;
  double distance_m = 0.0;
  double drive_m = 0.0;   // since the last station
  double turn_rad = 0.0;  // turned in place since the last station, without sign
  // The unknowns of the balance on the mean soils, where the rover moves on them: how they change on the way
  // tells each draw where to look for its own.
  std::optional<RoverBalance::Vector> on_means;
};

// Time for the station's part of the drive and energy spent in it, at the station's balance.
struct Effort {
  double duration_s = 0.0;
  double energy_j = 0.0;
};
Effort effort_of(const PreparedStation& station, const StationState& state);

// The motion as it is commanded, without slip, sinkage or current: where nothing better is known.
StationState undisturbed(const RoverModel& rover, const Stance& stance, const DriveCommand& command);

// The whole path as the draws drive it.
struct PreparedDrive {
  std::vector<PreparedStation> stations;  // to the path's end, or to where the rover has no stance
  const Ground* ground = nullptr;         // under the stations
  bool without_stance = false;            // the path goes on where no stance is possible
};

// The ends of the drive's stretches: of equal length, 10 m or more, at most 100. There must be a station.
std::vector<double> stretch_ends_m(const std::vector<PreparedStation>& stations);

// Each draw of the ground along the drive; empty where it was cancelled.
std::vector<DrawnOutcome> outcomes_of_draws(const RoverModel& rover, double gravity_m_s2,
                                            const SoilBeliefs& beliefs, const PreparedDrive& drive,
                                            const DriveLimits& limits, const RiskOptions& options,
                                            std::size_t threads, Progress& progress);

// Fills the prediction's fields over soil draws (risk, outcomes, intervals, quantiles per station). Returns
// false where it was cancelled. Goes on from the draws so far, where they are given, and adds its own to
// them.
bool assess_risk(const RoverModel& rover, double gravity_m_s2, const SoilBeliefs& beliefs,
                 const PreparedDrive& drive, const DriveLimits& limits, const RiskOptions& options,
                 std::size_t threads, Progress& progress, DrivePrediction& prediction,
                 DrawsSoFar* so_far = nullptr);

}  // namespace slipway::sim
