#include "core/number_words.h"

#include <fmt/format.h>

#include <cmath>

namespace slipway {

std::string plain_number(double value) {
  constexpr double kFourDigits = 999.5;
  return std::abs(value) >= kFourDigits ? fmt::format("{:.0f}", value) : fmt::format("{:.3g}", value);
}

std::string number_beside(double value, double other, int decimals) {
  constexpr int kMostDecimals = 9;
  std::string words = fmt::format("{:.{}f}", value, decimals);
  if (value == other) return words;
  while (words == fmt::format("{:.{}f}", other, decimals) && decimals < kMostDecimals)
    words = fmt::format("{:.{}f}", value, ++decimals);
  return words;
}

}  // namespace slipway
