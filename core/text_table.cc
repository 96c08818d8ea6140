#include "core/text_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <utility>

#include "core/text_encoding.h"

namespace slipway {
namespace {

constexpr std::string_view kSpaces = " \t";
// A comma comes last: it may stand in every number.
constexpr std::array<char, 4> kSeparators{'\t', ';', '|', ','};
constexpr std::size_t kRowsOfFirstLook = 20;

std::string_view trimmed(std::string_view cell) {
  const std::size_t begin = cell.find_first_not_of(kSpaces);
  if (begin == std::string_view::npos) return {};
  return cell.substr(begin, cell.find_last_not_of(kSpaces) + 1 - begin);
}

std::string_view words_of(char separator) {
  switch (separator) {
    case ';':
      return "semicolons";
    case '\t':
      return "tabs";
    case '|':
      return "bars";
    default:
      return "commas";
  }
}

// Calls `take` with each cell of a line; false where quotes don't end on it. A cell is in quotes where its
// first character is one, and within them a doubled quote is one quote.
template <class Take>
bool cut(std::string_view line, char separator, const Take& take) {
  for (std::size_t at = 0; at <= line.size();) {
    const std::size_t first = line.find_first_not_of(' ', at);
    if (first == std::string_view::npos || line[first] != '"') {
      const std::size_t end = std::min(line.find(separator, at), line.size());
      take(std::string(trimmed(line.substr(at, end - at))));
      at = end + 1;
      continue;
    }
    std::string cell;
    std::size_t i = first + 1;
    for (; i < line.size() && (line[i] != '"' || line.substr(i + 1).starts_with('"')); ++i) {
      if (line[i] == '"') ++i;
      cell += line[i];
    }
    if (i >= line.size()) return false;
    const std::size_t end = std::min(line.find(separator, i + 1), line.size());
    cell += trimmed(line.substr(i + 1, end - i - 1));
    take(std::string(trimmed(cell)));
    at = end + 1;
  }
  return true;
}

std::size_t count_cells(std::string_view line, char separator) {
  std::size_t count = 0;
  cut(line, separator, [&](const std::string&) { ++count; });
  return count;
}

// The lines of a text by whatever ends them.
std::vector<CsvLine> lines_of(std::string_view text) {
  std::vector<CsvLine> lines;
  std::size_t number = 1;
  for (std::size_t begin = 0; begin < text.size(); ++number) {
    const std::size_t end = std::min(text.find_first_of("\r\n", begin), text.size());
    lines.push_back({text.substr(begin, end - begin), number});
    begin = end + (text.substr(end).starts_with("\r\n") ? 2 : 1);
  }
  return lines;
}

bool are_digits(std::string_view text) {
  return std::all_of(text.begin(), text.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
}

// Whether a cell is a decimal number whose whole part ends with this mark: "-12,5", "1.0e3".
bool is_decimal(std::string_view cell, char mark) {
  if (cell.starts_with('-') || cell.starts_with('+')) cell.remove_prefix(1);
  const std::size_t at = cell.find(mark);
  if (at == std::string_view::npos || !are_digits(cell.substr(0, at))) return false;
  const std::string_view rest = cell.substr(at + 1);
  const std::size_t exponent = std::min(rest.find_first_of("eE"), rest.size());
  return exponent + at > 0 && are_digits(rest.substr(0, exponent)) &&
         (exponent == rest.size() || csv_number("1" + std::string(rest.substr(exponent))).has_value());
}

}  // namespace

// Makes a table of bytes, step by step.
class TextTableReader {
 public:
  TextTableReader(std::string_view file, const TextTableRules& rules) : file_(file), rules_(rules) {}

  Result<TextTable> read(std::string_view bytes) {
    auto decoded = decode_text(bytes);
    if (!decoded)
      return fail(ErrorCode::kUnreadableData, fmt::format("{} is no text", file_),
                  {{std::string(file_), "is no text: save it as CSV in UTF-8"}});
    if (!decoded->note.empty()) table_.notes_.push_back(std::move(decoded->note));
    table_.text_ = std::make_shared<const std::string>(std::move(decoded->utf8));
    std::vector<CsvLine> lines = sorted_out(lines_of(*table_.text_));
    find_separator(lines);
    std::erase_if(lines, [&](const CsvLine& line) { return is_blank(line); });
    if (lines.empty()) return std::move(table_);
    check_quotes(lines);
    if (!faults_.empty())
      return fail(ErrorCode::kUnreadableData, fmt::format("{} can't be read", file_), std::move(faults_));
    table_.header_line_ = lines.front().number;
    cut(lines.front().text, table_.separator_,
        [&](std::string name) { table_.names_.push_back(std::move(name)); });
    while (table_.names_.size() > 1 && table_.names_.back().empty()) table_.names_.pop_back();
    table_.lines_.assign(lines.begin() + 1, lines.end());
    find_decimal_commas();
    return std::move(table_);
  }

 private:
  // Without the line that names the separator and without comments, which are kept apart.
  std::vector<CsvLine> sorted_out(std::vector<CsvLine> lines) {
    if (!lines.empty() && lines.front().text.size() == 5 && lines.front().text.starts_with("sep=")) {
      named_ = lines.front().text.back();
      lines.erase(lines.begin());
    }
    std::erase_if(lines, [&](const CsvLine& line) {
      const std::string_view text = trimmed(line.text);
      const bool is_comment = rules_.comment != '\0' && text.starts_with(rules_.comment);
      if (is_comment) table_.comments_.push_back(line);
      return is_comment || text.empty();
    });
    return lines;
  }

  // The first one by which the first rows have as many cells as the header; where there is none, the one that
  // cuts the header into the most.
  void find_separator(const std::vector<CsvLine>& lines) {
    if (rules_.separator || named_) {
      table_.separator_ = rules_.separator ? *rules_.separator : *named_;
      return;
    }
    const std::size_t looked_at = std::min(lines.size(), kRowsOfFirstLook);
    const auto end = lines.begin() + static_cast<std::ptrdiff_t>(looked_at);
    std::pair<bool, std::size_t> best{false, 1};
    for (const char separator : kSeparators) {
      const std::size_t width = lines.empty() ? 0 : count_cells(lines.front().text, separator);
      const bool agrees = std::all_of(lines.begin(), end, [&](const CsvLine& line) {
        return count_cells(line.text, separator) == width;
      });
      if (width < 2 || best.first || (!agrees && width <= best.second)) continue;
      best = {agrees, width};
      table_.separator_ = separator;
    }
    if (table_.separator_ != ',')
      table_.notes_.push_back(fmt::format("The columns are separated by {}.", words_of(table_.separator_)));
  }

  bool is_blank(const CsvLine& line) const {
    return std::all_of(line.text.begin(), line.text.end(), [&](char c) {
      return c == table_.separator_ || kSpaces.find(c) != std::string_view::npos;
    });
  }

  void check_quotes(const std::vector<CsvLine>& lines) {
    constexpr std::size_t kMaxFaults = 20;
    for (const CsvLine& line : lines)
      if (line.text.find('"') != std::string_view::npos && faults_.size() < kMaxFaults &&
          !cut(line.text, table_.separator_, [](const std::string&) {}))
        faults_.push_back({fmt::format("{}, line {}", file_, line.number),
                           "a cell begins with a quote that does not end on this line"});
  }

  // A comma in a number is a decimal one where no number has a decimal point.
  void find_decimal_commas() {
    if (table_.separator_ == ',') return;
    bool commas = false, points = false;
    for (std::size_t row = 0; row < table_.rows() && !points; ++row)
      cut(table_.lines_[row].text, table_.separator_, [&](const std::string& cell) {
        commas = commas || is_decimal(cell, ',');
        points = points || is_decimal(cell, '.');
      });
    table_.decimal_comma_ = commas && !points;
    if (table_.decimal_comma_) table_.notes_.emplace_back("Commas in numbers are decimal commas.");
  }

  std::string_view file_;
  const TextTableRules& rules_;
  std::optional<char> named_;  // by the file
  TextTable table_;
  std::vector<Fault> faults_;
};

std::vector<std::string> TextTable::cells(std::size_t row) const {
  std::vector<std::string> found;
  found.reserve(names_.size());
  cut(lines_[row].text, separator_, [&](std::string cell) { found.push_back(std::move(cell)); });
  while (found.size() > names_.size() && found.back().empty()) found.pop_back();
  return found;
}

std::optional<double> TextTable::number(std::string_view cell) const {
  if (!decimal_comma_ || !is_decimal(cell, ',')) return csv_number(cell);
  std::string with_point(cell);
  with_point[with_point.find(',')] = '.';
  return csv_number(with_point);
}

Result<TextTable> read_text_table(std::string_view bytes, std::string_view file,
                                  const TextTableRules& rules) {
  return TextTableReader(file, rules).read(bytes);
}

bool is_missing_cell(std::string_view cell) {
  constexpr std::array<std::string_view, 9> kWords{"", "nan", "null", "none", "n/a", "na", "#n/a", "-", "--"};
  constexpr std::size_t kLongest = 4;
  if (cell.size() > kLongest) return false;
  std::string small;
  for (const unsigned char c : cell) small += static_cast<char>(std::tolower(c));
  return std::find(kWords.begin(), kWords.end(), small) != kWords.end();
}

CsvHeader find_columns(const TextTable& table, std::string_view file, const std::vector<std::string>& known,
                       std::vector<Fault>& faults) {
  const std::vector<std::string_view> names(table.names().begin(), table.names().end());
  // One column that is none of these is a table whose separator is none that is looked for.
  if (names.size() == 1 && std::find(known.begin(), known.end(), names[0]) == known.end())
    if (auto wrong = wrong_separator(names[0], table.separator())) {
      faults.push_back({fmt::format("{}, line {}", file, table.header_line()), *std::move(wrong)});
      return {std::vector<std::optional<std::size_t>>(known.size()), 1};
    }
  return read_csv_header(names, table.header_line(), file, known, faults);
}

}  // namespace slipway
