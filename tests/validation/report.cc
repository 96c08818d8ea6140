#include "tests/validation/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace slipway::validation {

std::string Report::markdown() const {
  std::string text = fmt::format("### {}\n\nAgainst: {}\n\n", title, source);
  const auto line = [&text](const std::vector<std::string>& cells) {
    text += fmt::format("| {} |\n", fmt::join(cells, " | "));
  };
  line(columns);
  line(std::vector<std::string>(columns.size(), "---"));
  for (const auto& row : rows) line(row);
  text += "\n";
  for (const std::string& note : notes) text += fmt::format("- {}\n", note);
  return text + "\n";
}

double median_abs(std::vector<double> values) {
  if (values.empty()) return 0.0;
  for (double& v : values) v = std::abs(v);
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

}  // namespace slipway::validation
