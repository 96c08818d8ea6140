#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sim/single_wheel/single_wheel_rig.h"

namespace slipway::sim {

// Which slip explains a measured current, where soil and load are known: current(slip) of one balanced wheel,
// inverted. The slips that are searched, and the step of the search: roots closer together than that are one.
constexpr double kMinSearchedSlip = -0.9;
constexpr double kMaxSearchedSlip = 0.99;
constexpr double kSearchedSlipStep = 0.01;

struct SlipsOfCurrent {
  std::vector<double> slips;  // every slip that asks for this current, rising, to 1e-10
  // The lowest of them at which the current rises with slip, as it does from free rolling: where a wheel that
  // was driven off from rest is.
  std::optional<double> reported;
  bool stands = false;  // at any slip that was searched; the currents between which it stands
  double least_current_a = 0.0, greatest_current_a = 0.0;
  std::optional<double> sunk_from_slip;  // it stands below this slip, and is sunk to its axle at it
};

// The test's own slip is not used; it has a drive.
SlipsOfCurrent slips_of_current(const WheelRigConditions& test, double current_a);

// The greatest drawbar pull over slips of 0 and above, and the slip of it. Nothing where the wheel does not
// stand.
struct GreatestPull {
  double slip = 0.0, pull_n = 0.0;
};
std::optional<GreatestPull> greatest_pull(const WheelRigConditions& test);

enum class Trafficability { kGo, kUnknown, kNoGo };
std::string_view describe(Trafficability verdict);  // "go", "unknown", "no_go"

struct InverseOptions {
  double max_slip = 0.4;        // MER operations stopped drives at 40 %
  double accepted_risk = 0.05;  // share of soil draws above the limit that is still GO
  int draws = 200;
  std::uint64_t seed = 1;
};

// What draws of the soil make of the same current.
struct SlipQuantiles {
  int draws = 0;
  int solved = 0;  // draws with a slip; the quantiles are theirs
  int above = 0;   // the current is more than any slip of that soil asks for, or the wheel sinks
  int below = 0;   // it is less
  double p05 = 0.0, p50 = 0.0, p95 = 0.0;  // where `solved` is not 0
  double risk = 0.0;                       // share of draws above the slip limit, those of `above` among them
};

// What a wheel's current says of its drive.
struct CurrentInverse {
  SlipsOfCurrent found;
  std::optional<WheelRigResult> wheel;  // at the slip that is reported
  std::optional<GreatestPull> greatest;
  // Share of the greatest pull in use; nothing where the wheel pulls nothing at this slip, or can't at any.
  std::optional<double> share_of_pull;
  // Slopes on which W sin = pull at a normal load W cos, tan = pull / load: the one this slip would hold
  // (below 0 it is pushed, or drives downhill), the steepest it could climb, and what lies between them.
  // Where there is a slip.
  std::optional<double> slope_in_use_rad, slope_greatest_rad, slope_left_rad;
  SlipQuantiles quantiles;
  Trafficability verdict = Trafficability::kUnknown;
  std::vector<std::string> words;  // why, and what is doubtful
};

// `test.soil` is not used: the belief's mean and draws, whose effects were applied. Deterministic in the
// seed.
CurrentInverse invert_current(const WheelRigConditions& test, const SoilDistribution& belief,
                              double current_a, const InverseOptions& options);

}  // namespace slipway::sim
