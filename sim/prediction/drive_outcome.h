#pragma once

#include <array>
#include <optional>
#include <vector>

#include "sim/prediction/drive_limits.h"
#include "sim/prediction/drive_risk.h"

namespace slipway::sim {

// What one drive did to one rule: the value that came nearest to its limit, and the part of the way where the
// rule tripped.
struct RuleTrace {
  double value = 0.0;  // slip, rad, A, m, m; of embedding the sinkage as a share of the wheel's radius, or 1
  std::size_t station = 0;  // where that value was met
  int wheel = -1;           // whose value it is; -1 where it is the rover's
  bool tripped = false;
  double first_m = 0.0, last_m = 0.0;  // where it tripped, along the way; only where it did
};

// A place where a drive halts or is embedded.
struct OutcomeEvent {
  Rule rule = Rule::kSlipCheck;
  std::size_t station = 0;
};

// How one drive went, with the slip checked on the way.
struct DriveOutcome {
  // Times that the rover halts itself by the check of its slip, its tilt or its current and waits for the
  // next sol. The drive is taken to go on from there, so that a bad stretch costs as many as it is long; one
  // that holds the rover altogether, one for each half a metre.
  int stops = 0;
  bool embedded = false;
  std::vector<OutcomeEvent> events;  // the stops, and the embedding last
  std::array<RuleTrace, kRules> rules;

  const RuleTrace& of(Rule rule) const { return rules[static_cast<std::size_t>(rule)]; }
};

// Follows one drive station by station.
//
// The rover compares the way that its wheels have rolled with the way that it has come every
// `slip_check_every_m` of the former, and halts where the slip in between is over the limit. It halts at once
// where its tilt or a motor's current is over the limit. It is embedded where, before the next check, a wheel
// sinks deeper than `embedding_sinkage_share` of its radius, or the wheels spin at a slip over
// `embedding_slip_ratio` for more than `embedding_turns` turns: each turn digs out about what lies under the
// wheel. A rover that the ground immobilises spins until the next check.
class OutcomeFollower {
 public:
  OutcomeFollower(const RoverModel& rover, const DriveLimits& limits, const SlipChecks& checks);

  // Returns false where the drive has ended: the rover is embedded.
  bool add(const PreparedStation& station, std::size_t index, const StationState& state);
  // So far.
  int stops() const { return outcome_.stops; }
  // The last interval is checked where the drive ends.
  const DriveOutcome& finish();

 private:
  RuleTrace& trace(Rule rule) { return outcome_.rules[static_cast<std::size_t>(rule)]; }
  void note(Rule rule, double value, bool trips, int wheel = -1);
  void watch(Rule rule, double value, double limit, int wheel = -1);
  void halt(Rule rule);
  bool embed();
  bool spin(double rolled_m);
  bool spin_on_the_spot();
  bool check_slip();
  bool watch_wheels(const StationState& state);

  const RoverModel& rover_;
  const DriveLimits& limits_;
  const SlipChecks& checks_;
  DriveOutcome outcome_;
  std::size_t index_ = 0;
  double distance_m_ = 0.0;
  double rolled_m_ = 0.0, come_m_ = 0.0, spun_m_ = 0.0;  // since the last check
  std::optional<double> held_from_m_;                    // where the ground last held it
  bool clearance_seen_ = false;
  std::array<bool, kRules> over_{};  // at the last station
};

}  // namespace slipway::sim
