#include "research/validation/simulators/sealed_scores.h"

#include <fmt/format.h>

#include <optional>

#include "research/validation/report/csv_table.h"

namespace slipway::validation {
namespace {

using gap::CaseScore;

std::optional<double> optional_number(const CsvTable& table, std::size_t row, const char* column) {
  if (!table.has(column) || table.empty(row, column)) return std::nullopt;
  return table.number(row, column);
}

SealedScore score_in(const CsvTable& table, std::size_t row) {
  const auto yes = [&](const char* column) { return table.number(row, column) != 0.0; };
  SealedScore s{table.text(row, "set"), table.text(row, "variant"), {}};
  CaseScore& c = s.score;
  c.campaign = table.text(row, "campaign");
  c.truth = table.text(row, "hidden");
  c.truth_kind = static_cast<gap::TruthKind>(static_cast<int>(table.number(row, "hidden_kind")));
  c.size = table.number(row, "size");
  c.kind = table.text(row, "kind");
  c.fidelity = table.text(row, "fidelity");
  c.verdict = table.text(row, "verdict");
  c.found = table.text(row, "found");
  c.exact = yes("exact");
  c.alike = yes("alike");
  c.verdict_right = yes("verdict_right");
  c.held = yes("held");
  c.false_alarm = yes("false_alarm");
  c.confident_wrong = yes("confident_wrong");
  c.unknown_probability = table.number(row, "unknown_probability");
  c.stated = table.number(row, "stated");
  if (!table.empty(row, "wheel_right")) c.wheel_right = yes("wheel_right");
  c.closed_fraction = optional_number(table, row, "closed_fraction");
  c.oracle_closed_fraction = optional_number(table, row, "oracle_closed_fraction");
  c.place_overlap = optional_number(table, row, "place_overlap");
  c.seconds = table.number(row, "seconds");
  if (const auto right = optional_number(table, row, "channel_right")) c.channel_right = *right != 0.0;
  c.slice_overlap = optional_number(table, row, "slice_overlap");
  c.slice_attainable = optional_number(table, row, "slice_attainable");
  const auto flag = [&](const char* column) {
    return optional_number(table, row, column).value_or(0.0) != 0.0;
  };
  c.partial = flag("partial");
  c.names_right = flag("names_right");
  c.wrong_name = flag("wrong_name");
  return s;
}

}  // namespace

Result<std::vector<SealedScore>> read_sealed_scores(const std::filesystem::path& file) {
  const auto table = CsvTable::read(
      file,
      {.numbers = {"hidden_kind", "size", "exact", "alike", "verdict_right", "held", "false_alarm",
                   "confident_wrong", "unknown_probability", "stated", "seconds"},
       .numbers_or_empty = {"wheel_right", "closed_fraction", "oracle_closed_fraction", "place_overlap"},
       .texts = {"set", "variant", "campaign", "hidden", "verdict", "found"},
       .numbers_if_there = {"channel_right", "slice_overlap", "slice_attainable", "partial", "names_right",
                            "wrong_name"}});
  if (!table) return fail(table.error());
  std::vector<SealedScore> scores;
  for (std::size_t row = 0; row < table->rows(); ++row) scores.push_back(score_in(*table, row));
  return scores;
}

std::string rate_words(const gap::Rate& rate) {
  if (rate.of == 0) return "-";
  const gap::RateInterval interval = gap::binomial_interval(rate);
  return fmt::format("{} of {} ({:.2f} to {:.2f})", rate.hits, rate.of, interval.low, interval.high);
}

}  // namespace slipway::validation
