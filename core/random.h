#pragma once

#include <cstdint>

namespace slipway {

// Counter-based random numbers: a pure function of (key, counter), so that any thread may ask for any number
// in any order and the same seed gives the same bytes. SplitMix64's finaliser over the mixed words [Steele
// 2014].
std::uint64_t random_bits(std::uint64_t key, std::uint64_t counter);

// Uniform in the open interval (0, 1).
double random_uniform(std::uint64_t key, std::uint64_t counter);

// Standard normal, by the inverse of its distribution function [Wichura 1988, AS 241], |error| < 1e-15.
double random_normal(std::uint64_t key, std::uint64_t counter);

// The key of a sub-stream. The same parent and index always give the same key.
std::uint64_t random_key(std::uint64_t parent, std::uint64_t index);

// The normal distribution's quantile; p in (0, 1).
double normal_quantile(double p);

}  // namespace slipway
