#include "api/files/legend_csv.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <optional>

#include "api/files/relief_values.h"
#include "api/json/faults.h"
#include "core/text_table.h"

namespace slipway::api {
namespace {

enum Column : std::size_t { kValue, kLabel, kSoil, kRockShare };
const std::vector<std::string> kColumns{"value", "label", "soil", "rock_share"};

class LegendReader {
 public:
  LegendReader(TextTable table, std::string_view file, bool polygons)
      : table_(std::move(table)), file_(file), polygons_(polygons) {}

  Result<LegendTable> read() {
    header_ = find_columns(table_, file_, kColumns, faults_);
    if (!polygons_ && !header_.places[kValue]) missing(kValue, ": the raster's number of the class");
    for (const Column column : {kLabel, kSoil})
      if (!header_.places[column]) missing(column, "");
    if (faults_.empty())
      for (std::size_t row = 0; row < table_.rows(); ++row) read_row(row);
    if (!faults_.empty()) return fail(ErrorCode::kUnreadableData, summary_of(faults_), faults_);
    legend_.notes = table_.notes();
    return std::move(legend_);
  }

 private:
  void missing(Column column, std::string_view what) {
    faults_.push_back(
        {std::string(file_), fmt::format("the column {} is missing{}", kColumns[column], what)});
  }

  void fault(std::size_t row, std::optional<Column> column, std::string message) {
    std::string place = fmt::format("{}, line {}", file_, table_.line(row));
    if (column) place += fmt::format(", column {} ({})", *header_.places[*column] + 1, kColumns[*column]);
    faults_.push_back({std::move(place), std::move(message)});
  }

  void read_row(std::size_t row) {
    const std::vector<std::string> cells = table_.cells(row);
    if (cells.size() != header_.width)
      return fault(row, std::nullopt,
                   fmt::format("{} cells, must be {} as in the header", cells.size(), header_.width));
    dem::SoilClass& entry = legend_.classes.emplace_back();
    entry.value = static_cast<int>(legend_.classes.size() - 1);
    if (!polygons_) {
      const auto value = number(row, cells, kValue, -32768, 32767);
      if (is_missing_cell(cells[*header_.places[kValue]])) fault(row, kValue, "value is empty");
      if (value && *value != std::floor(*value)) fault(row, kValue, "value must be a whole number");
      entry.value = static_cast<int>(value.value_or(0.0));
    }
    entry.label = label(cells[*header_.places[kLabel]]);
    if (entry.label.empty()) fault(row, kLabel, "label is empty");
    if (const std::string& soil = cells[*header_.places[kSoil]]; !is_missing_cell(soil)) entry.soil = soil;
    entry.rock_share =
        number(row, cells, kRockShare, json::kRockShareRule.lowest, json::kRockShareRule.highest);
  }

  // Of polygons a number that is whole is its digits, as dem::read_soil_polygons() reads their property.
  std::string label(const std::string& cell) const {
    const auto value = table_.number(cell);
    if (!polygons_ || !value || *value != std::round(*value) || std::abs(*value) > 9e15) return cell;
    return cell.find_first_of(".,") == std::string::npos ? cell : fmt::format("{:.0f}", *value);
  }

  std::optional<double> number(std::size_t row, const std::vector<std::string>& cells, Column column,
                               double least, double most) {
    if (!header_.places[column]) return std::nullopt;
    const std::string& cell = cells[*header_.places[column]];
    if (is_missing_cell(cell)) return std::nullopt;
    const auto value = table_.number(cell);
    if (value && *value >= least && *value <= most) return value;
    fault(
        row, column,
        fmt::format("{} = {}, must be a number in [{}, {}]", kColumns[column], in_quotes(cell), least, most));
    return std::nullopt;
  }

  TextTable table_;
  std::string_view file_;
  bool polygons_;
  CsvHeader header_;
  LegendTable legend_;
  std::vector<Fault> faults_;
};

}  // namespace

Result<LegendTable> read_legend_table(std::string_view text, std::string_view file, bool polygons) {
  auto table = read_text_table(text, file);
  if (!table) return fail(std::move(table.error()));
  if (table->names().empty())
    return fail(ErrorCode::kUnreadableData, fmt::format("{} is empty", file),
                {{std::string(file), "is empty"}});
  return LegendReader(*std::move(table), file, polygons).read();
}

}  // namespace slipway::api
