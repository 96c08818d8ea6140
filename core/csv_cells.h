#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"

namespace slipway {

struct CsvLine {
  std::string_view text;
  std::size_t number = 0;  // in the file, from 1
};

// The lines of a CSV without quotes, but blank ones; a byte order mark before the first is passed over. They
// and their cells point into `text`.
std::vector<CsvLine> csv_lines(std::string_view text);

// What is between the separators, without the spaces around it.
std::vector<std::string_view> csv_cells(std::string_view line, char separator = ',');

// Says that a header is written with another separator than the expected one, and with which: it is then one
// column where it is cut at the expected one, and several where it is cut at the other. Nothing where that is
// not so.
std::optional<std::string> wrong_separator(std::string_view header, char expected);

// A header with more columns than this is refused before its names are compared with each other.
inline constexpr std::size_t kMaxColumns = 1000;

// Where each known column stands in a header, and how many cells its rows must have.
struct CsvHeader {
  std::vector<std::optional<std::size_t>> places;  // of `known`, in its order
  std::size_t width = 0;
};
// Columns that are not known, or there twice, are faults of `file`; so are more than kMaxColumns, alone.
CsvHeader read_csv_header(const CsvLine& line, std::string_view file, const std::vector<std::string>& known,
                          std::vector<Fault>& faults);
// The same of names that were cut already, in this line of the file.
CsvHeader read_csv_header(const std::vector<std::string_view>& names, std::size_t line, std::string_view file,
                          const std::vector<std::string>& known, std::vector<Fault>& faults);

// Nothing where the whole cell is no finite number.
std::optional<double> csv_number(std::string_view cell);

}  // namespace slipway
