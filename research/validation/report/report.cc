#include "research/validation/report/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <regex>

namespace slipway::validation {
namespace {

// A value that is rounded to zero is printed without a sign, since its sign depends on the last bit, which
// differs between machines.
std::string without_signed_zeros(const std::string& text) {
  static const std::regex kSignedZero(R"((^|[ (+])[-+](0(?:\.0+)?)(?![0-9.]))");
  return std::regex_replace(text, kSignedZero, "$1$2");
}

}  // namespace

bool Report::holds() const {
  return std::all_of(bands.begin(), bands.end(), [](const StatedBand& band) { return band.holds(); });
}

std::string Report::markdown() const {
  std::string text = fmt::format("### {}\n\nAgainst: {}\n\n", title, source);
  if (!peers.empty()) text += fmt::format("Peers: {}\n\n", peers);
  const auto line = [&text](const std::vector<std::string>& cells) {
    text += fmt::format("| {} |\n", fmt::join(cells, " | "));
  };
  line(columns);
  line(std::vector<std::string>(columns.size(), "---"));
  for (std::vector<std::string> row : rows) {
    for (std::string& cell : row) cell = without_signed_zeros(cell);
    line(row);
  }
  text += "\n";
  for (const std::string& note : notes) text += fmt::format("- {}\n", note);
  for (const StatedBand& band : bands)
    text += fmt::format("- Stated band: {} in [{:g}, {:g}]: {:.4g}, {}.\n", band.what, band.lowest,
                        band.highest, band.value, band.holds() ? "holds" : "DOES NOT HOLD");
  return text + "\n";
}

}  // namespace slipway::validation
