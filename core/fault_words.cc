#include "core/fault_words.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <numeric>

#include "core/text_encoding.h"

namespace slipway {
namespace {

// Edits (insert, drop, replace a character) that turn a into b [Wagner & Fischer 1974].
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i - 1] == b[j - 1] ? 0U : 1U);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, replaced});
    }
  }
  return row[b.size()];
}

}  // namespace

std::string in_quotes(std::string_view text) {
  constexpr std::size_t kMaxShown = 40;
  return fmt::format("\"{}\"", cut_to(std::string(text.substr(0, kMaxShown + 1)), kMaxShown));
}

std::optional<std::string> nearest(std::string_view name, const std::vector<std::string>& known) {
  constexpr std::size_t kMaxBytes = 64;  // longer names are not compared
  if (name.size() > kMaxBytes) return std::nullopt;
  std::optional<std::string> best;
  std::size_t least = std::max<std::size_t>(2, name.size() / 3) + 1;
  for (const std::string& candidate : known) {
    // A name without its unit is far away by edits but still near: "max_tilt" for "max_tilt_deg".
    const bool begins = name.size() >= 3 && candidate.starts_with(name);
    const std::size_t distance = begins ? 1 : edit_distance(name, candidate);
    if (distance < least) {
      least = distance;
      best = candidate;
    }
  }
  return best;
}

std::string unknown_name(std::string_view kind, std::string_view name,
                         const std::vector<std::string>& known) {
  const auto meant = nearest(name, known);
  std::vector<std::string> once;
  for (const std::string& one : known)
    if (std::find(once.begin(), once.end(), one) == once.end()) once.push_back(one);
  return fmt::format("unknown {} {}; {}known: {}", kind, in_quotes(name),
                     meant ? fmt::format("did you mean \"{}\"? ", *meant) : std::string(),
                     fmt::join(once, ", "));
}

}  // namespace slipway
