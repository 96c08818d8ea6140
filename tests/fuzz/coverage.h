#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace slipway::fuzz {

// How often each place of the program was passed since the last clear. Places share a counter where their
// addresses have the same hash, which loses a few of them and costs nothing else.
inline constexpr std::size_t kCoveragePlaces = std::size_t{1} << 16U;
extern std::array<std::uint8_t, kCoveragePlaces> coverage;

}  // namespace slipway::fuzz
