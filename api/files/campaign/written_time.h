#pragma once

#include <optional>
#include <string_view>

namespace slipway::api {

// How the times of a log are written. What a cell holds says which it is, whatever the mapping's unit.
enum class TimeNotation {
  kNumber,      // in the mapping's unit
  kDate,        // 2023-09-08T10:00:00.5Z, 2023-251T10:00:00, 2023-09-08 10:00:00+02:00
  kDayClock,    // 10:00:00.5, Sol 12 10:00:00, SOL-00012M10:00:00: hours, minutes and seconds of some day
  kSpacecraft,  // 1/0397446444:12345: seconds and ticks of a spacecraft's clock
};

struct WrittenTime {
  TimeNotation notation = TimeNotation::kNumber;
  double seconds = 0.0;  // since 1970 of a date, of its day of a day's clock, of its partition else
  double ticks = 0.0;    // of a spacecraft's clock, on top of the seconds
  double day = 0.0;      // of a day's clock that says which: the sol, for instance
  bool has_day = false;
  bool of_a_sol = false;  // it says that its days are sols
  int partition = 0;
};
// Nothing of a text that is no time. With `ticks` a number with a point is seconds and ticks too.
std::optional<WrittenTime> written_time(std::string_view text, bool ticks);

}  // namespace slipway::api
