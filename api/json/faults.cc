#include "api/json/faults.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <numeric>

#include "sim/effects/effect_catalogue.h"

namespace slipway::api {
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
  if (text.size() <= kMaxShown) return fmt::format("\"{}\"", text);
  std::size_t end = kMaxShown;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) --end;
  return fmt::format("\"{}...\"", text.substr(0, end));
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

bool has_fault_under(const std::vector<Fault>& faults, std::string_view pointer) {
  return std::any_of(faults.begin(), faults.end(), [pointer](const Fault& f) {
    return f.pointer.starts_with(pointer) &&
           (f.pointer.size() == pointer.size() || f.pointer[pointer.size()] == '/');
  });
}

std::vector<Fault> moved_under(std::string_view prefix, std::vector<Fault> faults) {
  for (Fault& fault : faults) fault.pointer.insert(0, prefix);
  return faults;
}

std::optional<Fault> temperature_without_effect(const sim::RoverModel& rover,
                                                const std::vector<sim::EffectSetting>& requested) {
  for (const sim::EffectSetting& setting : sim::in_force(rover.effects, requested))
    if (const sim::Effect* const effect = sim::find_effect(setting.name);
        effect != nullptr && effect->reads_motor_temperature)
      return std::nullopt;
  std::vector<std::string_view> readers;
  for (const sim::Effect& effect : sim::effect_catalogue())
    if (effect.reads_motor_temperature) readers.push_back(effect.name);
  return Fault{
      "/motor_temp_c",
      fmt::format("motor_temp_c counts only where the effect {} is on: switch it on or leave this out",
                  fmt::join(readers, " or "))};
}

std::string summary_of(const std::vector<Fault>& faults) {
  return faults.size() == 1 ? faults.front().message
                            : fmt::format("{} faults; the first: {}", faults.size(), faults.front().message);
}

}  // namespace slipway::api
