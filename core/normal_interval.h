#pragma once

namespace slipway {

// Half widths, in standard deviations, of the central intervals that hold 50 and 90 % of a normal
// distribution.
inline constexpr double kReach50 = 0.6744897501960817, kReach90 = 1.6448536269514722;

}  // namespace slipway
