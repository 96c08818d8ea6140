#pragma once

#include <string>
#include <vector>

namespace slipway::server {

// Columns as wide as their widest cell; the first and the last hold words, numbers stand to the right.
class TextTable {
 public:
  explicit TextTable(std::vector<std::string> header) { rows_.push_back(std::move(header)); }
  void add(std::vector<std::string> row) { rows_.push_back(std::move(row)); }
  std::string print() const;

 private:
  std::vector<std::vector<std::string>> rows_;
};

}  // namespace slipway::server
