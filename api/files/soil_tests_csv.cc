#include "api/files/soil_tests_csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numbers>
#include <optional>

#include "api/json/faults.h"
#include "core/angle.h"
#include "core/text_table.h"

namespace slipway::api {
namespace {

constexpr std::size_t kMaxRows = 20'000;

using Column = TestColumn;

constexpr std::array<Column, 15> kWheelColumns{{{"load_n", 0.0, 1e6, true, true},
                                                {"slip_ratio", -1.0, 1.0, true},
                                                {"slip_angle_deg", -90.0, 90.0},
                                                {"torque_nm", -1e5, 1e5},
                                                {"drawbar_pull_n", -1e6, 1e6},
                                                {"thrust_n", -1e6, 1e6},
                                                {"sinkage_m", 0.0, 2.0},
                                                {"current_a", -1e3, 1e3},
                                                {"lateral_force_n", -1e6, 1e6},
                                                {"torque_std_nm", 0.0, 1e5, false, true},
                                                {"drawbar_pull_std_n", 0.0, 1e6, false, true},
                                                {"thrust_std_n", 0.0, 1e6, false, true},
                                                {"sinkage_std_m", 0.0, 2.0, false, true},
                                                {"current_std_a", 0.0, 1e3, false, true},
                                                {"lateral_force_std_n", 0.0, 1e6, false, true}}};
constexpr std::size_t kFirstReading = 3, kFirstStd = kFirstReading + gap::kWheelChannels;
static_assert(kWheelColumns.size() == kFirstStd + gap::kWheelChannels);

// What a row names.
constexpr std::array<std::string_view, 2> kWheelNames{"wheel", "soil"};
constexpr std::size_t kMaxName = 64;
bool is_name(std::string_view text) {
  return !text.empty() && text.size() <= kMaxName &&
         text.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_-") == std::string_view::npos;
}

constexpr std::array<Column, 5> kPlateColumns{{{"plate_radius_m", 0.001, 5.0, true},
                                               {"sinkage_m", -1.0, 5.0, true},
                                               {"pressure_pa", -1e9, 1e9},
                                               {"force_n", -1e9, 1e9},
                                               {"test", 0.0, 1e9}}};

// Rows of numbers, and of names, under known columns; what is wrong is written down with its place.
template <std::size_t Count>
class Table {
 public:
  Table(std::string_view file, const std::array<Column, Count>& columns,
        std::span<const std::string_view> names = {})
      : file_(file), columns_(columns), names_(names) {}

  struct Row {
    std::size_t line = 0;
    std::array<std::optional<double>, Count> values;
    std::vector<std::string> names;  // empty where there is no such column
  };

  std::vector<Row> read(std::string_view text) {
    std::vector<Row> rows;
    auto read = read_text_table(text, file_);
    if (!read) {
      faults_ = std::move(read.error().faults);
      return rows;
    }
    text_ = *std::move(read);
    if (text_.names().empty()) {
      faults_.push_back({std::string(file_), "the file is empty"});
    } else if (text_.rows() > kMaxRows) {
      faults_.push_back(
          {std::string(file_), fmt::format("{} rows, must be {} at most", text_.rows(), kMaxRows)});
    } else {
      read_header();
      for (std::size_t i = 0; i < text_.rows(); ++i) rows.push_back(read_row(i));
      if (text_.rows() == 0) faults_.push_back({std::string(file_), "there are no rows under the header"});
    }
    return rows;
  }

  bool has(std::size_t column) const { return header_.places[column].has_value(); }
  void fault(std::size_t line, std::string message) {
    faults_.push_back({fmt::format("{}, line {}", file_, line), std::move(message)});
  }
  std::vector<Fault>& faults() { return faults_; }

 private:
  void read_header() {
    std::vector<std::string> known;
    for (const Column& column : columns_) known.emplace_back(column.name);
    for (const std::string_view name : names_) known.emplace_back(name);
    header_ = find_columns(text_, file_, known, faults_);
    for (std::size_t k = 0; k < Count; ++k)
      if (columns_[k].required && !header_.places[k])
        fault(text_.header_line(), fmt::format("there is no column {}", columns_[k].name));
  }

  Row read_row(std::size_t index) {
    const std::size_t line = text_.line(index);
    Row row{line, {}, std::vector<std::string>(names_.size())};
    const std::vector<std::string> cells = text_.cells(index);
    if (cells.size() != header_.width)
      fault(line, fmt::format("{} cells, must be {} as in the header", cells.size(), header_.width));
    for (std::size_t k = 0; k < Count; ++k) {
      if (!header_.places[k] || *header_.places[k] >= cells.size()) continue;
      const Column& column = columns_[k];
      const std::string& cell = cells[*header_.places[k]];
      const std::string place =
          fmt::format("{}, line {}, column {} ({})", file_, line, *header_.places[k] + 1, column.name);
      if (is_missing_cell(cell)) {
        if (column.required) faults_.push_back({place, fmt::format("{} is missing", column.name)});
        continue;
      }
      const std::optional<double> value = text_.number(cell);
      if (!value)
        faults_.push_back({place, fmt::format("{} is no number", in_quotes(cell))});
      else if (*value < column.lowest || *value > column.highest ||
               (column.above_lowest && *value == column.lowest))
        faults_.push_back(
            {place, fmt::format("{} = {:g}, must be in {}{:g}, {:g}]", column.name, *value,
                                column.above_lowest ? "(" : "[", column.lowest, column.highest)});
      else
        row.values[k] = value;
    }
    for (std::size_t k = 0; k < names_.size(); ++k) {
      const auto place = header_.places[Count + k];
      if (!place || *place >= cells.size()) continue;
      row.names[k] = cells[*place];
      if (!is_name(row.names[k]))
        faults_.push_back(
            {fmt::format("{}, line {}, column {} ({})", file_, line, *place + 1, names_[k]),
             fmt::format("{} is no name of small letters, digits, - and _", in_quotes(row.names[k]))});
    }
    return row;
  }

  std::string_view file_;
  const std::array<Column, Count>& columns_;
  std::span<const std::string_view> names_;
  TextTable text_;
  CsvHeader header_{std::vector<std::optional<std::size_t>>(Count + names_.size()), 0};
  std::vector<Fault> faults_;
};

// A file may be wrong in every cell: so many faults are reported one by one, and how many more there are.
constexpr std::size_t kMaxFaults = 100;

tl::unexpected<Error> unreadable(std::string_view file, std::vector<Fault> faults) {
  if (faults.size() > kMaxFaults) {
    const std::size_t more = faults.size() - kMaxFaults;
    faults.resize(kMaxFaults);
    faults.push_back({std::string(file), fmt::format("{} faults more like these", more)});
  }
  return fail(ErrorCode::kUnreadableData, fmt::format("{} can't be read", file), std::move(faults));
}

}  // namespace

std::span<const TestColumn> wheel_test_columns() {
  return kWheelColumns;
}

gap::WheelObservation wheel_observation(std::span<const std::optional<double>> values,
                                        std::vector<std::string>& faults) {
  gap::WheelObservation o;
  o.test.load_n = values[0].value_or(1.0);
  o.test.slip = values[1].value_or(0.0);
  o.test.slip_angle_rad = rad_from_deg(values[2].value_or(0.0));
  bool any = false;
  for (std::size_t c = 0; c < gap::kWheelChannels; ++c) {
    o.readings[c] = {values[kFirstReading + c], values[kFirstStd + c]};
    any = any || o.readings[c].value;
    if (o.readings[c].std && !o.readings[c].value)
      faults.push_back(fmt::format("{} is given without {}", kWheelColumns[kFirstStd + c].name,
                                   kWheelColumns[kFirstReading + c].name));
  }
  if (!any && faults.empty()) faults.emplace_back("nothing was measured");
  return o;
}

Result<std::vector<gap::WheelObservation>> read_wheel_tests_csv(std::string_view file,
                                                                std::string_view text) {
  Table table(file, kWheelColumns, kWheelNames);
  const auto rows = table.read(text);
  std::vector<gap::WheelObservation> observations;
  const bool sound = table.faults().empty();
  for (const auto& row : rows) {
    std::vector<std::string> faults;
    observations.push_back(wheel_observation(row.values, faults));
    observations.back().wheel = row.names[0];
    observations.back().soil = row.names[1];
    for (std::size_t i = 0; sound && i < faults.size(); ++i) table.fault(row.line, faults[i]);
  }
  if (!table.faults().empty()) return unreadable(file, std::move(table.faults()));
  return observations;
}

Result<std::vector<gap::PlateRecord>> read_plate_tests_csv(std::string_view file, std::string_view text) {
  Table table(file, kPlateColumns);
  const auto rows = table.read(text);
  if (table.faults().empty() && table.has(2) == table.has(3))
    table.fault(1, table.has(2) ? "there are both columns pressure_pa and force_n: one of them is enough"
                                : "there is no column pressure_pa or force_n");
  std::vector<gap::PlateRecord> tests;
  std::optional<double> test;
  for (const auto& row : rows) {
    const double radius = row.values[0].value_or(1.0), sinkage = row.values[1].value_or(0.0);
    if (tests.empty() || tests.back().radius_m != radius || row.values[4] != test)
      tests.push_back({radius, {}, {}});
    test = row.values[4];
    const std::optional<double> load = table.has(2) ? row.values[2] : row.values[3];
    if (!load) {
      if (table.faults().empty())
        table.fault(row.line, fmt::format("{} is missing", table.has(2) ? "pressure_pa" : "force_n"));
      continue;
    }
    if (!(sinkage > 0.0)) continue;
    tests.back().sinkage_m.push_back(sinkage);
    tests.back().pressure_pa.push_back(table.has(2) ? *load : *load / (std::numbers::pi * radius * radius));
  }
  if (!table.faults().empty()) return unreadable(file, std::move(table.faults()));
  return tests;
}

}  // namespace slipway::api
