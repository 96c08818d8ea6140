#include "research/validation/report/csv_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "core/csv_cells.h"

namespace slipway::validation {
namespace {

std::vector<std::string> cells_of(std::string_view line) {
  const std::vector<std::string_view> cells = csv_cells(line);
  return {cells.begin(), cells.end()};
}

bool is_number(const std::string& cell) {
  char* end = nullptr;
  const double value = std::strtod(cell.c_str(), &end);
  return !cell.empty() && *end == '\0' && std::isfinite(value);
}

}  // namespace

Result<CsvTable> CsvTable::read(const std::filesystem::path& path, const Columns& columns) {
  std::ifstream file(path);
  if (!file) return fail(ErrorCode::kUnreadableData, fmt::format("cannot open {}", path.string()));
  CsvTable table;
  table.path_ = path.string();
  std::vector<Fault> faults;
  std::string line;
  std::getline(file, line);
  table.header_ = cells_of(line);
  for (const auto& names : {columns.numbers, columns.numbers_or_empty, columns.texts})
    for (const std::string& column : names)
      if (std::find(table.header_.begin(), table.header_.end(), column) == table.header_.end())
        faults.push_back({"/" + column, "the column is missing"});
  for (std::size_t number = 2; std::getline(file, line); ++number) {
    if (line.empty()) continue;
    table.cells_.push_back(cells_of(line));
    if (table.cells_.back().size() != table.header_.size())
      faults.push_back(
          {fmt::format("/{}", number),
           fmt::format("{} cells, must be {}", table.cells_.back().size(), table.header_.size())});
  }
  std::vector<std::string> there;
  std::copy_if(columns.numbers_if_there.begin(), columns.numbers_if_there.end(), std::back_inserter(there),
               [&](const std::string& column) { return table.has(column); });
  if (faults.empty()) {
    table.look_for_numbers(columns.numbers, false, faults);
    table.look_for_numbers(columns.numbers_or_empty, true, faults);
    table.look_for_numbers(there, true, faults);
  }
  if (!faults.empty())
    return fail(ErrorCode::kUnreadableData, fmt::format("{} is not as expected", table.path_),
                std::move(faults));
  return table;
}

bool CsvTable::has(std::string_view column) const {
  return std::find(header_.begin(), header_.end(), column) != header_.end();
}

std::size_t CsvTable::index(std::string_view column) const {
  const auto found = std::find(header_.begin(), header_.end(), column);
  if (found == header_.end()) throw std::out_of_range(fmt::format("{} has no column {}", path_, column));
  return static_cast<std::size_t>(found - header_.begin());
}

const std::string& CsvTable::text(std::size_t row, std::string_view column) const {
  return cells_.at(row)[index(column)];
}

double CsvTable::number(std::size_t row, std::string_view column) const {
  return std::strtod(text(row, column).c_str(), nullptr);
}

std::vector<double> CsvTable::numbers(std::string_view column) const {
  std::vector<double> values;
  for (std::size_t row = 0; row < rows(); ++row) values.push_back(number(row, column));
  return values;
}

void CsvTable::look_for_numbers(const std::vector<std::string>& columns, bool may_be_empty,
                                std::vector<Fault>& faults) const {
  for (const std::string& column : columns)
    for (std::size_t row = 0; row < rows(); ++row)
      if (!is_number(text(row, column)) && !(may_be_empty && empty(row, column)))
        faults.push_back({fmt::format("/{}/{}", row + 2, column),
                          fmt::format("\"{}\", must be a number", text(row, column))});
}

}  // namespace slipway::validation
