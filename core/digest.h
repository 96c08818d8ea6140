#pragma once

#include <cstdint>
#include <string_view>

namespace slipway {

// FNV-1a of 64 bits (Fowler, Noll and Vo 1991): tells inputs apart, guards against no one.
constexpr std::uint64_t kFnvBasis = 0xcbf29ce484222325ULL;
constexpr std::uint64_t fnv1a(std::uint64_t before, std::uint64_t word) {
  return (before ^ word) * 0x100000001b3ULL;
}
constexpr std::uint64_t fnv1a(std::string_view bytes, std::uint64_t before = kFnvBasis) {
  for (const char byte : bytes) before = fnv1a(before, static_cast<unsigned char>(byte));
  return before;
}

}  // namespace slipway
