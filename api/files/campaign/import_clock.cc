#include "api/files/campaign/import_clock.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "api/files/campaign/written_time.h"
#include "core/fault_words.h"
#include "core/text_table.h"
#include "sky/mars_time.h"

namespace slipway::api {
namespace {

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();
constexpr double kDay_s = 86'400.0;
constexpr std::string_view kNotations =
    "a number, a date (2023-09-08T10:00:00Z, 2023-251T10:00:00), hours of a day (10:00:00, Sol 12 10:00:00) "
    "or a spacecraft's clock (1/0397446444:12345)";

// The times of one log.
class Times {
 public:
  Times(const ImportClock& clock, const std::string& file, const RecordedTable& table)
      : clock_(clock), file_(file), table_(table) {}

  std::optional<std::vector<double>> read(std::vector<std::string>& notes, bool& as_text,
                                          std::vector<Fault>& faults) {
    read_texts();
    for (std::size_t i = 0; i < texts_.size(); ++i) times_s_.push_back(seconds_of(texts_[i], i));
    if (plus_is_number_) add_second_column();
    look_for_turned_back();
    report(faults);
    if (!kinds_.empty()) return std::nullopt;
    const bool told = std::any_of(notes.begin(), notes.end(),
                                  [](const std::string& note) { return note.starts_with(kOfNotation); });
    as_text = notation_ != TimeNotation::kNumber;
    if (as_text && !told) notes.push_back(kOfNotation + words_of_notation());
    return std::move(times_s_);
  }

 private:
  inline static const std::string kBack = "back";
  inline static const std::string kOfNotation = "times as ";
  struct Kind {
    std::string first;
    std::vector<std::size_t> lines;
  };

  // A second column that holds text goes on with the first one's: a date and a time, a sol and a time.
  void read_texts() {
    texts_ = table_.texts.at(clock_.column);
    if (clock_.plus_column.empty()) return;
    const std::vector<std::string>& plus = table_.texts.at(clock_.plus_column);
    const std::size_t place = *table_.place_of(clock_.plus_column);
    plus_is_number_ = std::all_of(plus.begin(), plus.end(), [&](const std::string& text) {
      const auto row = static_cast<std::size_t>(&text - plus.data());
      return is_missing_cell(text) || std::isfinite(table_.rows[row][place]);
    });
    for (std::size_t i = 0; !plus_is_number_ && i < plus.size(); ++i) texts_[i] += " " + plus[i];
  }

  // Seconds since the first row that has a time, or as recorded.
  double seconds_of(const std::string& text, std::size_t row) {
    if (is_missing_cell(text)) return add("missing", row, "the time is missing");
    auto time = written_time(text, clock_.ticks_per_s.has_value());
    if (!time)
      if (const auto number = table_.rows[row][*table_.place_of(clock_.column)]; std::isfinite(number))
        time = WrittenTime{.seconds = number};  // with a decimal comma
    if (!time)
      return add(
          "unread", row,
          fmt::format("{} is no time, must be {}; dates begin with the year", in_quotes(text), kNotations));
    if (!first_) {
      first_ = *time;
      notation_ = time->notation;
      first_s_ = since(*time, WrittenTime{});
    }
    if (time->notation != notation_ || time->has_day != first_->has_day)
      return add("mixed", row,
                 fmt::format("{} is written otherwise than the first time of the file", in_quotes(text)));
    if (notation_ == TimeNotation::kSpacecraft) return spacecraft_s(*time, text, row);
    const double now_s = since(*time, zero());
    if (notation_ == TimeNotation::kDayClock && !first_->has_day) return now_s + past_midnight_s(now_s);
    return now_s;
  }

  double spacecraft_s(const WrittenTime& time, const std::string& text, std::size_t row) {
    if (!clock_.ticks_per_s && time.ticks > 0.0)
      return add("ticks", row,
                 fmt::format("{} is a spacecraft's clock, seconds and ticks: say with the key "
                             "clock.ticks_per_s of the mapping how many ticks a second has (256 or 65536 of "
                             "most; the SCLK kernel has it as SCLK01_MODULI)",
                             in_quotes(text)));
    if (clock_.ticks_per_s && time.ticks >= *clock_.ticks_per_s)
      return add("many ticks", row,
                 fmt::format("{} has {} ticks, must be less than the {} of clock.ticks_per_s",
                             in_quotes(text), time.ticks, *clock_.ticks_per_s));
    if (time.partition != first_->partition)
      return add("partition", row,
                 fmt::format("the clock's partition is {} after {}, between which nobody can reckon without "
                             "its SCLK kernel: make two drives of the file, or convert the times to UTC",
                             time.partition, first_->partition));
    return since(time, zero());
  }

  // What times are counted from.
  WrittenTime zero() const { return clock_.from_first_row ? *first_ : WrittenTime{}; }

  double since(const WrittenTime& time, const WrittenTime& first) const {
    switch (time.notation) {
      case TimeNotation::kNumber:
        return clock_unit_s(clock_.unit) * (time.seconds - first.seconds);
      case TimeNotation::kDate:
        return time.seconds - first.seconds;
      case TimeNotation::kDayClock:
        return day_s() * (time.day - first.day) + day_s() / kDay_s * (time.seconds - first.seconds);
      case TimeNotation::kSpacecraft:
        return time.seconds - first.seconds + (time.ticks - first.ticks) / clock_.ticks_per_s.value_or(1.0);
    }
    return kMissing;
  }

  double day_s() const { return clock_.day_s.value_or(first_ && first_->of_a_sol ? sky::kSol_s : kDay_s); }

  // A clock that is far behind the row before has passed midnight.
  double past_midnight_s(double now_s) {
    if (now_s + midnights_ * day_s() < last_s_ - 0.5 * day_s()) ++midnights_;
    last_s_ = now_s + midnights_ * day_s();
    return midnights_ * day_s();
  }

  // The part of a second that the second column has.
  void add_second_column() {
    const std::size_t place = *table_.place_of(clock_.plus_column);
    const double unit_s = clock_unit_s(clock_.plus_unit);
    const double first = clock_.from_first_row ? table_.rows.front()[place] : 0.0;
    for (std::size_t i = 0; i < times_s_.size(); ++i) {
      const double part = table_.rows[i][place];
      if (!std::isfinite(part))
        add("missing", i, fmt::format("the time is missing: {} is empty", clock_.plus_column));
      times_s_[i] += unit_s * (part - first);
    }
  }

  void look_for_turned_back() {
    for (std::size_t i = 1; i < times_s_.size(); ++i)
      if (times_s_[i] <= times_s_[i - 1])
        add(kBack, i,
            fmt::format("{} follows {}: times must increase from row to row", texts_[i], texts_[i - 1]));
  }

  // Of clocks of two columns, of which one was taken for the whole.
  std::string remedy_of_two_columns() const {
    constexpr double kSecond_s = 1.0;
    if (!clock_.plus_column.empty() || notation_ != TimeNotation::kNumber) return "";
    if (clock_unit_s(clock_.unit) < kSecond_s && first_s_ >= 0.0 && first_s_ < kSecond_s)
      return fmt::format(
          ". If {0} is the part of a second: under [clock], from = \"{1}\" (the column of whole "
          "seconds), unit = \"s\", plus = {{from = \"{0}\", unit = \"{2}\"}}",
          clock_.column, column_of_seconds(), clock_.unit);
    return ". If parts of a second are in another column, name it under [clock]: plus = {from = \"...\", "
           "unit "
           "= \"ns\"}; rows of one time must be one row";
  }

  // The column of whole seconds, as its name and its numbers say.
  std::string column_of_seconds() const {
    for (std::size_t c = 0; c < table_.names.size(); ++c) {
      const std::string& name = table_.names[c];
      const double first = table_.rows.front()[c], last = table_.rows.back()[c];
      if (name != clock_.column && name.find("sec") != std::string::npos && last > first) return name;
    }
    return "...";
  }

  double add(const std::string& kind, std::size_t row, std::string words) {
    Kind& of = kinds_[kind];
    if (of.lines.empty()) of.first = std::move(words);
    of.lines.push_back(table_.lines[row]);
    return kMissing;
  }

  void report(std::vector<Fault>& faults) const {
    for (const auto& [name, kind] : kinds_)
      faults.push_back(
          {fmt::format("{}#/{}/{}", file_, kind.lines.front(), clock_.column),
           fmt::format("{}, line {} ({}): {}{}{}", file_, kind.lines.front(), clock_.column, kind.first,
                       other_lines(kind.lines), name == kBack ? remedy_of_two_columns() : "")});
  }

  std::string words_of_notation() const {
    const std::string text = in_quotes(texts_.front());
    if (notation_ == TimeNotation::kDate)
      return fmt::format("{} are read as UTC, unless they name a zone; clock.unit is not used", text);
    if (notation_ == TimeNotation::kDayClock)
      return fmt::format(
          "{} are read as hours, minutes and seconds of a day that takes {} s; if it "
          "is another (a sol of Mars takes {} s), add the key clock.day_s",
          text, day_s(), sky::kSol_s);
    if (!clock_.ticks_per_s)
      return fmt::format("{} are read as seconds of a spacecraft's clock, whose ticks are all 0", text);
    return fmt::format("{} are read as seconds and ticks of a spacecraft's clock, {} ticks a second", text,
                       *clock_.ticks_per_s);
  }

  const ImportClock& clock_;
  const std::string& file_;
  const RecordedTable& table_;
  std::vector<std::string> texts_;  // of the rows
  bool plus_is_number_ = false;     // of the second column
  std::vector<double> times_s_;
  std::optional<WrittenTime> first_;
  TimeNotation notation_ = TimeNotation::kNumber;
  double first_s_ = 0.0, last_s_ = 0.0, midnights_ = 0.0;
  std::map<std::string, Kind> kinds_;
};

}  // namespace

std::optional<std::vector<double>> read_times(const ImportClock& clock, const std::string& file,
                                              const RecordedTable& table, std::vector<std::string>& notes,
                                              bool& as_text, std::vector<Fault>& faults) {
  return Times(clock, file, table).read(notes, as_text, faults);
}

std::optional<std::string> ticks_as_decimals(const ImportClock& clock, const RecordedTable& table) {
  constexpr std::size_t kDifferent = 10;  // decimals that stay below a third by chance, once in 60,000
  if (clock.ticks_per_s || clock_unit_s(clock.unit) != 1.0) return std::nullopt;
  std::set<std::string> decimals;
  for (const std::string& text : table.texts.at(clock.column)) {
    const std::size_t point = text.find('.');
    if (point == std::string::npos) return std::nullopt;
    decimals.insert(text.substr(point + 1));
    if (decimals.rbegin()->size() != decimals.begin()->size()) return std::nullopt;
  }
  for (const auto& [digits, ticks] : {std::pair{3U, 256}, std::pair{5U, 65'536}})
    if (decimals.size() >= kDifferent && decimals.begin()->size() == digits &&
        *decimals.rbegin() < fmt::format("{}", ticks) &&
        *decimals.rbegin() > fmt::format("{:0{}}", ticks / 2, digits))
      return fmt::format(
          "the decimals of {} are never {} or more: they seem to be ticks of a spacecraft's clock. If they "
          "are, "
          "add the key ticks_per_s = {} to [clock]",
          clock.column, ticks, ticks);
  return std::nullopt;
}

}  // namespace slipway::api
