#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "sim/prediction/drive_risk.h"
#include "sim/prediction/rule_catalogue.h"

namespace slipway::sim {

// What one drive did to one rule: the value that came nearest to its limit, and the part of the way where the
// rule tripped.
struct RuleTrace {
  double value = 0.0;       // in SI; of embedding the sinkage as a share of the wheel's radius
  bool seen = false;        // there is a value
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

// How a drive ends on a part of its way: a halt ends the sol there.
struct DriveEnding {
  std::optional<OutcomeEvent> halt;  // the first on the part, whichever rule asks for it
  bool immobilised = false;          // the ground holds the rover there
  bool embedded = false;             // and its wheels dig in before a check halts it

  bool completed() const { return !halt; }
};

// How one drive went, with the slip checked on the way.
struct DriveOutcome {
  // Times that the rover halts and waits for the next sol, the drive being taken up again from there; where
  // the ground holds it altogether, once each half a metre. For costs and sols: a verdict asks how the drive
  // ends first.
  int stops = 0;
  bool embedded = false;             // anywhere, on whatever sol
  std::vector<OutcomeEvent> events;  // in the order of the way, an embedding after the halt that it follows
  std::array<RuleTrace, kRules> rules;

  const RuleTrace& of(Rule rule) const { return rules[static_cast<std::size_t>(rule)]; }
  // Of the events from `first` to before `end`, by their index.
  DriveEnding ending(std::size_t first, std::size_t end) const;
  DriveEnding ending() const { return ending(0, events.size()); }
};

// Follows one drive station by station.
//
// The rover halts
//   where its slip is at or over the limit over a stretch, however placed, on which its wheels roll
//   `slip_check_every_m` or more. So closer checks and tighter limits halt it sooner, and a drive does what a
//   longer one does that begins in the same way. A drive that rolls less is not checked;
//   where any other rule of the catalogue trips, once for a stretch on which it goes on tripping;
//   where the ground holds it.
// It is embedded where a wheel sinks deeper than `embedding_sinkage_share` of its radius, or where its wheels
// dig for more than `embedding_turns` turns in one place before a check halts it: at a slip over
// `embedding_slip_ratio`, held by the ground, or turning in place, of which the slipping part counts. The
// check sees a slip over the limit after one stretch at most, and may just have let a lesser one pass:
// the wheels roll (1 + limit) stretches before it halts the rover.
class OutcomeFollower {
 public:
  // Where `segment_m` is over 0, budgets of time and energy begin anew on each segment.
  OutcomeFollower(const RoverModel& rover, const DriveLimits& limits, const SlipChecks& checks,
                  double segment_m = 0.0);

  // Returns false where the drive has ended: the rover is embedded.
  bool add(const PreparedStation& station, std::size_t index, const StationState& state);
  // No stance is possible at this station: the drive halts there.
  void without_stance(const PreparedStation& station, std::size_t index);
  // So far.
  int stops() const { return outcome_.stops; }
  // Way to the side since the last look, positive to the left [m].
  double aside_m() const { return aside_m_; }
  const DriveOutcome& finish() { return outcome_; }

 private:
  // Of the wheels, of the rover along its path and to the side, since the last halt.
  struct Way {
    double rolled_m = 0.0, come_m = 0.0, aside_m = 0.0;
  };

  void note(Rule rule, double value, bool trips, int wheel = -1);
  void watch(const RuleRow& row, double value, double limit, int wheel = -1);
  void halt(Rule rule);
  bool embed();
  void begin(const PreparedStation& station, std::size_t index);
  bool hold();
  void budget(const PreparedStation& station, const StationState& state);
  bool sink(const StationState& state);
  bool turn(const PreparedStation& station, const StationState& state);
  bool roll(const PreparedStation& station, const StationState& state);
  void look_back();
  bool slips_since(const Way& begin, const Way& now);
  double turns_m() const;  // way that the wheels roll while they dig in
  double way_to_halt_m() const { return (1.0 + limits_.max_slip_ratio) * checks_.slip_check_every_m; }

  const RoverModel& rover_;
  const DriveLimits& limits_;
  const SlipChecks& checks_;
  StationRules station_rules_;
  double segment_m_;
  DriveOutcome outcome_;
  std::size_t index_ = 0;
  double distance_m_ = 0.0;
  std::vector<Way> way_{Way{}};
  std::size_t begin_ = 0;  // the last entry of way_ that lies a stretch or more behind
  Way best_begin_;         // of those that far behind, from which the slip would be largest at the limit
  double aside_m_ = 0.0;
  double spun_m_ = 0.0, turned_m_ = 0.0;  // dug in one place: while driving, while turning
  double drive_s_ = 0.0, energy_j_ = 0.0;
  std::size_t segment_ = 0;
  std::optional<double> held_from_m_;  // where the ground last held it
  std::array<bool, kRules> over_{};    // at the last station
};

}  // namespace slipway::sim
