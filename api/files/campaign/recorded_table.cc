#include "api/files/campaign/recorded_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/csv_cells.h"
#include "core/fault_words.h"
#include "core/text_table.h"

namespace slipway::api {
namespace {

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

// A kind of fault of a column, and where it is.
struct Kind {
  std::string column, first;  // the words of the first of them
  std::vector<std::size_t> lines;
};

class TableReader {
 public:
  TableReader(std::string file, const TableQuestion& question, std::vector<Fault>& faults)
      : file_(std::move(file)), question_(question), faults_(faults) {}

  RecordedTable read(std::string_view bytes) {
    auto text = read_text_table(bytes, file_, {.separator = question_.separator});
    if (!text) {
      for (const Fault& fault : text.error().faults)
        faults_.push_back({file_ + "#", fault.pointer + ": " + fault.message});
      if (text.error().faults.empty()) faults_.push_back({file_ + "#", file_ + ": " + text.error().detail});
      return {};
    }
    if (text->rows() < 2) {
      faults_.push_back({file_ + "#", fmt::format("{} has {} rows below the header, must have two at least",
                                                  file_, text->rows())});
      return {};
    }
    table_.names = text->names();
    table_.notes = text->notes();
    if (table_.names.size() == 1 && !is_known(table_.names.front())) {
      const auto wrong = wrong_separator(table_.names.front(), text->separator());
      faults_.push_back(
          {file_ + "#/1",
           fmt::format("{}, line {}, column 1: {}: change the key separator of the mapping", file_,
                       text->header_line(), wrong.value_or("the header is a single column"))});
      return {};
    }
    refuse_twins(text->header_line());
    for (std::size_t row = 0; row < text->rows(); ++row) read_row(*text, row);
    report();
    return std::move(table_);
  }

 private:
  bool is_known(const std::string& name) const {
    return question_.asked.contains(name) || question_.texts.contains(name);
  }

  void add(const std::string& column, std::size_t line, std::string_view kind, std::string words) {
    Kind& of = kinds_[{column, std::string(kind)}];
    if (of.lines.empty()) of = {column, std::move(words), {}};
    of.lines.push_back(line);
  }

  void report() {
    for (const auto& [key, kind] : kinds_) {
      const std::string place = kind.column.empty() ? "" : fmt::format(" ({})", kind.column);
      faults_.push_back(
          {fmt::format("{}#/{}{}{}", file_, kind.lines.front(), kind.column.empty() ? "" : "/", kind.column),
           fmt::format("{}, line {}{}: {}{}", file_, kind.lines.front(), place, kind.first,
                       other_lines(kind.lines))});
    }
  }

  // Which of two columns of one name is meant, nobody can say.
  void refuse_twins(std::size_t line) {
    const auto refuse = [&](const std::string& name) {
      if (const auto count = std::count(table_.names.begin(), table_.names.end(), name); count > 1)
        add(name, line, "twins",
            fmt::format("{} columns have this name, must be one: rename the others", count));
    };
    for (const std::string& name : question_.asked) refuse(name);
    for (const std::string& name : question_.texts) refuse(name);
  }

  void read_row(const TextTable& text, std::size_t at) {
    const std::vector<std::string> cells = text.cells(at);
    const std::size_t line = text.line(at);
    if (cells.size() != table_.names.size())
      return add("", line, "cells",
                 fmt::format("{} cells, must have {} as the header", cells.size(), table_.names.size()));
    std::vector<double> row;
    std::size_t numbers = 0;
    std::vector<std::size_t> words;  // cells that should be numbers and are none
    for (std::size_t c = 0; c < cells.size(); ++c) {
      row.push_back(is_missing_cell(cells[c]) ? kMissing : text.number(cells[c]).value_or(kMissing));
      if (!question_.asked.contains(table_.names[c]) || is_missing_cell(cells[c])) continue;
      if (std::isfinite(row.back()))
        ++numbers;
      else
        words.push_back(c);
    }
    if (at == 0 && numbers == 0 && words.size() > 1) {
      table_.notes.emplace_back(
          "The line below the header has words and no numbers, units it seems: it is passed over.");
      return;
    }
    for (const std::size_t c : words)
      add(table_.names[c], line, "number",
          fmt::format("{} is no finite number; a cell without a value must be empty", in_quotes(cells[c])));
    keep(std::move(row), line, cells);
  }

  void keep(std::vector<double> row, std::size_t line, const std::vector<std::string>& cells) {
    table_.rows.push_back(std::move(row));
    table_.lines.push_back(line);
    for (std::size_t c = 0; c < cells.size(); ++c)
      if (question_.texts.contains(table_.names[c])) table_.texts[table_.names[c]].push_back(cells[c]);
  }

  std::string file_;
  const TableQuestion& question_;
  std::vector<Fault>& faults_;
  RecordedTable table_;
  std::map<std::pair<std::string, std::string>, Kind> kinds_;  // by column and kind
};

}  // namespace

std::optional<std::size_t> RecordedTable::place_of(std::string_view name) const {
  const auto at = std::find(names.begin(), names.end(), name);
  if (at == names.end()) return std::nullopt;
  return static_cast<std::size_t>(at - names.begin());
}

RecordedTable read_recorded_table(std::string_view bytes, const std::string& file,
                                  const TableQuestion& question, std::vector<Fault>& faults) {
  return TableReader(file, question, faults).read(bytes);
}

std::string other_lines(const std::vector<std::size_t>& lines) {
  constexpr std::size_t kNamed = 4;  // one by one, behind the first
  if (lines.size() < 2) return "";
  const std::size_t end = std::min(lines.size(), kNamed + 1);
  std::string words =
      fmt::format("; so it is in {} {}", lines.size() == 2 ? "line" : "lines",
                  fmt::join(lines.begin() + 1, lines.begin() + static_cast<std::ptrdiff_t>(end), ", "));
  if (lines.size() > end) words += fmt::format(" and {} more", lines.size() - end);
  return words;
}

}  // namespace slipway::api
