#include "api/files/telemetry_csv.h"

#include <fmt/format.h>

#include <array>
#include <utility>

#include "api/json/faults.h"
#include "core/angle.h"
#include "core/text_table.h"

namespace slipway::api {
namespace {

constexpr std::size_t kMaxRows = 5000;
constexpr std::size_t kMaxFaults = 100;
constexpr std::string_view kCurrentOfWheel = "_current_a";

struct Column {
  std::string_view name;
  double lowest, highest;
  bool required = false;
};
enum Place : std::size_t { kDriven, kX, kY, kTime, kYaw, kCurrent, kColumns };
constexpr std::array<Column, kColumns> kKnown{{{"driven_m", 0.0, 1e6, true},
                                               {"x_m", -1e8, 1e8, true},
                                               {"y_m", -1e8, 1e8, true},
                                               {"time_s", -1e12, 1e12},
                                               {"yaw_deg", -360.0, 360.0},
                                               {"current_a", 0.0, 1000.0}}};
constexpr Column kWheelCurrent{"", 0.0, 1000.0};

class Reader {
 public:
  explicit Reader(std::string_view file) : file_(file) {}

  Result<planner::DriveSoFar> read(std::string_view bytes) {
    auto table = read_text_table(bytes, file_);
    if (!table) return fail(std::move(table.error()));
    table_ = *std::move(table);
    if (table_.rows() < 2) {
      fault(std::string(file_), "there must be a header and two rows or more");
    } else if (table_.rows() > kMaxRows) {
      fault(std::string(file_), fmt::format("{} rows, must be {} at most", table_.rows(), kMaxRows));
    } else {
      read_header();
      for (std::size_t k = 0; k < table_.rows(); ++k) read_row(k);
      if (faults_.empty()) check_between_rows();
    }
    if (faults_.empty()) return std::move(drive_);
    if (faults_.size() > kMaxFaults) {
      const std::size_t more = faults_.size() - kMaxFaults;
      faults_.resize(kMaxFaults);
      fault(std::string(file_), fmt::format("{} faults more like these", more));
    }
    return fail(ErrorCode::kUnreadableData, fmt::format("{} can't be read", file_), std::move(faults_));
  }

 private:
  void fault(std::string place, std::string message) {
    faults_.push_back({std::move(place), std::move(message)});
  }
  std::string line_of(std::size_t row) const { return fmt::format("{}, line {}", file_, table_.line(row)); }

  void read_header() {
    const std::string line = fmt::format("{}, line {}", file_, table_.header_line());
    std::vector<std::string> known;
    for (const Column& column : kKnown) known.emplace_back(column.name);
    for (const std::string& name : table_.names())
      if (name.size() > kCurrentOfWheel.size() && name.ends_with(kCurrentOfWheel)) {
        wheels_.emplace_back(name.substr(0, name.size() - kCurrentOfWheel.size()));
        known.emplace_back(name);
      }
    header_ = find_columns(table_, file_, known, faults_);
    for (std::size_t k = 0; k < kColumns; ++k)
      if (kKnown[k].required && !header_.places[k])
        fault(line, fmt::format("there is no column {}", kKnown[k].name));
    if (header_.places[kCurrent] && !wheels_.empty())
      fault(line, "current_a and the currents of wheels exclude each other");
  }

  std::optional<double> number(std::size_t row, const std::vector<std::string>& cells, std::size_t place,
                               std::string_view name, const Column& column) {
    if (!header_.places[place] || *header_.places[place] >= cells.size()) return std::nullopt;
    const std::string& cell = cells[*header_.places[place]];
    const std::string where =
        fmt::format("{}, column {} ({})", line_of(row), *header_.places[place] + 1, name);
    if (is_missing_cell(cell)) {
      if (column.required) fault(where, fmt::format("{} is missing", name));
      return std::nullopt;
    }
    const std::optional<double> value = table_.number(cell);
    if (!value)
      fault(where, fmt::format("{} is no number", in_quotes(cell)));
    else if (*value < column.lowest || *value > column.highest)
      fault(where,
            fmt::format("{} = {:g}, must be in [{:g}, {:g}]", name, *value, column.lowest, column.highest));
    return value;
  }

  void read_row(std::size_t line) {
    const std::vector<std::string> cells = table_.cells(line);
    if (cells.size() != header_.width)
      fault(line_of(line), fmt::format("{} cells, must be {} as in the header", cells.size(), header_.width));
    const auto value = [&](Place place) {
      return number(line, cells, place, kKnown[place].name, kKnown[place]);
    };
    planner::TelemetryRow& row = drive_.rows.emplace_back();
    row.driven_m = value(kDriven).value_or(0.0);
    row.x_m = value(kX).value_or(0.0);
    row.y_m = value(kY).value_or(0.0);
    row.time_s = value(kTime);
    if (const auto yaw_deg = value(kYaw)) row.yaw_rad = rad_from_deg(*yaw_deg);
    row.current_a = value(kCurrent);
    for (std::size_t k = 0; k < wheels_.size(); ++k)
      if (const auto current_a = number(line, cells, kColumns + k,
                                        fmt::format("{}{}", wheels_[k], kCurrentOfWheel), kWheelCurrent))
        row.currents_a[wheels_[k]] = *current_a;
  }

  // "/rows/3/driven_m" is a line of the file.
  void check_between_rows() {
    for (const Fault& each : planner::faults_of(drive_)) {
      constexpr std::string_view kRows = "/rows/";
      std::string place(file_);
      if (each.pointer.starts_with(kRows)) place = line_of(std::stoul(each.pointer.substr(kRows.size())));
      fault(std::move(place), each.message);
    }
  }

  std::string_view file_;
  TextTable table_;
  CsvHeader header_{std::vector<std::optional<std::size_t>>(kColumns), 0};
  std::vector<std::string> wheels_;
  planner::DriveSoFar drive_;
  std::vector<Fault> faults_;
};

}  // namespace

Result<planner::DriveSoFar> read_telemetry_csv(std::string_view bytes, std::string_view file) {
  return Reader(file).read(bytes);
}

}  // namespace slipway::api
