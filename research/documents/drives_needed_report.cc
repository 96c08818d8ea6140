#include "research/documents/drives_needed_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace slipway::api {
namespace {

std::string words(const std::optional<std::size_t>& needed) {
  return needed ? fmt::format("{}", *needed) : "not found";
}

// "9 (6 to not found)"
std::string range_words(const gap::DrivesNeededCase& c) {
  std::optional<std::size_t> least;
  std::size_t most = 0;
  bool all = true;
  for (const auto& needed : c.random) {
    all = all && needed.has_value();
    if (!needed) continue;
    least = std::min(least.value_or(*needed), *needed);
    most = std::max(most, *needed);
  }
  const std::optional<double> median = c.random_median();
  return fmt::format("{} ({} to {})", median ? fmt::format("{:g}", *median) : "not found", words(least),
                     all ? fmt::format("{}", most) : "not found");
}

}  // namespace

std::string drives_needed_report(const gap::DrivesNeeded& needed) {
  const gap::DrivesNeededSummary s = gap::summary_of(needed.cases, needed.first);
  std::string out = fmt::format(
      "## Drives needed\n\nEvery run begins with the {} drives that tell least. A number is the "
      "least of drives from which on the answer is exactly right in two steps in a row.\n\n",
      needed.first);
  out +=
      "| campaign | hidden | kind | fidelity | designed | random: median (range) | ratio |\n"
      "| --- | --- | --- | --- | --- | --- | --- |\n";
  for (const gap::DrivesNeededCase& c : needed.cases) {
    const std::optional<double> ratio = c.ratio(needed.first);
    out += fmt::format("| {} | {} | {} | {} | {} | {} | {} |\n", c.campaign, c.hidden, c.kind, c.fidelity,
                       words(c.designed), range_words(c), ratio ? fmt::format("{:.2f}", *ratio) : "-");
  }
  const auto number = [](const std::optional<double>& v) { return v ? fmt::format("{:.2f}", *v) : "-"; };
  out += "\n| figure | value | target |\n| --- | --- | --- |\n";
  out += fmt::format(
      "| designed over random, median (90 % interval), {} of {} campaigns | {} ({} to {}) | 0.50 |\n",
      s.compared, s.campaigns, number(s.median_ratio), number(s.ratio_low), number(s.ratio_high));
  out += fmt::format("| the first drives were enough for both | {} of {} | |\n", s.first_enough, s.campaigns);
  out += fmt::format("| not found, designed | {} of {} | |\n", s.designed_not_found, s.campaigns);
  out += fmt::format("| not found, random | {} of {} runs | |\n", s.random_not_found, s.random_runs);
  return out;
}

}  // namespace slipway::api
