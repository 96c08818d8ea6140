#include "api/files/commands_csv.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <optional>

#include "api/json/faults.h"
#include "core/angle.h"
#include "core/text_table.h"

namespace slipway::api {
namespace {

constexpr std::size_t kMaxFaults = 100;
const std::vector<std::string> kColumns{"command", "value", "radius_m"};
enum Column : std::size_t { kCommand, kValue, kRadius };

struct Range {
  double lowest, highest;
};
constexpr Range kLength_m{0.0, 1000.0}, kTurn_deg{-360.0, 360.0}, kRadius_m{-1e6, 1e6}, kMap_m{-1e8, 1e8};

class Reader {
 public:
  explicit Reader(std::string_view file) : file_(file) {}

  Result<CommandsTable> read(std::string_view bytes) {
    auto text = read_text_table(bytes, file_, {.comment = '#'});
    if (!text) return fail(std::move(text.error()));
    text_ = *std::move(text);
    for (const CsvLine& line : text_.comments()) read_comment(line);
    if (text_.names().empty()) {
      faults_.push_back({std::string(file_), "there is no row command,value,radius_m"});
    } else {
      header_ = find_columns(text_, file_, kColumns, faults_);
      for (std::size_t k = 0; k < kColumns.size(); ++k)
        if (!header_.places[k]) fault(text_.header_line(), fmt::format("there is no column {}", kColumns[k]));
      for (std::size_t k = 0; k < text_.rows() && faults_.size() < kMaxFaults; ++k) read_row(k);
      if (table_.commands.empty() && faults_.empty())
        faults_.push_back({std::string(file_), "there must be a command"});
    }
    for (std::size_t k = 0; k < kStart.size(); ++k)
      if (!start_[k])
        faults_.push_back({std::string(file_), fmt::format("there is no line \"# {}: ...\"", kStart[k])});
    if (!faults_.empty())
      return fail(ErrorCode::kInvalidRequest, fmt::format("{} can't be read", file_), std::move(faults_));
    table_.start = {*start_[0], *start_[1], rad_from_deg(*start_[2])};
    return std::move(table_);
  }

 private:
  static constexpr std::array<std::string_view, 3> kStart{"start_x_m", "start_y_m", "start_yaw_deg"};

  void fault(std::size_t line, std::string message, std::optional<std::size_t> column = std::nullopt) {
    std::string place = fmt::format("{}, line {}", file_, line);
    if (column) place += fmt::format(", column {}", *column + 1);
    faults_.push_back({std::move(place), std::move(message)});
  }

  std::optional<double> number(std::size_t line, std::string_view cell, std::string_view name,
                               const Range& range, std::optional<std::size_t> column = std::nullopt) {
    const auto value = text_.number(cell);
    if (!value)
      fault(line, fmt::format("{} = {}, must be a number", name, in_quotes(cell)), column);
    else if (*value < range.lowest || *value > range.highest)
      fault(line,
            fmt::format("{} = {:g}, must be in [{:g}, {:g}]", name, *value, range.lowest, range.highest),
            column);
    else
      return value;
    return std::nullopt;
  }

  // "# rover: msl-class"
  void read_comment(const CsvLine& line) {
    const std::string_view text = line.text.substr(line.text.find('#') + 1);
    const std::size_t colon = text.find(':');
    if (colon == std::string_view::npos) return;
    const std::string_view key = csv_cells(text.substr(0, colon)).front();
    const std::string_view value = csv_cells(text.substr(colon + 1)).front();
    if (key == "terrain") table_.terrain = value;
    if (key == "rover") table_.rover = value;
    for (std::size_t k = 0; k < kStart.size(); ++k)
      if (key == kStart[k])
        // Where it is no number that is the fault, and not that it is missing.
        start_[k] = number(line.number, value, key, k == 2 ? kTurn_deg : kMap_m).value_or(0.0);
  }

  void read_row(std::size_t index) {
    const std::size_t line = text_.line(index);
    const std::vector<std::string> cells = text_.cells(index);
    if (cells.size() != header_.width)
      return fault(line, fmt::format("{} cells, must be {} as in the header", cells.size(), header_.width));
    for (const auto& place : header_.places)
      if (!place) return;  // said of the header
    const auto cell = [&](Column column) -> const std::string& { return cells[*header_.places[column]]; };
    const std::string& command = cell(kCommand);
    const bool arcs = command == "arc", turns = command == "turn";
    if (!arcs && !turns && command != "drive")
      return fault(line, fmt::format("command = {}, must be drive, arc or turn", in_quotes(command)),
                   header_.places[kCommand]);
    planner::DriveStep step;
    const auto value =
        number(line, cell(kValue), "value", turns ? kTurn_deg : kLength_m, header_.places[kValue]);
    if (value && !turns && *value <= 0.0) fault(line, "value must be over 0", header_.places[kValue]);
    (turns ? step.turn_rad : step.drive_m) = turns ? rad_from_deg(value.value_or(0.0)) : value.value_or(1.0);
    if (arcs)
      step.radius_m =
          number(line, cell(kRadius), "radius_m", kRadius_m, header_.places[kRadius]).value_or(1.0);
    else if (!is_missing_cell(cell(kRadius)))
      fault(line, fmt::format("a {} has no radius_m", command), header_.places[kRadius]);
    if (arcs && std::abs(step.radius_m) < 0.01)
      fault(line, "radius_m must be 0.01 m or more to the left, or as much below 0 to the right",
            header_.places[kRadius]);
    table_.commands.push_back(step);
    table_.lines.push_back(line);
  }

  std::string_view file_;
  TextTable text_;
  CsvHeader header_;
  CommandsTable table_;
  std::array<std::optional<double>, 3> start_;
  std::vector<Fault> faults_;
};

}  // namespace

std::string write_commands_csv(const CommandsTable& table) {
  std::string csv =
      fmt::format("# terrain: {}\n# rover: {}\n# start_x_m: {}\n# start_y_m: {}\n# start_yaw_deg: {:.12g}\n",
                  table.terrain, table.rover, table.start.x_m, table.start.y_m,
                  deg_from_rad(table.start.yaw_rad.value_or(0.0)));
  csv += "command,value,radius_m\n";
  for (const planner::DriveStep& step : table.commands) {
    if (step.drive_m <= 0.0)
      csv += fmt::format("turn,{:.12g},\n", deg_from_rad(step.turn_rad));
    else if (step.radius_m == 0.0)
      csv += fmt::format("drive,{},\n", step.drive_m);
    else
      csv += fmt::format("arc,{},{}\n", step.drive_m, step.radius_m);
  }
  return csv;
}

Result<CommandsTable> read_commands_csv(std::string_view bytes, std::string_view file) {
  return Reader(file).read(bytes);
}

}  // namespace slipway::api
