#include "core/utc.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <charconv>
#include <chrono>
#include <cmath>
#include <ctime>

namespace slipway {

std::string utc_text(std::int64_t ms) {
  constexpr std::int64_t kPerSecond = 1000;
  const std::int64_t part = (ms % kPerSecond + kPerSecond) % kPerSecond;
  const auto seconds = static_cast<std::time_t>((ms - part) / kPerSecond);
  return fmt::format("{:%Y-%m-%dT%H:%M:%S}.{:03}Z", fmt::gmtime(seconds), part);
}

std::string utc_words(std::int64_t ms) {
  using std::chrono::milliseconds, std::chrono::seconds;
  const std::int64_t rounded_s = std::chrono::round<seconds>(milliseconds(ms)).count();
  const std::string text = utc_text(1000 * rounded_s);  // 2026-07-01T12:00:17.000Z
  return fmt::format("{} {} UTC", text.substr(0, 10), text.substr(11, rounded_s % 60 == 0 ? 5 : 8));
}

std::int64_t minute_after(std::int64_t ms) {
  using std::chrono::milliseconds, std::chrono::minutes;
  return milliseconds(std::chrono::ceil<minutes>(milliseconds(ms))).count();
}

std::string span_words(double seconds) {
  constexpr double kMinute_s = 60.0, kHour_s = 3600.0;
  const double s = std::abs(seconds);
  if (s < 2.0 * kMinute_s) return fmt::format("{:.0f} s", std::floor(s));
  if (s < 2.0 * kHour_s) return fmt::format("{:.0f} min", std::floor(s / kMinute_s));
  return fmt::format("{:.1f} h", std::floor(10.0 * s / kHour_s) / 10.0);
}

std::optional<std::int64_t> utc_of_text(std::string_view text) {
  // 2026-07-01T12:00:00[.123]Z, or with +02:00 in the place of Z
  constexpr std::string_view kForm = "dddd-dd-ddTdd:dd:dd";
  constexpr std::string_view kZone = "+dd:dd";
  const std::size_t zone_size = !text.empty() && text.back() == 'Z' ? 1 : kZone.size();
  if (text.size() < kForm.size() + zone_size) return std::nullopt;
  for (std::size_t k = 0; k < kForm.size(); ++k)
    if (kForm[k] == 'd' ? text[k] < '0' || text[k] > '9' : text[k] != kForm[k]) return std::nullopt;
  const auto number = [&](std::size_t first, std::size_t count) {
    int value = 0;
    std::from_chars(text.data() + first, text.data() + first + count, value);
    return value;
  };
  std::int64_t ahead_min = 0;  // of UTC
  if (zone_size > 1) {
    const std::size_t zone = text.size() - zone_size;
    for (std::size_t k = 1; k < kZone.size(); ++k)
      if (kZone[k] == 'd' ? text[zone + k] < '0' || text[zone + k] > '9' : text[zone + k] != kZone[k])
        return std::nullopt;
    if (text[zone] != '+' && text[zone] != '-') return std::nullopt;
    const int hours = number(zone + 1, 2), minutes = number(zone + 4, 2);
    if (hours > 23 || minutes > 59) return std::nullopt;
    ahead_min = (text[zone] == '-' ? -1 : 1) * (60 * hours + minutes);
  }
  std::string_view fraction = text.substr(kForm.size(), text.size() - kForm.size() - zone_size);
  std::int64_t ms = 0;
  if (!fraction.empty()) {
    if (fraction.front() != '.' || fraction.size() < 2) return std::nullopt;
    fraction.remove_prefix(1);
    if (fraction.find_first_not_of("0123456789") != std::string_view::npos) return std::nullopt;
    constexpr std::size_t kDigits = 3;
    for (std::size_t k = 0; k < kDigits; ++k) ms = 10 * ms + (k < fraction.size() ? fraction[k] - '0' : 0);
  }
  using namespace std::chrono;  // NOLINT: names of the calendar
  const year_month_day date{year(number(0, 4)), month(static_cast<unsigned>(number(5, 2))),
                            day(static_cast<unsigned>(number(8, 2)))};
  const int hour = number(11, 2), minute = number(14, 2), second = number(17, 2);
  if (!date.ok() || hour > 23 || minute > 59 || second > 59) return std::nullopt;
  const auto days = sys_days(date).time_since_epoch().count();
  return ((days * 24LL + hour) * 60LL + minute - ahead_min) * 60'000LL + second * 1000LL + ms;
}

std::int64_t now_ms() {
  using std::chrono::system_clock;
  return std::chrono::duration_cast<std::chrono::milliseconds>(system_clock::now().time_since_epoch())
      .count();
}

}  // namespace slipway
