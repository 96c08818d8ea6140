#include "core/text_encoding.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace slipway {
namespace {

std::uint8_t byte_at(std::string_view bytes, std::size_t i) {
  return static_cast<std::uint8_t>(bytes[i]);
}

void append(std::string& utf8, char32_t character) {
  const auto put = [&](char32_t bits) { utf8 += static_cast<char>(static_cast<std::uint8_t>(bits)); };
  const auto tail = [&](unsigned shift) { put(0x80U | ((character >> shift) & 0x3FU)); };
  if (character < 0x80) return put(character);
  if (character < 0x800) {
    put(0xC0U | (character >> 6U));
    return tail(0);
  }
  if (character < 0x10000) {
    put(0xE0U | (character >> 12U));
  } else {
    put(0xF0U | (character >> 18U));
    tail(12);
  }
  tail(6);
  tail(0);
}

bool is_utf8(std::string_view bytes) {
  for (std::size_t i = 0; i < bytes.size();) {
    const std::size_t length = length_of_character(bytes, i);
    if (length == 0) return false;
    i += length;
  }
  return true;
}

std::optional<std::string> from_utf16(std::string_view bytes, bool big_endian) {
  if (bytes.size() % 2 != 0) return std::nullopt;
  std::string utf8;
  const auto unit = [&](std::size_t i) {
    const std::uint32_t a = byte_at(bytes, i), b = byte_at(bytes, i + 1);
    return static_cast<char32_t>(big_endian ? a << 8U | b : b << 8U | a);
  };
  for (std::size_t i = 0; i < bytes.size(); i += 2) {
    char32_t character = unit(i);
    if (character >= 0xD800 && character < 0xE000) {
      if (character >= 0xDC00 || i + 2 >= bytes.size()) return std::nullopt;
      const char32_t low = unit(i += 2);
      if (low < 0xDC00 || low >= 0xE000) return std::nullopt;
      character = 0x10000 + ((character - 0xD800) << 10U) + (low - 0xDC00);
    }
    append(utf8, character);
  }
  return utf8;
}

// Latin-1 but for 0x80 to 0x9F, which are control characters there and Windows' typographic ones here.
std::string from_windows_1252(std::string_view bytes) {
  constexpr std::array<char32_t, 32> kTypographic{
      0x20AC, 0x81,   0x201A, 0x0192, 0x201E, 0x2026, 0x2020, 0x2021, 0x02C6, 0x2030, 0x0160,
      0x2039, 0x0152, 0x8D,   0x017D, 0x8F,   0x90,   0x2018, 0x2019, 0x201C, 0x201D, 0x2022,
      0x2013, 0x2014, 0x02DC, 0x2122, 0x0161, 0x203A, 0x0153, 0x9D,   0x017E, 0x0178};
  std::string utf8;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    const std::uint8_t byte = byte_at(bytes, i);
    append(utf8, byte >= 0x80 && byte < 0xA0 ? kTypographic[byte - 0x80U] : char32_t{byte});
  }
  return utf8;
}

// UTF-16 without a mark: the first characters of a table are ASCII, so that every second byte is zero.
// `high` is where: 0 big-endian, 1 little-endian.
bool looks_like_utf16(std::string_view bytes, std::size_t high) {
  const std::size_t end = std::min<std::size_t>(bytes.size(), 64);
  if (end < 4) return false;
  for (std::size_t i = 0; i + 1 < end; i += 2)
    if (bytes[i + high] != '\0' || bytes[i + 1 - high] == '\0') return false;
  return true;
}

}  // namespace

std::size_t length_of_character(std::string_view bytes, std::size_t i) {
  const std::uint8_t first = byte_at(bytes, i);
  const std::size_t length = first < 0x80                     ? 1
                             : first >= 0xC2 && first < 0xE0  ? 2
                             : first >= 0xE0 && first < 0xF0  ? 3
                             : first >= 0xF0 && first <= 0xF4 ? 4
                                                              : 0;
  if (length == 0 || i + length > bytes.size()) return 0;
  for (std::size_t k = 1; k < length; ++k)
    if ((byte_at(bytes, i + k) & 0xC0U) != 0x80U) return 0;
  if (length < 3) return length;
  // Longer than needed, half of a UTF-16 pair, above the last character.
  const std::uint8_t second = byte_at(bytes, i + 1);
  const bool is_none = (first == 0xE0 && second < 0xA0) || (first == 0xED && second >= 0xA0) ||
                       (first == 0xF0 && second < 0x90) || (first == 0xF4 && second >= 0x90);
  return is_none ? 0 : length;
}

std::string cut_to(std::string text, std::size_t most) {
  constexpr std::string_view kMark = "...";
  if (text.size() <= most + (text.ends_with(kMark) ? kMark.size() : 0)) return text;
  std::size_t end = most;
  while (end > 0 && (byte_at(text, end) & 0xC0U) == 0x80U) --end;
  text.resize(end);
  return text.append(kMark);
}

std::optional<DecodedText> decode_text(std::string_view bytes) {
  constexpr std::string_view kUtf8Mark = "\xEF\xBB\xBF", kLittleMark = "\xFF\xFE", kBigMark = "\xFE\xFF";
  const auto utf16 = [&](std::string_view text, bool big_endian,
                         std::string note) -> std::optional<DecodedText> {
    auto utf8 = from_utf16(text, big_endian);
    if (!utf8 || utf8->find('\0') != std::string::npos) return std::nullopt;
    return DecodedText{*std::move(utf8), std::move(note)};
  };
  if (bytes.starts_with(kLittleMark)) return utf16(bytes.substr(2), false, "");
  if (bytes.starts_with(kBigMark)) return utf16(bytes.substr(2), true, "");
  for (const bool big_endian : {false, true})
    if (looks_like_utf16(bytes, big_endian ? 0 : 1))
      return utf16(bytes, big_endian, "The text was read as UTF-16, though it has no byte order mark.");
  if (bytes.starts_with(kUtf8Mark)) bytes.remove_prefix(kUtf8Mark.size());
  if (bytes.find('\0') != std::string_view::npos) return std::nullopt;
  if (is_utf8(bytes)) return DecodedText{std::string(bytes)};
  return DecodedText{from_windows_1252(bytes),
                     "The text is no UTF-8 and was read as Latin-1 (Windows-1252)."};
}

}  // namespace slipway
