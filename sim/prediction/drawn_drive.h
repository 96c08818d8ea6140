#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/progress.h"
#include "sim/prediction/drawn_ground.h"
#include "sim/prediction/drive_outcome.h"
#include "sim/prediction/drive_risk.h"
#include "sim/prediction/likely_soils.h"

namespace slipway::sim {

// The results of one draw along a drive.
struct DrawnDrive : DrawFigures {
  // Per station that was reached, where they are kept.
  std::vector<float> slip, current_a, sinkage_m, tilt_rad, clearance_m;
  std::vector<float> aside_m;  // way to the side since the last look, positive to the left
  std::vector<bool> bad;       // per station: a limit is broken or the rover is immobilised
  bool immobilised = false;
  // At some station the solver gave up: what it would have found there is not known.
  bool unsolved = false;
  DriveOutcome outcome;
  std::vector<float> shortfall_m;  // at the end of each stretch, see ShortfallFollower
  std::vector<float> drift_m;      // to the left of the path at the end of each stretch, see DriftFollower
  std::vector<float> turned_rad;   // and from its heading there, positive to the left
};

// By the number of the draw.
struct DrawnDrives {
  std::vector<DrawnDrive> all;
};

// How a draw is driven.
struct DrawnRun {
  bool keep_states = false;    // of every station
  bool to_first_stop = false;  // no further than to the first stop or embedding
  const RedrawnCells* redrawn = nullptr;
  std::unordered_set<std::uint64_t>* met = nullptr;  // notes the cells that are met
};

// The ratio of ln(1 - slip), on the real ground over the model's, under a station's wheels: in the mean of
// the logarithm, at the place of the ground's last calls.
double slip_scale(const DrawnGround& ground, const PreparedStation& station);

// The rover comes less far for the same turning of its wheels, or further; its wheels' forces are left.
void scale_slip(double scale, StationState& state);

// Drives a prepared drive on draws of the ground. What it is given must outlive it; used from several
// threads.
class DrawnDriver {
 public:
  // Checks, segments and relief are those of the options.
  DrawnDriver(const RoverModel& rover, double gravity_m_s2, const SoilBeliefs& beliefs,
              const PreparedDrive& drive, const DriveLimits& limits, const RiskOptions& options);

  // On the draw of a key.
  DrawnDrive run(std::uint64_t key, const DrawnRun& how, const Progress& progress) const;

 private:
  // What one run goes on with from station to station.
  struct Run;

  static void drive(const PreparedStation& station, const StationState& state, DrawFigures& figures);
  void add(const PreparedStation& station, const StationState& state, double aside_m, bool keep_states,
           DrawnDrive& drawn) const;
  StationState balance(std::size_t s, const PreparedStation& station, Run& run, DrawnDrive& drawn) const;
  // The station on the drawn relief; nothing where the rover has no stance there.
  std::optional<PreparedStation> on_relief(std::size_t s, const Ground& relief) const;

  const RoverModel& rover_;
  double gravity_m_s2_;
  const SoilBeliefs& beliefs_;
  const PreparedDrive& drive_;
  const DriveLimits& limits_;
  const RiskOptions& options_;
  StationRules station_rules_;
  LevelGroundTest drives_level_;
  std::vector<double> stretch_ends_m_;
  std::vector<BalanceGeometry> geometries_;  // of the stations
};

}  // namespace slipway::sim
