#include "api/files/campaign/drive_series_csv.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <optional>
#include <span>

#include "api/json/faults.h"
#include "core/angle.h"
#include "core/csv_cells.h"
#include "gap/diagnosis/model/channel.h"

namespace slipway::api {
namespace {

constexpr std::size_t kMaxFaults = 100;  // of one file, that are reported one by one
constexpr char kSeparator = ',';
constexpr std::size_t kNowhere = static_cast<std::size_t>(-1);

constexpr double kMax_m = 1e8;  // map coordinates of a whole planet
constexpr double kMaxTurns_deg = 36'000.0;
using Sample = gap::DriveSample;
using gap::SampleColumn;

// Columns of the rover that more than one channel, or none, is read from.
constexpr std::array<SampleColumn, 8> kColumns{{
    {"t_s", -1e11, 1e11, [](Sample& s, std::size_t, double v) { s.time_s = v; }},
    {"x_m", -kMax_m, kMax_m, [](Sample& s, std::size_t, double v) { s.p_MB.x() = v; }},
    {"y_m", -kMax_m, kMax_m, [](Sample& s, std::size_t, double v) { s.p_MB.y() = v; }},
    {"z_m", -1e5, 1e5, [](Sample& s, std::size_t, double v) { s.p_MB.z() = v; }},
    {"roll_deg", -180.0, 180.0,
     [](Sample& s, std::size_t, double v) { s.attitude.roll_rad = rad_from_deg(v); }},
    {"pitch_deg", -180.0, 180.0,
     [](Sample& s, std::size_t, double v) { s.attitude.pitch_rad = rad_from_deg(v); }},
    {"yaw_deg", -kMaxTurns_deg, kMaxTurns_deg,
     [](Sample& s, std::size_t, double v) { s.attitude.yaw_rad = rad_from_deg(v); }},
    {"bus_voltage_v", 0.0, 1000.0, [](Sample& s, std::size_t, double v) { s.bus_voltage_v = v; }},
}};
constexpr std::size_t kTime = 0;  // in kColumns

constexpr std::array<SampleColumn, 2> kWheelCommandColumns{{
    {"rate_deg_s", -1e4, 1e4,
     [](Sample& s, std::size_t k, double v) { s.wheels[k].rate_rad_s = rad_from_deg(v); }},
    {"steer_deg", -360.0, 360.0,
     [](Sample& s, std::size_t k, double v) { s.wheels[k].steer_rad = rad_from_deg(v); }},
}};
constexpr SampleColumn kMotorTemperatureColumn{
    "motor_temp_c", -273.15, 1000.0,
    [](Sample& s, std::size_t k, double v) { s.wheels[k].motor_temp_c = v; }};

// All columns of the rover, or of a wheel: those above and those of the channels' own.
std::vector<SampleColumn> columns_known(bool per_wheel) {
  std::vector<SampleColumn> all;
  if (per_wheel)
    all.assign(kWheelCommandColumns.begin(), kWheelCommandColumns.end());
  else
    all.assign(kColumns.begin(), kColumns.end());
  for (const gap::ChannelRow& row : gap::channel_catalogue())
    if (row.per_wheel == per_wheel && !row.column.name.empty()) all.push_back(row.column);
  if (per_wheel) all.push_back(kMotorTemperatureColumn);
  return all;
}

// Measured as a whole or not at all: indices into kColumns.
struct Group {
  std::string_view name;
  std::array<std::size_t, 3> columns;
  std::size_t alone = kNowhere;  // what may be there without the others: a heading without an inclinometer
};
constexpr std::array<Group, 2> kGroups{{{"a position", {1, 2, 3}}, {"an attitude", {4, 5, 6}, 6}}};

struct Column {
  std::string name;
  const SampleColumn* known = nullptr;  // nullptr: passed over
  std::size_t wheel = 0;
};

// Bytes from outside as a message may hold them.
std::string printable(std::string_view text) {
  std::string shown(text);
  std::replace_if(
      shown.begin(), shown.end(),
      [](char c) { return static_cast<unsigned char>(c) < 0x20U || static_cast<unsigned char>(c) >= 0x7FU; },
      '?');
  return shown;
}

std::string shown(std::string_view text) {
  return in_quotes(printable(text));
}

// "lf" of "lf_rate_deg_s"; "" where the column is not of this kind.
std::string_view wheel_in(std::string_view name, const SampleColumn& column) {
  if (name.size() < column.name.size() + 2 || !name.ends_with(column.name)) return {};
  const std::string_view wheel = name.substr(0, name.size() - column.name.size() - 1);
  return name[wheel.size()] == '_' ? wheel : std::string_view();
}

class Reader {
 public:
  Reader(const std::string& file, const std::vector<std::string>& wheels) : file_(file), wheels_(wheels) {}

  DriveSeries read(std::string_view bytes, std::size_t most_rows) {
    const std::vector<CsvLine> lines = csv_lines(bytes);
    if (lines.empty()) {
      fault(1, 0, "the file is empty, must have a header and two rows at least");
      return finish();
    }
    if (const std::size_t columns = csv_cells(lines[0].text).size(); columns > kMaxColumns) {
      fault(lines[0].number, 0, fmt::format("{} columns, must be {} at most", columns, kMaxColumns));
      return finish();
    }
    if (const auto wrong = wrong_separator(lines[0].text, kSeparator)) {
      fault(lines[0].number, 0,
            fmt::format("{}: write the file with commas, or read it with slipway import, whose mapping names "
                        "the separator",
                        *wrong));
      return finish();
    }
    read_header(lines[0]);
    const std::size_t rows = lines.size() - 1;
    if (rows < 2)
      fault(lines.back().number, 0,
            fmt::format("the file ends after {} rows of measurements, must have 2", rows));
    if (rows > most_rows) {
      fault(lines[1 + most_rows].number, 0,
            fmt::format("{} rows here, and only {} more of this campaign can be held: leave out samples",
                        rows, most_rows));
      return finish();
    }
    series_.samples.reserve(rows);
    for (std::size_t i = 1; i < lines.size(); ++i) read_row(lines[i]);
    return finish();
  }

 private:
  // column: from 0, also one behind the last.
  void fault(std::size_t line, std::size_t column, const std::string& message) {
    if (++faults_ > kMaxFaults) return;
    const std::string name = column < columns_.size() ? printable(columns_[column].name) : "";
    series_.faults.push_back({fmt::format("{}#/{}{}{}", file_, line, name.empty() ? "" : "/", name),
                              fmt::format("{}, line {}, column {}{}: {}", file_, line, column + 1,
                                          name.empty() ? "" : fmt::format(" ({})", name), message)});
  }

  DriveSeries finish() {
    if (faults_ > kMaxFaults)
      series_.faults.push_back(
          {file_ + "#", fmt::format("{}: {} faults more like these", file_, faults_ - kMaxFaults)});
    return std::move(series_);
  }

  void read_header(const CsvLine& line) {
    line_ = line.number;
    for (const std::string_view name : csv_cells(line.text)) columns_.push_back({std::string(name)});
    places_.assign(rover_columns_.size(), kNowhere);
    for (std::size_t c = 0; c < columns_.size(); ++c) {
      read_column(c);
      numbers_before_.push_back(numbers_before_.back() + (columns_[c].known != nullptr ? 1 : 0));
    }
    if (places_[kTime] == kNowhere) fault(line_, 0, "there is no column t_s, which every file must have");
    for (const Group& group : kGroups) check_columns(group);
  }

  void read_column(std::size_t c) {
    const std::string& name = columns_[c].name;
    if (name.empty()) return fault(line_, c, "the column has no name");
    for (std::size_t before = 0; before < c; ++before)
      if (columns_[before].name == name)
        return fault(line_, c, fmt::format("{} is column {} as well", shown(name), before + 1));
    for (std::size_t i = 0; i < rover_columns_.size(); ++i) {
      if (rover_columns_[i].name != name) continue;
      columns_[c].known = &rover_columns_[i];
      places_[i] = c;
      return;
    }
    if (!is_wheel_column(c)) series_.passed_over.insert(printable(name));
  }

  bool is_wheel_column(std::size_t c) {
    for (const SampleColumn& column : wheel_columns_) {
      const std::string_view wheel = wheel_in(columns_[c].name, column);
      const auto at = std::find(wheels_.begin(), wheels_.end(), wheel);
      if (wheel.empty() || at == wheels_.end()) continue;
      columns_[c].known = &column;
      columns_[c].wheel = static_cast<std::size_t>(at - wheels_.begin());
      return true;
    }
    return false;
  }

  void check_columns(const Group& group) {
    std::vector<std::string_view> there, absent;
    std::size_t first = kNowhere;
    bool others = false;
    for (const std::size_t column : group.columns) {
      others = others || (column != group.alone && places_[column] != kNowhere);
      (places_[column] == kNowhere ? absent : there).push_back(rover_columns_[column].name);
      first = std::min(first, places_[column]);
    }
    if (others && !absent.empty())
      fault(line_, first,
            fmt::format("{} is measured as a whole or not at all; there is {}, but no column {}", group.name,
                        fmt::join(there, ", "), fmt::join(absent, ", ")));
  }

  void read_row(const CsvLine& line) {
    line_ = line.number;
    const std::vector<std::string_view> cells = csv_cells(line.text);
    if (cells.size() != columns_.size()) return read_torn_row(cells);
    gap::DriveSample sample;
    sample.wheels = sim::PerWheel<gap::WheelReading>(wheels_.size());
    for (std::size_t c = 0; c < cells.size(); ++c)
      if (read_cell(c, cells[c], sample) && c == places_[kTime]) check_time(sample.time_s);
    for (const Group& group : kGroups) check_cells(group, cells);
    series_.samples.push_back(sample);
  }

  // A row with too few or too many cells. A cell may belong to a column as far away as cells are too few or
  // too many: it is reported where it would be no number in any of them.
  void read_torn_row(std::span<const std::string_view> cells) {
    const std::size_t columns = columns_.size();
    fault(line_, std::min(cells.size(), columns),
          fmt::format("the row has {} cells, must have {} as the header", cells.size(), columns));
    if (cells.size() < 2) return;  // written with another separator than the header: the fault says enough
    const std::size_t lacking = columns - std::min(cells.size(), columns);
    const std::size_t excess = cells.size() - std::min(cells.size(), columns);
    for (std::size_t c = 0; c < std::min(cells.size(), columns); ++c) {
      const std::size_t first = c - std::min(c, excess), end = c + lacking + 1;
      if (numbers_before_[end] - numbers_before_[first] == end - first && !cells[c].empty())
        number_in(c, cells[c]);
    }
  }

  std::optional<double> number_in(std::size_t c, std::string_view cell) {
    const std::optional<double> value = csv_number(cell);
    if (!value) fault(line_, c, shown(cell) + " is no finite number");
    return value;
  }

  // Whether there was a value, and it was good.
  bool read_cell(std::size_t c, std::string_view cell, gap::DriveSample& sample) {
    const SampleColumn* const column = columns_[c].known;
    if (column == nullptr) return false;
    if (cell.empty()) {
      if (column == &rover_columns_[kTime]) fault(line_, c, "the cell is empty: every row has its time");
      return false;
    }
    const std::optional<double> value = number_in(c, cell);
    if (!value) return false;
    if (*value < column->lowest || *value > column->highest) {
      fault(line_, c, fmt::format("{}, must be in [{}, {}]", *value, column->lowest, column->highest));
      return false;
    }
    column->set(sample, columns_[c].wheel, *value);
    return true;
  }

  void check_time(double time_s) {
    if (last_time_s_ && !(time_s > *last_time_s_))
      fault(line_, places_[kTime],
            fmt::format("t_s = {} s after {} s, time must increase from row to row", time_s, *last_time_s_));
    last_time_s_ = time_s;
  }

  void check_cells(const Group& group, std::span<const std::string_view> cells) {
    std::size_t absent = kNowhere;
    bool others = false;
    for (const std::size_t column : group.columns) {
      const std::size_t place = places_[column];
      if (place == kNowhere) return;  // reported of the header, or alone
      if (cells[place].empty())
        absent = std::min(absent, place);
      else
        others = others || column != group.alone;
    }
    if (others && absent != kNowhere)
      fault(line_, absent,
            fmt::format("the cell is empty where others of the row are not: {} is measured as a whole or not "
                        "at all",
                        group.name));
  }

  const std::string& file_;
  const std::vector<std::string>& wheels_;
  std::vector<Column> columns_;
  std::vector<std::size_t> numbers_before_{0};  // how many columns before each are known
  std::vector<SampleColumn> rover_columns_ = columns_known(false), wheel_columns_ = columns_known(true);
  std::vector<std::size_t> places_;  // where each of rover_columns_ is
  std::size_t line_ = 0;
  std::optional<double> last_time_s_;
  std::size_t faults_ = 0;
  DriveSeries series_;
};

}  // namespace

DriveSeries read_drive_series(std::string_view bytes, const std::string& file,
                              const std::vector<std::string>& wheels, std::size_t most_rows) {
  return Reader(file, wheels).read(bytes, most_rows);
}

std::optional<std::string> column_meant(std::string_view name, const std::vector<std::string>& wheels) {
  std::string lower(name);
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  std::vector<std::string> known;
  for (const SampleColumn& column : columns_known(false)) known.emplace_back(column.name);
  for (const SampleColumn& column : columns_known(true)) {
    if (const std::string_view wheel = wheel_in(lower, column); !wheel.empty()) {
      // "yaw_rate_deg_s" and "bus_current_a" are nobody's wheel; two letters are meant as one.
      const auto meant = nearest(wheel, wheels);
      const bool alike = meant && wheel.find_first_of(*meant) != std::string_view::npos;
      if (!alike || wheel.size() == 3 || wheel.size() == 4) return std::nullopt;
      return fmt::format("{}_{}", *meant, column.name);
    }
    for (const std::string& wheel : wheels) known.push_back(fmt::format("{}_{}", wheel, column.name));
  }
  return nearest(lower, known);
}

}  // namespace slipway::api
