#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/csv_cells.h"
#include "core/result.h"

namespace slipway {

// How a table of text is to be read where the caller knows more than the file says.
struct TextTableRules {
  std::optional<char> separator = std::nullopt;  // else it is found: a comma, semicolon, tab or bar
  char comment = '\0';                           // lines that begin with it are no rows; '\0': there are none
};

// A table as spreadsheets, loggers and GIS write it: a header and rows. The text is UTF-8, UTF-16 or Latin-1,
// with or without a byte order mark; lines end as on any system; a first line "sep=;" names the separator,
// which is else found in the header and the first rows. Cells may stand in quotes, with the separator and
// doubled quotes in them, but not over several lines. Where the separator is no comma, numbers may have
// decimal commas. Rows without a single text are no rows, and empty cells beyond the header are none.
// A row's cells are cut when they are asked for, so that a long log costs little more than its bytes.
class TextTable {
 public:
  // Of the header, in its order, without spaces around them and without quotes.
  const std::vector<std::string>& names() const { return names_; }
  // The header's line in the file, from 1; 0 where the file has no line.
  std::size_t header_line() const { return header_line_; }
  std::size_t rows() const { return lines_.size(); }
  // A row's line in the file, from 1.
  std::size_t line(std::size_t row) const { return lines_[row].number; }
  // As many as the row has, which a caller compares with the header's.
  std::vector<std::string> cells(std::size_t row) const;
  // Lines that begin with the rules' comment, whole, from before, between and after the rows.
  const std::vector<CsvLine>& comments() const { return comments_; }

  char separator() const { return separator_; }
  bool has_decimal_commas() const { return decimal_comma_; }
  // Nothing where the whole cell is no finite number as this table writes numbers.
  std::optional<double> number(std::string_view cell) const;
  // What was found out and not said by the caller or the file, each a sentence: "The columns are separated
  // by semicolons." None for UTF-8 with commas.
  const std::vector<std::string>& notes() const { return notes_; }

 private:
  friend class TextTableReader;
  std::shared_ptr<const std::string> text_;  // UTF-8; the lines point into it
  std::vector<std::string> names_, notes_;
  std::vector<CsvLine> lines_, comments_;
  std::size_t header_line_ = 0;
  char separator_ = ',';
  bool decimal_comma_ = false;
};

// `file`: its name, in the places of faults, "legend.csv, line 3". An empty file is a table without names and
// rows. Errors: unreadable_data of bytes that are no text, and of quotes that do not end on their line.
Result<TextTable> read_text_table(std::string_view bytes, std::string_view file,
                                  const TextTableRules& rules = {});

// Whether a cell says that there is no value: it is empty, or one of the words nan, NULL, None, N/A, NA,
// #N/A,
// - and -- in capital or small letters.
bool is_missing_cell(std::string_view cell);

// Where each known column stands in the table, as read_csv_header() says it.
CsvHeader find_columns(const TextTable& table, std::string_view file, const std::vector<std::string>& known,
                       std::vector<Fault>& faults);

}  // namespace slipway
