#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"

namespace slipway::validation {

// A CSV file with one header line, without quotes.
class CsvTable {
 public:
  // Every cell of the columns `numbers` must be a finite number; cells of `numbers_or_empty` may also be
  // empty. The columns `texts` must be present. Columns of `numbers_if_there` may be absent, and their cells
  // may be empty. Errors: unreadable_data with every fault ("/LINE", "/COLUMN", "/LINE/COLUMN").
  struct Columns {
    std::vector<std::string> numbers, numbers_or_empty, texts, numbers_if_there = {};
  };
  static Result<CsvTable> read(const std::filesystem::path& path, const Columns& columns);

  std::size_t rows() const { return cells_.size(); }
  const std::string& text(std::size_t row, std::string_view column) const;
  bool has(std::string_view column) const;
  bool empty(std::size_t row, std::string_view column) const { return text(row, column).empty(); }
  double number(std::size_t row, std::string_view column) const;  // the column must be one of numbers
  // A whole column.
  std::vector<double> numbers(std::string_view column) const;

 private:
  std::size_t index(std::string_view column) const;
  void look_for_numbers(const std::vector<std::string>& columns, bool may_be_empty,
                        std::vector<Fault>& faults) const;

  std::string path_;
  std::vector<std::string> header_;
  std::vector<std::vector<std::string>> cells_;
};

}  // namespace slipway::validation
