#include "api/files/campaign/written_time.h"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <limits>

#include "core/csv_cells.h"

namespace slipway::api {
namespace {

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();
constexpr double kMinute_s = 60.0, kHour_s = 3600.0, kDay_s = 86'400.0;

// Reads a text from its front to its end.
class Scanner {
 public:
  explicit Scanner(std::string_view text) : rest_(text) {}

  bool at_end() const { return rest_.empty(); }
  bool take(char c) {
    if (!rest_.starts_with(c)) return false;
    rest_.remove_prefix(1);
    return true;
  }
  bool take_any(std::string_view some) {
    if (rest_.empty() || some.find(rest_.front()) == std::string_view::npos) return false;
    rest_.remove_prefix(1);
    return true;
  }
  // A word in capital or small letters.
  bool take_word(std::string_view word) {
    if (rest_.size() < word.size()) return false;
    for (std::size_t i = 0; i < word.size(); ++i)
      if (static_cast<char>(rest_[i] | 0x20) != word[i]) return false;
    rest_.remove_prefix(word.size());
    return true;
  }
  // Digits, `least` to `most` of them.
  std::optional<double> digits(std::size_t least, std::size_t most) {
    const std::size_t count = std::min(rest_.find_first_not_of("0123456789"), rest_.size());
    if (count < least || count > most) return std::nullopt;
    double value = 0.0;
    std::from_chars(rest_.data(), rest_.data() + count, value, std::chars_format::fixed);
    rest_.remove_prefix(count);
    return value;
  }
  // What stands behind the point or comma of seconds; 0 where there is none.
  std::optional<double> fraction() {
    if (!take_any(".,")) return 0.0;
    const std::size_t count = std::min(rest_.find_first_not_of("0123456789"), rest_.size());
    double value = 0.0;
    std::from_chars(rest_.data(), rest_.data() + count, value, std::chars_format::fixed);
    rest_.remove_prefix(count);
    return value / std::pow(10.0, static_cast<double>(count));
  }

 private:
  std::string_view rest_;
};

// HH:MM, HH:MM:SS or HH:MM:SS.fff as seconds.
std::optional<double> hours_minutes_seconds(Scanner& scan) {
  const auto hours = scan.digits(1, 2);
  if (!hours || *hours > 24.0 || !scan.take(':')) return std::nullopt;
  const auto minutes = scan.digits(2, 2);
  if (!minutes || *minutes >= kMinute_s) return std::nullopt;
  double seconds = 0.0;
  if (scan.take(':')) {
    const auto whole = scan.digits(2, 2);
    const auto part = whole ? scan.fraction() : std::nullopt;
    if (!part || *whole > kMinute_s) return std::nullopt;  // 60 is a leap second
    seconds = *whole + *part;
  }
  return kHour_s * *hours + kMinute_s * *minutes + seconds;
}

// "Z", "UTC", "+02:00", "-0700" or nothing, in seconds east of UTC.
std::optional<double> zone_s(Scanner& scan) {
  scan.take(' ');
  if (scan.at_end() || scan.take_word("z") || scan.take_word("utc")) return 0.0;
  const bool west = scan.take('-');
  if (!west && !scan.take('+')) return std::nullopt;
  const auto digits = scan.digits(2, 4);
  if (!digits) return std::nullopt;
  double hours = *digits, minutes = 0.0;
  if (hours >= 100.0) {
    minutes = std::fmod(hours, 100.0);
    hours = std::floor(hours / 100.0);
  } else if (scan.take(':')) {
    minutes = scan.digits(2, 2).value_or(kMissing);
  }
  const double east = kHour_s * hours + kMinute_s * minutes;
  return west ? -east : east;
}

// A calendar's date, or a year and the day of it, in days since 1970.
std::optional<double> date_days(Scanner& scan) {
  namespace chr = std::chrono;
  const auto year = scan.digits(4, 4);
  if (!year || !scan.take_any("-/")) return std::nullopt;
  const chr::year y(static_cast<int>(*year));
  if (const auto of_year = Scanner(scan).digits(3, 3)) {
    scan.digits(3, 3);
    return static_cast<double>(chr::sys_days(y / 1 / 1).time_since_epoch().count()) + *of_year - 1.0;
  }
  const auto month = scan.digits(1, 2);
  if (!month || !scan.take_any("-/")) return std::nullopt;
  const auto day = scan.digits(1, 2);
  if (!day) return std::nullopt;
  const chr::year_month_day date(y, chr::month(static_cast<unsigned>(*month)),
                                 chr::day(static_cast<unsigned>(*day)));
  if (!date.ok()) return std::nullopt;
  return static_cast<double>(chr::sys_days(date).time_since_epoch().count());
}

std::optional<WrittenTime> as_date(std::string_view text) {
  Scanner scan(text);
  const auto days = date_days(scan);
  if (!days || !scan.take_any("Tt ")) return std::nullopt;
  const auto of_day = hours_minutes_seconds(scan);
  const auto zone = of_day ? zone_s(scan) : std::nullopt;
  if (!zone || !std::isfinite(*zone) || !scan.at_end()) return std::nullopt;
  return WrittenTime{.notation = TimeNotation::kDate, .seconds = kDay_s * *days + *of_day - *zone};
}

std::optional<WrittenTime> as_day_clock(std::string_view text) {
  WrittenTime time{.notation = TimeNotation::kDayClock};
  Scanner alone(text);
  if (const auto of_day = hours_minutes_seconds(alone); of_day && alone.at_end()) {
    time.seconds = *of_day;
    return time;
  }
  Scanner scan(text);
  time.of_a_sol = scan.take_word("sol");
  while (time.of_a_sol && scan.take_any(" -_")) continue;
  const auto day = scan.digits(1, 6);
  if (!day || !scan.take_any(" TtMm:,")) return std::nullopt;
  while (scan.take_any(" TtMm,-")) continue;
  const auto of_day = hours_minutes_seconds(scan);
  scan.take(' ');
  if (!scan.take_word("lmst")) scan.take_word("ltst");  // local mean or true solar time
  if (!of_day || !scan.at_end()) return std::nullopt;
  time.seconds = *of_day;
  time.day = *day;
  time.has_day = true;
  return time;
}

std::optional<WrittenTime> as_spacecraft_clock(std::string_view text, bool ticks) {
  WrittenTime time{.notation = TimeNotation::kSpacecraft};
  if (const std::size_t slash = text.find('/'); slash != std::string_view::npos) {
    Scanner partition(text.substr(0, slash));
    const auto number = partition.digits(1, 4);
    if (!number || !partition.at_end()) return std::nullopt;
    time.partition = static_cast<int>(*number);
    text.remove_prefix(slash + 1);
    ticks = true;
  }
  Scanner scan(text);
  const auto seconds = scan.digits(ticks ? 1 : 3, 18);
  if (!seconds) return std::nullopt;
  time.seconds = *seconds;
  if (scan.at_end() && ticks) return time;
  if (!scan.take_any(ticks ? ":.- " : ":-")) return std::nullopt;
  const auto fine = scan.digits(1, 18);
  if (!fine || !scan.at_end()) return std::nullopt;
  time.ticks = *fine;
  return time;
}

}  // namespace

std::optional<WrittenTime> written_time(std::string_view text, bool ticks) {
  if (ticks)
    if (auto time = as_spacecraft_clock(text, true)) return time;
  if (const auto number = csv_number(text)) return WrittenTime{.seconds = *number};
  if (auto time = as_date(text)) return time;
  if (auto time = as_day_clock(text)) return time;
  return as_spacecraft_clock(text, false);
}

}  // namespace slipway::api
