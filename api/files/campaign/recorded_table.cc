#include "api/files/campaign/recorded_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "api/json/faults.h"
#include "core/csv_cells.h"

namespace slipway::api {
namespace {

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

class TableReader {
 public:
  TableReader(std::string file, char separator, std::vector<Fault>& faults)
      : file_(std::move(file)), separator_(separator), faults_(faults) {}

  // Only cells of the columns that are asked for must be numbers.
  RecordedTable read(std::string_view bytes, const std::set<std::string>& asked) {
    const std::vector<CsvLine> lines = csv_lines(bytes);
    RecordedTable table;
    if (lines.size() < 3) {
      fault("",
            fmt::format("{} has {} lines, must have a header and two rows at least", file_, lines.size()));
      return table;
    }
    for (const std::string_view name : csv_cells(lines[0].text, separator_))
      table.names.emplace_back(unquoted(name));
    if (table.names.size() == 1 && !asked.contains(table.names.front())) {
      const auto wrong = wrong_separator(lines[0].text, separator_);
      fault("/1", fmt::format("{}, line {}, column 1: {}: change the key separator of the mapping", file_,
                              lines[0].number, wrong.value_or("the header is a single column")));
      return table;
    }
    refuse_twins(lines[0].number, asked, table.names);
    for (std::size_t i = 1; i < lines.size(); ++i) read_row(lines[i], asked, table);
    if (count_ > kMaxFaultsOfFile)
      faults_.push_back(
          {file_ + "#", fmt::format("{}: {} faults more like these", file_, count_ - kMaxFaultsOfFile)});
    return table;
  }

 private:
  static std::string_view unquoted(std::string_view name) {
    if (name.size() >= 2 && name.front() == '"' && name.back() == '"') return name.substr(1, name.size() - 2);
    return name;
  }

  void fault(const std::string& place, const std::string& message) {
    if (++count_ <= kMaxFaultsOfFile) faults_.push_back({file_ + "#" + place, message});
  }

  // Which of two columns of one name is meant, nobody can say.
  void refuse_twins(std::size_t line, const std::set<std::string>& asked,
                    const std::vector<std::string>& names) {
    for (const std::string& name : asked)
      if (const auto count = std::count(names.begin(), names.end(), name); count > 1)
        fault(fmt::format("/{}/{}", line, name),
              fmt::format("{}, line {} ({}): {} columns have this name, must be one: rename the others",
                          file_, line, name, count));
  }

  void read_row(const CsvLine& line, const std::set<std::string>& asked, RecordedTable& table) {
    const std::vector<std::string_view> cells = csv_cells(line.text, separator_);
    if (cells.size() != table.names.size())
      return fault(fmt::format("/{}", line.number),
                   fmt::format("{}, line {}: {} cells, must have {} as the header", file_, line.number,
                               cells.size(), table.names.size()));
    table.lines.push_back(line.number);
    std::vector<double>& row = table.rows.emplace_back();
    for (std::size_t c = 0; c < cells.size(); ++c) {
      row.push_back(kMissing);
      if (!asked.contains(table.names[c]) || is_missing(cells[c])) continue;
      if (const auto number = csv_number(cells[c]))
        row.back() = *number;
      else
        fault(fmt::format("/{}/{}", line.number, table.names[c]),
              fmt::format("{}, line {} ({}): {} is no finite number", file_, line.number, table.names[c],
                          in_quotes(cells[c])));
    }
  }

  static bool is_missing(std::string_view cell) {
    return cell.empty() || cell == "nan" || cell == "NaN" || cell == "NA" || cell == "null";
  }

  std::string file_;
  char separator_;
  std::vector<Fault>& faults_;
  std::size_t count_ = 0;
};

}  // namespace

RecordedTable read_recorded_table(std::string_view bytes, const std::string& file, char separator,
                                  const std::set<std::string>& asked, std::vector<Fault>& faults) {
  return TableReader(file, separator, faults).read(bytes, asked);
}

}  // namespace slipway::api
