#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace slipway {

// Text as UTF-8 without a byte order mark, and a sentence where its encoding was guessed.
struct DecodedText {
  std::string utf8;
  std::string note = {};
};

// Of UTF-8 and UTF-16 with or without a byte order mark; bytes that are neither are Windows-1252, which has
// all of Latin-1. Nothing where they are no text: bytes of zero, halves of characters.
std::optional<DecodedText> decode_text(std::string_view bytes);

}  // namespace slipway
