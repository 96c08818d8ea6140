#include "server/cli/terminal/text_table.h"

#include <fmt/format.h>

#include <algorithm>

namespace slipway::server {

std::string TextTable::print() const {
  std::vector<std::size_t> width(rows_.front().size());
  for (const auto& row : rows_)
    for (std::size_t c = 0; c < row.size(); ++c) width[c] = std::max(width[c], row[c].size());
  std::string out;
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    for (std::size_t c = 0; c < rows_[r].size(); ++c) {
      const bool words = c == 0 || c + 1 == rows_[r].size();
      out += words ? fmt::format("{:<{}}  ", rows_[r][c], width[c])
                   : fmt::format("{:>{}}  ", rows_[r][c], width[c]);
    }
    while (!out.empty() && out.back() == ' ') out.pop_back();
    out += "\n";
    if (r == 0) {
      std::size_t total = 0;
      for (const std::size_t w : width) total += w + 2;
      out += std::string(total - 2, '-') + "\n";
    }
  }
  return out;
}

}  // namespace slipway::server
