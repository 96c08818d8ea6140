#pragma once

#include <array>
#include <optional>
#include <vector>

#include "sim/prediction/drawn_drive.h"

namespace slipway::sim {

// The length of a scout drive, where the ground that decides is as long.
inline constexpr double kScoutLength_m = 5.0;

// Where a short drive onto the ground that decides would begin, and what it would be worth if the slip were
// measured on it. The ground that decides is the one on which most goes wrong; of its sections on the way
// those count where most does, each from its beginning and from the place where most goes wrong.
//
// The worth is the expected value of sample information [Raiffa & Schlaifer 1961], with the draws as the
// belief: a drive costs a sol where it halts, and where it embeds the rover no_go_stop / max_embedding of
// them, as the bars have it; not to drive costs no_go_stop. It is the expected cost of the better of the two
// as things are, less what is expected of the better of the two when the slip is known. It is never below 0.
// What the scout drive itself risks is not taken off; it is given beside it.
//
// The verdicts after it are at as many draws as a check takes at most. Nothing where nothing goes wrong in
// any draw.
std::optional<ScoutDrive> scout_drive(const std::vector<DrawnDrive>& drives,
                                      const std::vector<PreparedStation>& stations,
                                      const SoilBeliefs& beliefs, const DriveOutcomes& outcomes,
                                      const OutcomeBars& bars);

// What a scout drive may measure: slips in so many bins, and the probability of each on a draw with that
// slip.
inline constexpr std::size_t kSlipBins = 64;
std::array<double, kSlipBins> measured_shares(double drawn_slip, double slip_error, double length_m);

}  // namespace slipway::sim
