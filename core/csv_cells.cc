#include "core/csv_cells.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <system_error>

#include "core/fault_words.h"

namespace slipway {
namespace {

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
constexpr std::string_view kSpaces = " \t\r";

std::string_view trimmed(std::string_view cell) {
  const std::size_t begin = cell.find_first_not_of(kSpaces);
  if (begin == std::string_view::npos) return {};
  return cell.substr(begin, cell.find_last_not_of(kSpaces) + 1 - begin);
}

std::string separator_words(char separator) {
  return separator == '\t' ? "tabs" : in_quotes(std::string(1, separator));
}

}  // namespace

std::vector<CsvLine> csv_lines(std::string_view text) {
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  std::vector<CsvLine> lines;
  std::size_t number = 1;
  for (std::size_t begin = 0; begin < text.size(); ++number) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string_view line = text.substr(begin, end - begin);
    if (line.find_first_not_of(kSpaces) != std::string_view::npos) lines.push_back({line, number});
    begin = end + 1;
  }
  return lines;
}

std::vector<std::string_view> csv_cells(std::string_view line, char separator) {
  std::vector<std::string_view> cells;
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t end = std::min(line.find(separator, begin), line.size());
    cells.push_back(trimmed(line.substr(begin, end - begin)));
    begin = end + 1;
  }
  return cells;
}

std::optional<std::string> wrong_separator(std::string_view header, char expected) {
  if (csv_cells(header, expected).size() > 1) return std::nullopt;
  // A space comes last: it may stand within a name or behind another separator.
  for (const char other : {';', ',', '\t', '|', ' '})
    if (other != expected && csv_cells(trimmed(header), other).size() > 1)
      return fmt::format("the columns are separated by {}, must be separated by {}", separator_words(other),
                         separator_words(expected));
  return std::nullopt;
}

CsvHeader read_csv_header(const CsvLine& line, std::string_view file, const std::vector<std::string>& known,
                          std::vector<Fault>& faults) {
  return read_csv_header(csv_cells(line.text), line.number, file, known, faults);
}

CsvHeader read_csv_header(const std::vector<std::string_view>& names, std::size_t line, std::string_view file,
                          const std::vector<std::string>& known, std::vector<Fault>& faults) {
  CsvHeader header{std::vector<std::optional<std::size_t>>(known.size()), names.size()};
  if (names.size() > kMaxColumns) {
    faults.push_back({fmt::format("{}, line {}", file, line),
                      fmt::format("{} columns, must be {} at most", names.size(), kMaxColumns)});
    return header;
  }
  for (std::size_t c = 0; c < names.size(); ++c) {
    const std::string place = fmt::format("{}, line {}, column {}", file, line, c + 1);
    const auto found = std::find(known.begin(), known.end(), names[c]);
    if (found == known.end()) {
      faults.push_back({place, unknown_name("column", names[c], known)});
      continue;
    }
    auto& at = header.places[static_cast<std::size_t>(found - known.begin())];
    if (at) faults.push_back({place, fmt::format("column {} is there twice", names[c])});
    at = c;
  }
  return header;
}

std::optional<double> csv_number(std::string_view cell) {
  if (cell.starts_with('+') && !cell.starts_with("+-")) cell.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  if (error != std::errc() || end != cell.data() + cell.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

}  // namespace slipway
