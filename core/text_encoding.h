#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace slipway {

// How many bytes the UTF-8 character at `i` has [RFC 3629]; 0 where there is none.
std::size_t length_of_character(std::string_view bytes, std::size_t i);

// With "..." behind it where it has more bytes than these, and never cut within a UTF-8 character.
std::string cut_to(std::string text, std::size_t most);

// Text as UTF-8 without a byte order mark, and a sentence where its encoding was guessed.
struct DecodedText {
  std::string utf8;
  std::string note = {};
};

// Of UTF-8 and UTF-16 with or without a byte order mark; bytes that are neither are Windows-1252, which has
// all of Latin-1. Nothing where they are no text: bytes of zero, halves of characters.
std::optional<DecodedText> decode_text(std::string_view bytes);

}  // namespace slipway
