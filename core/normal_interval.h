#pragma once

namespace slipway {

// How many standard deviations around its mean hold 50 and 90 % of a normal distribution.
inline constexpr double kReach50 = 0.6744897501960817, kReach90 = 1.6448536269514722;

}  // namespace slipway
