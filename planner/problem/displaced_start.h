#pragma once

#include <optional>
#include <vector>

#include "core/pose.h"
#include "planner/problem/verdict.h"

namespace slipway::planner {

// How far the rover may stand from the start that its commands are made for: standard deviations of normal,
// independent errors.
struct StartError {
  double position_m = 0.0;  // along each axis of the map
  double heading_rad = 0.0;
};

// A start beside the one that is said, in that one's axes, and what becomes of the drive from there.
struct DisplacedStart {
  double ahead_m = 0.0, left_m = 0.0;
  double turned_rad = 0.0;  // to the left
  Verdict verdict = Verdict::kGo;
  std::optional<JudgedRule> rule = {};  // that decides it; nothing of a GO
  double max_slip_ratio = 0.0;
  std::optional<Pose2> at = {};  // where the rule is broken, or of a GO where it slips most
  std::size_t broken = 0;        // how many rules do not hold

  Pose2 from(const Pose2& start) const;
};

// The same commands from each of a fixed set of starts, the one that is said first.
struct DisplacedStarts {
  StartError error;
  std::vector<DisplacedStart> starts;

  std::size_t count(Verdict verdict) const;
  // Of the most severe verdict; of these the one that breaks most rules, then the one that slips most.
  const DisplacedStart& worst() const;
};

}  // namespace slipway::planner
