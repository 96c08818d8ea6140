#include "mutation.h"

#include <algorithm>
#include <array>
#include <cctype>

namespace slipway::fuzz {
namespace {

using namespace std::string_view_literals;

// Words that have broken readers of others: numbers at and beyond what a double holds, words that some
// parsers take for numbers, text that is no UTF-8, control characters, and the framing of JSON, CSV and HTTP.
constexpr std::array kHostile{"0"sv,
                              "-0"sv,
                              "1"sv,
                              "-1"sv,
                              "1e-300"sv,
                              "1e300"sv,
                              "1e308"sv,
                              "-1e308"sv,
                              "1e309"sv,
                              "5e-324"sv,
                              "1e-400"sv,
                              "4294967296"sv,
                              "2147483648"sv,
                              "-2147483649"sv,
                              "9007199254740993"sv,
                              "18446744073709551616"sv,
                              "9223372036854775808"sv,
                              "0.1"sv,
                              "90"sv,
                              "180"sv,
                              "-180"sv,
                              "360"sv,
                              "359.99999999999994"sv,
                              "3.9"sv,
                              "1E+2"sv,
                              "01"sv,
                              ".5"sv,
                              "1."sv,
                              "+1"sv,
                              "0x10"sv,
                              "NaN"sv,
                              "nan"sv,
                              "Infinity"sv,
                              "-inf"sv,
                              "null"sv,
                              "true"sv,
                              "false"sv,
                              "{}"sv,
                              "[]"sv,
                              "[[]]"sv,
                              "\"\""sv,
                              "\"\\u0000\""sv,
                              "\"\\ud800\""sv,
                              "\"\\udc00\\ud800\""sv,
                              "\xff"sv,
                              "\xc0\xaf"sv,
                              "\xed\xa0\x80"sv,
                              "\xf4\x90\x80\x80"sv,
                              "\xef\xbb\xbf"sv,
                              "\xc3\xbc"sv,
                              "\0"sv,
                              "\x1b[2J"sv,
                              "\r\n"sv,
                              "\n"sv,
                              "\r"sv,
                              ",,,,"sv,
                              "\t"sv,
                              "..\\"sv,
                              "../"sv,
                              "/"sv,
                              "\r\n\r\n"sv,
                              "Content-Length: 5\r\n"sv,
                              "Transfer-Encoding: chunked\r\n"sv,
                              "%00"sv,
                              "%c0%af"sv,
                              "%"sv,
                              "ffffffffffffffff\r\n"sv,
                              "II*\0"sv,
                              "MM\0*"sv,
                              "\xff\xff\xff\xff"sv,
                              "\0\0\0\0"sv,
                              "\xff\xff\xff\x7f"sv,
                              "\0\0\0\x80"sv,
                              "\0\0\xf0\x7f"sv,
                              "\0\0\xc0\x7f"sv};

bool is_word(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '.' || c == '-' || c == '+';
}

}  // namespace

void Mutator::learn(std::string_view input) {
  constexpr std::size_t kMaxWords = 4000, kMax = 40;
  for (std::size_t at = 0; at < input.size() && words_.size() < kMaxWords;) {
    std::size_t end = at;
    while (end < input.size() && is_word(input[end])) ++end;
    if (end > at && end - at <= kMax) {
      const std::string_view found = input.substr(at, end - at);
      if (std::find(words_.begin(), words_.end(), found) == words_.end()) words_.emplace_back(found);
    }
    at = end + 1;
  }
}

std::string_view Mutator::word() {
  const std::size_t i = below(kHostile.size() + words_.size());
  return i < kHostile.size() ? kHostile[i] : std::string_view(words_[i - kHostile.size()]);
}

void Mutator::change_bytes(std::string& input) {
  const std::size_t at = below(input.size());
  char& byte = input[at];
  switch (below(4)) {
    case 0:
      byte = static_cast<char>(byte ^ (1 << below(8)));
      break;
    case 1:
      byte = static_cast<char>(below(256));
      break;
    case 2:
      byte = static_cast<char>(byte + static_cast<int>(below(33)) - 16);
      break;
    default:
      input.insert(at, 1 + below(8), static_cast<char>(below(256)));
  }
}

void Mutator::change_piece(std::string& input, std::string_view other) {
  const std::size_t at = below(input.size()),
                    length = 1 + below(std::min<std::size_t>(input.size() - at, 1 + below(200)));
  switch (below(5)) {
    case 0:
      input.erase(at, length);
      break;
    case 1:
      input.insert(below(input.size()), input.substr(at, length));
      break;
    case 2:
      input.resize(at);
      break;
    case 3: {
      const std::string piece = input.substr(at, std::min<std::size_t>(length, 20));
      for (std::size_t copies = below(200); copies > 0; --copies) input.insert(at, piece);
      break;
    }
    default: {
      const std::size_t from = below(other.size());
      input.replace(at, below(2) == 0 ? length : 0, other.substr(from, 1 + below(200)));
    }
  }
}

void Mutator::change_word(std::string& input) {
  const std::size_t at = below(input.size());
  if (below(2) == 0) {
    input.insert(at, word());
    return;
  }
  // In place of the next word of the input.
  const auto begin = std::find_if(input.begin() + static_cast<std::ptrdiff_t>(at), input.end(), is_word);
  const auto end = std::find_if_not(begin, input.end(), is_word);
  input.replace(begin, end, word());
}

void Mutator::nest(std::string& input) {
  constexpr std::array kOpen{"["sv, "{\"a\":"sv, "("sv, "\""sv};
  const std::string_view open = kOpen[below(kOpen.size())];
  std::string deep;
  for (std::size_t levels = below(300); levels > 0; --levels) deep += open;
  input.insert(below(input.size() + 1), deep);
}

std::string Mutator::mutate(std::string input, std::string_view other, std::size_t most_bytes) {
  for (std::size_t changes = 1 + below(8); changes > 0; --changes) {
    if (input.empty()) input = word();
    const std::size_t kind = below(100);
    if (kind < 35)
      change_bytes(input);
    else if (kind < 60)
      change_piece(input, other);
    else if (kind < 97)
      change_word(input);
    else
      nest(input);
  }
  if (input.size() > most_bytes) input.resize(most_bytes);
  return input;
}

}  // namespace slipway::fuzz
