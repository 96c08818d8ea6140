#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"

namespace slipway::api {

// Faults of one recorded file that are reported one by one.
inline constexpr std::size_t kMaxFaultsOfFile = 20;

// A recorded file: its columns' names and numbers.
struct RecordedTable {
  std::vector<std::string> names;
  std::vector<std::vector<double>> rows;                  // NaN where a cell is empty
  std::vector<std::size_t> lines;                         // of each row, in the file
  std::map<std::string, std::vector<std::string>> texts;  // of the columns of texts, by row
  std::vector<std::string> notes;                         // what was found out of how it is written

  std::optional<std::size_t> place_of(std::string_view name) const;
};

// What of a file is needed.
struct TableQuestion {
  std::optional<char> separator;  // nothing: it is found
  std::set<std::string> asked;    // columns whose cells must be numbers, or missing
  std::set<std::string> texts;    // columns that are kept as they are written
};

// Columns that are not asked for have numbers where a cell is one. Faults of `file` are added with its name,
// line and column, one for each kind of fault in a column; the table then is of no use.
RecordedTable read_recorded_table(std::string_view bytes, const std::string& file,
                                  const TableQuestion& question, std::vector<Fault>& faults);

// ", and so it is in lines 9, 12 and 30 others": behind a fault of the first of these lines.
std::string other_lines(const std::vector<std::size_t>& lines);

}  // namespace slipway::api
