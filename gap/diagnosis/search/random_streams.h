#pragma once

#include <cstdint>

namespace slipway::gap {

// Where the sub-streams of a diagnosis' seed begin, for random_key(seed, stream + k); k stays below 4000.
enum RandomStream : std::uint64_t {
  kSignFlips = 1000,    // whether a channel's gap is beyond chance
  kSliceOrders = 5000,  // whether a slice of conditions stands out
  kPlaceOrders = 9000   // whether a place stands out
};

}  // namespace slipway::gap
