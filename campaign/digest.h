#pragma once

#include <cstdint>
#include <string_view>

namespace slipway::campaign {

// FNV-1a over bytes: tells inputs apart, guards against no one.
constexpr std::uint64_t digest_of(std::string_view bytes, std::uint64_t before = 0xcbf29ce484222325ULL) {
  for (const char byte : bytes)
    before = (before ^ static_cast<std::uint64_t>(static_cast<unsigned char>(byte))) * 0x100000001b3ULL;
  return before;
}

}  // namespace slipway::campaign
